#include "coordinator/shared_nodes.hpp"

#include <cmath>
#include <numeric>

#include "base/index.hpp"

namespace abut {

std::vector<bool> step_apart(const std::vector<std::array<Side, 2>>& pairs, const Bodies& bodies) {
  std::vector<int> row(index(bodies.count()));  // of a body: the first one known of its row
  std::iota(row.begin(), row.end(), 0);
  const auto first_of = [&row](int body) {
    while (row[body] != body) body = row[body];
    return body;
  };
  const auto share = [&bodies](const std::array<Side, 2>& sides) {
    for (const Side& side : sides)
      if (!bodies.port(side).tied || std::isinf(bodies.describe(side.body).mass)) return false;
    return true;
  };
  for (const std::array<Side, 2>& sides : pairs)
    if (share(sides)) row[first_of(sides[0].body)] = first_of(sides[1].body);
  std::vector<bool> apart(row.size(), false);  // by the first body of a row
  for (const std::array<Side, 2>& sides : pairs) {
    const Description& a = bodies.describe(sides[0].body);
    const Description& b = bodies.describe(sides[1].body);
    const bool alike = a.step == b.step && std::isinf(a.stable_step) == std::isinf(b.stable_step);
    if (share(sides) && !alike) apart[first_of(sides[0].body)] = true;
  }
  std::vector<bool> out;
  for (const std::array<Side, 2>& sides : pairs)
    out.push_back(share(sides) && apart[first_of(sides[0].body)]);
  return out;
}

}  // namespace abut
