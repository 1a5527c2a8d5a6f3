#include "coordinator/record/shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace abut {

namespace {

/// Of many bodies one that takes less is not named.
constexpr double least_named = 0.05;

}  // namespace

Shares shares_of(std::span<const double> waited, double wall) {
  Shares shares;
  if (!(wall > 0.0)) return {std::vector<double>(waited.size(), 0.0), 0.0};
  double all = 0.0;
  for (const double seconds : waited) {
    shares.bodies.push_back(std::min(1.0, seconds / wall));
    all += shares.bodies.back();
  }
  shares.coupling = std::max(0.0, 1.0 - all);
  return shares;
}

std::string shares_words(const Shares& shares, std::span<const std::string> names,
                         std::size_t most) {
  std::vector<std::size_t> order(shares.bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, [&shares](std::size_t a, std::size_t b) {
    return shares.bodies[a] > shares.bodies[b];
  });
  std::string text;
  double others = 0.0;
  std::size_t named = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double share = shares.bodies[order[k]];
    if (named == k && k < most && (order.size() <= most || share >= least_named)) {
      text += fmt::format("{} {:.0f} %, ", names[order[k]], 100.0 * share);
      ++named;
    } else {
      others += share;
    }
  }
  const std::size_t left = order.size() - named;
  const char* word = named == 0 ? "bodies" : left == 1 ? "other" : "others";
  if (left > 0) text += fmt::format("{} {} {:.0f} %, ", left, word, 100.0 * others);
  return text + fmt::format("coupling {:.0f} %", 100.0 * shares.coupling);
}

}  // namespace abut
