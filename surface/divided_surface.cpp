#include "surface/divided_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/assert.hpp"
#include "base/count.hpp"

namespace abut {
namespace {

/// What a node is made of: nodes of the surface, ascending, and shares in parts^2, exact.
using Recipe = std::vector<std::pair<std::int32_t, std::int32_t>>;

class Division {
 public:
  Division(const PosedSurface& surface, int parts) : parts_(parts) {
    out_.dim = surface.dim;
    out_.round = surface.round;
    out_.offsets.push_back(0);
    out_.nodes.offsets.push_back(0);
    for (int f = 0; f < surface.facet_count(); ++f) divide(surface.nodes(f));
  }

  DividedSurface take() { return std::move(out_); }

 private:
  /// The node of these shares; neighbouring facets share those of their edges.
  std::int32_t node(std::span<const std::int32_t> corners, std::array<std::int32_t, 4> shares) {
    Recipe recipe;
    for (std::size_t i = 0; i < corners.size(); ++i)
      if (shares[i] > 0) recipe.emplace_back(corners[i], shares[i]);
    std::ranges::sort(recipe);
    const auto [entry, fresh] = known_.emplace(recipe, out_.node_count());
    if (!fresh) return entry->second;
    for (const auto& [corner, share] : recipe) {
      out_.nodes.columns.push_back(corner);
      out_.nodes.values.push_back(share / (static_cast<double>(parts_) * parts_));
    }
    out_.nodes.end_row();
    return entry->second;
  }

  void facet(std::initializer_list<std::int32_t> nodes) {
    out_.facets.insert(out_.facets.end(), nodes);
    out_.offsets.push_back(static_cast<std::int32_t>(out_.facets.size()));
  }

  void divide(std::span<const std::int32_t> corners) {
    const std::int32_t n = parts_;
    const auto segment = [&](std::int32_t i) { return node(corners, {(n - i) * n, i * n}); };
    const auto triangle = [&](std::int32_t i, std::int32_t j) {
      return node(corners, {(n - i - j) * n, i * n, j * n});
    };
    const auto quad = [&](std::int32_t i, std::int32_t j) {
      return node(corners, {(n - i) * (n - j), i * (n - j), i * j, (n - i) * j});
    };
    for (std::int32_t i = 0; i < n; ++i) {
      if (corners.size() == 2) facet({segment(i), segment(i + 1)});
      for (std::int32_t j = 0; corners.size() == 4 && j < n; ++j)
        facet({quad(i, j), quad(i + 1, j), quad(i + 1, j + 1), quad(i, j + 1)});
      for (std::int32_t j = 0; corners.size() == 3 && i + j < n; ++j) {
        facet({triangle(i, j), triangle(i + 1, j), triangle(i, j + 1)});
        if (i + j + 1 < n) facet({triangle(i + 1, j), triangle(i + 1, j + 1), triangle(i, j + 1)});
      }
    }
  }

  std::int32_t parts_;
  DividedSurface out_;
  std::map<Recipe, std::int32_t> known_;
};

}  // namespace

int parts_for(const PosedSurface& surface, double size) {
  return count_within(std::ceil(longest_edge(surface) / size), 1, std::numeric_limits<int>::max());
}

DividedSurface divided(const PosedSurface& surface, int parts) {
  ABUT_ASSERT(parts >= 1);
  return Division(surface, parts).take();
}

}  // namespace abut
