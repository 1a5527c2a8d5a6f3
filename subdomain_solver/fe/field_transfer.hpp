#pragma once

#include <memory>
#include <span>
#include <vector>

#include "contract/field.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

/// Fields of one mesh of a body on another mesh of it: the nearest ones in the mean square over the
/// mass [M.155]. Every field that both meshes can have is kept to round-off, rigid motions and
/// homogeneous strains among them. Places of the new mesh that lie outside the old one, as along
/// curved sides, take what the nearest cell says beyond its sides.
class FieldTransfer {
 public:
  /// `round`: mass grows with the first coordinate, about the axis of an axisymmetric body. Throws
  /// RunError: the grid has cells of another dimension, or of a kind that meshes do not have.
  FieldTransfer(const Grid& from, const Mesh& to, bool round);

  /// Nodes and cells are the same: values are passed on as they are.
  bool same() const { return same_; }
  /// Values (nodes, dim) of values (nodes of the grid, 3), along the axes of space. Throws
  /// RunError where the new mesh's equations have no answer.
  std::vector<double> to_nodes(std::span<const double> values);

 private:
  /// A place of the new mesh where both meshes are read.
  struct Sample {
    double weight = 0.0;                   // [m^dim] of its part of the mass
    std::vector<std::int32_t> nodes, own;  // of the old mesh, of the new one
    std::vector<double> n, own_n;          // shape functions of these
  };
  void take_samples(bool round);
  void factor();

  const Mesh& to_;
  Mesh from_;
  bool same_ = false;
  std::vector<Sample> samples_;
  std::unique_ptr<LinearSolver> solver_;
};

}  // namespace abut
