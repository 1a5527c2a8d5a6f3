#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Measures of a mesh, by quadrature on the mapped cells and facets and independent of the solver.
class MeshMeasures {
 public:
  explicit MeshMeasures(const Mesh& mesh) : mesh_(mesh), dim_(index(mesh.dim)) {}

  /// [m^dim]
  double volume() const {
    double sum = 0.0;
    for (const CellBlock& block : mesh_.blocks) {
      const Element& element = *block.element;
      const Tabulation table = tabulate(element, quadrature(element.shape, degree));
      const auto nodes = index(element.nodes);
      for (std::size_t first = 0; first < block.nodes.size(); first += nodes) {
        const std::vector<std::int32_t> own(&block.nodes[first], &block.nodes[first] + nodes);
        for (std::size_t q = 0; q < table.weight.size(); ++q) {
          const std::array<double, 9> j = jacobian(own, table, q);
          const double det = dim_ == 1   ? j[0]
                             : dim_ == 2 ? j[0] * j[4] - j[1] * j[3]
                                         : j[0] * (j[4] * j[8] - j[5] * j[7]) -
                                               j[1] * (j[3] * j[8] - j[5] * j[6]) +
                                               j[2] * (j[3] * j[7] - j[4] * j[6]);
          sum += table.weight[q] * det;
        }
      }
    }
    return sum;
  }

  /// Of a side: sum of the area vectors [m^(dim-1)] (first 3), and the integral of x . n dA.
  struct Surface {
    std::array<double, 3> vector{};
    double area = 0.0, flux = 0.0;
  };
  Surface surface(const std::string& side) const {
    Surface sum;
    for (const Facet& facet : mesh_.side(side)) {
      const Element& cell = *mesh_.blocks[facet.block].element;
      const Element& face = element_named(cell.facet_name);
      const Tabulation table = tabulate(face, quadrature(face.shape, degree));
      const std::vector<std::int32_t> own = mesh_.nodes_of(facet);
      for (std::size_t q = 0; q < table.weight.size(); ++q) {
        const std::array<double, 9> j = jacobian(own, table, q);
        std::array<double, 3> n{};
        if (dim_ == 1) n = {facet.local == 0 ? -1.0 : 1.0, 0.0, 0.0};
        if (dim_ == 2) n = {j[3], -j[0], 0.0};
        if (dim_ == 3)
          n = {j[3] * j[7] - j[6] * j[4], j[6] * j[1] - j[0] * j[7], j[0] * j[4] - j[3] * j[1]};
        double square = 0.0;
        for (std::size_t d = 0; d < dim_; ++d) {
          double x = 0.0;
          for (std::size_t a = 0; a < own.size(); ++a)
            x += table.n[q * own.size() + a] * mesh_.points[index(own[a]) * dim_ + d];
          sum.vector[d] += table.weight[q] * n[d];
          sum.flux += table.weight[q] * n[d] * x;
          square += n[d] * n[d];
        }
        sum.area += table.weight[q] * std::sqrt(square);
      }
    }
    return sum;
  }

 private:
  static constexpr int degree = 7;  // x . n dA of a quadratic face has at most 6

  /// dx_i / dxi_k, stored as (3, 3) with rows i.
  std::array<double, 9> jacobian(const std::vector<std::int32_t>& nodes, const Tabulation& table,
                                 std::size_t q) const {
    std::array<double, 9> j{};
    const auto columns = index(table.dim);
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t i = 0; i < dim_; ++i)
        for (std::size_t k = 0; k < columns; ++k)
          j[i * 3 + k] += mesh_.points[index(nodes[a]) * dim_ + i] *
                          table.dn[(q * nodes.size() + a) * columns + k];
    return j;
  }

  const Mesh& mesh_;
  std::size_t dim_;
};

}  // namespace abut
