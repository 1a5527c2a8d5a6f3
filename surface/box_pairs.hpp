#pragma once

#include <array>
#include <cstdint>

#include "base/assert.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// Calls visit(k, n) for the facets k below node a of the first and n below node b of the second
/// tree whose boxes meet, as meet(box, box) has it.
template <class Meet, class Visit>
void visit_pairs_below(const BoxTree& first, std::int32_t a, const BoxTree& second, std::int32_t b,
                       const Meet& meet, const Visit& visit) {
  // Each step goes one level down in one tree and leaves one node more behind; a tree of less than
  // 2^31 facets has at most 31 levels.
  constexpr int capacity = 80;
  std::array<FacetPair, capacity> stack;
  int count = 0;
  stack[count++] = {a, b};
  while (count > 0) {
    const auto [one, other] = stack[--count];
    const Box& box_a = first.boxes[one];
    const Box& box_b = second.boxes[other];
    if (!meet(box_a, box_b)) continue;
    const bool leaf_a = first.is_leaf(one), leaf_b = second.is_leaf(other);
    if (leaf_a && leaf_b) {
      visit(first.facet(one), second.facet(other));
      continue;
    }
    ABUT_ASSERT(count + 2 <= capacity);
    if (leaf_b || (!leaf_a && size(box_a) >= size(box_b))) {
      stack[count++] = {first.second[one], other};
      stack[count++] = {one + 1, other};
    } else {
      stack[count++] = {one, second.second[other]};
      stack[count++] = {one, other + 1};
    }
  }
}

/// The same for all facets of two trees.
template <class Meet, class Visit>
void visit_pairs(const BoxTree& first, const BoxTree& second, const Meet& meet,
                 const Visit& visit) {
  if (!first.empty() && !second.empty()) visit_pairs_below(first, 0, second, 0, meet, visit);
}

/// The same for any two facets of one tree, each two once, in either order.
template <class Meet, class Visit>
void visit_own_pairs(const BoxTree& tree, const Meet& meet, const Visit& visit) {
  const std::int32_t count = static_cast<std::int32_t>(tree.boxes.size());
  for (std::int32_t node = 0; node < count; ++node)
    if (!tree.is_leaf(node))
      visit_pairs_below(tree, node + 1, tree, tree.second[node], meet, visit);
}

}  // namespace abut
