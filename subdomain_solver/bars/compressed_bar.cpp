#include "subdomain_solver/bars/compressed_bar.hpp"
#include "base/index.hpp"

#include <fmt/format.h>

namespace abut {

namespace {

// At a strain of -1 nothing is left of an element. A front overshoots by up to half of itself, so
// the limit leaves room for that.
constexpr double limit = -1.5;

Failed failure(std::size_t element, double strain, double time, const std::string& body) {
  return Failed{
      Failed::Cause::inverted_element, time,
      fmt::format("element {} of body '{}' has the strain {:.4g}, beyond {:g}: at -1 nothing is "
                  "left of its length, and linear elasticity is of strains that are small against "
                  "1. Give the bodies a speed below that of waves, or the bar less load",
                  element + 1, body, strain, limit)};
}

}  // namespace

std::optional<Failed> compressed_to_nothing(std::span<const double> u, double spacing, double time,
                                            const std::string& body) {
  for (std::size_t e = 0; e + 1 < u.size(); ++e) {
    if (u[e + 1] - u[e] > limit * spacing) continue;
    return failure(e, (u[e + 1] - u[e]) / spacing, time, body);
  }
  return std::nullopt;
}

std::optional<Failed> compressed_to_nothing(std::span<const double> u, const Mesh& mesh,
                                            double time, const std::string& body) {
  std::size_t before = 0;
  for (const CellBlock& cells : mesh.blocks) {
    const std::size_t corners = index(cells.element->nodes);
    for (std::size_t c = 0; c < cells.nodes.size(); c += corners, ++before) {
      const std::size_t a = index(cells.nodes[c]);
      const std::size_t b = index(cells.nodes[c + 1]);
      const double strain = (u[b] - u[a]) / (mesh.points[b] - mesh.points[a]);
      if (strain <= limit) return failure(before, strain, time, body);
    }
  }
  return std::nullopt;
}

}  // namespace abut
