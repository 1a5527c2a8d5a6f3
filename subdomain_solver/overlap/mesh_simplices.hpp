#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/overlap/simplices.hpp"
#include "surface/boxes.hpp"

namespace abut {

/// A cell of a mesh.
struct CellPlace {
  std::int32_t block = 0, cell = 0;
  bool operator==(const CellPlace&) const = default;
};

/// The cells of a mesh of first order in two or three dimensions, divided into triangles or
/// tetrahedra: a fan from each cell's lowest node, whose quadrilateral facets are divided from
/// theirs, so that neighbours agree. The mesh must outlive it.
class MeshSimplices {
 public:
  explicit MeshSimplices(const Mesh& mesh);

  const Mesh& mesh() const { return mesh_; }
  int count() const { return static_cast<int>(owner_.size()); }
  Simplex simplex(int i) const;
  const CellPlace& cell(int i) const { return owner_[i]; }
  double spacing() const { return spacing_; }  // [m] of a usual cell
  const BoxTree& tree() const { return tree_; }

 private:
  void add_fan(CellPlace place);

  const Mesh& mesh_;
  std::vector<std::int32_t> nodes_, offsets_;  // of the simplices, as facets of a surface
  std::vector<CellPlace> owner_;               // (simplices)
  double spacing_ = 0.0;
  BoxTree tree_;
};

/// Facets of a boundary, divided into segments or triangles in their own sense.
struct BoundarySimplices {
  BoundarySimplices(const Mesh& mesh, const std::vector<Facet>& facets);

  int count() const { return static_cast<int>(offsets.size()) - 1; }
  Simplex simplex(int i) const;

  const Mesh& mesh;
  std::vector<std::int32_t> nodes, offsets = {0};
  std::vector<std::int32_t> facet;  // (simplices) place in the list they were made of
  BoxTree tree;
};

/// Reference coordinates (dim) of a place in a cell or beside it.
std::vector<double> reference_place(const Mesh& mesh, CellPlace cell, const Eigen::Vector3d& at);

/// Shape functions of the cell's nodes there.
std::vector<double> shape_values(const Mesh& mesh, CellPlace cell, const std::vector<double>& xi);

}  // namespace abut
