#include "coordinator/coupling/tied_wholes.hpp"

#include <algorithm>
#include <numeric>

#include "base/index.hpp"

namespace abut {

std::vector<int> tied_wholes(std::span<const Joint> joints, int bodies) {
  std::vector<int> wholes(index(bodies));
  std::iota(wholes.begin(), wholes.end(), 0);
  for (const Joint& joint : joints) {
    if (!joint.tied()) continue;
    const int one = wholes[index(joint.sides[0].body)], other = wholes[index(joint.sides[1].body)];
    for (int& of : wholes)
      if (of == one || of == other) of = std::min(one, other);
  }
  return wholes;
}

}  // namespace abut
