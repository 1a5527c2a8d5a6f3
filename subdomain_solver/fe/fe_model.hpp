#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "subdomain_solver/fe/cell_kernel.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/materials/plane.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

struct FeOptions {
  Plane plane = Plane::strain;  // of meshes in two dimensions
  Formulation formulation = Formulation::full;
  double thickness = 1.0;  // [m] of plane cells; axisymmetric ones span the full circle
};

/// Orthonormal frame of one node (dim x dim, columns are its axes): the node's coordinates q are
/// components along them, which makes an inclined roller a prescribed coordinate.
struct NodeFrame {
  std::int32_t node = 0;
  Matrix3 axes = Matrix3::Identity();
};

/// Finite elements in two or three dimensions, total Lagrangian [M.41]: q holds the nodal
/// displacements (nodes, dim), in the node's own frame where it has one.
class FeModel final : public Model {
 public:
  FeModel(Mesh mesh, std::unique_ptr<const Material> material, const FeOptions& options,
          const std::vector<NodeFrame>& frames = {});

  int dofs() const override { return mesh_.node_count() * mesh_.dim; }
  bool is_linear() const override { return material_->is_linear(); }
  std::size_t history_size() const override { return history_size_; }
  const SparseMatrix& mass() const override { return mass_; }
  const Vector& lumped_mass() const override { return lumped_; }
  double roundoff(std::span<const double> q) const override;
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override;

  const Mesh& mesh() const { return mesh_; }
  const Material& material() const { return *material_; }
  const FeOptions& options() const { return options_; }
  bool round() const { return mesh_.dim == 2 && options_.plane == Plane::axisymmetric; }
  double volume() const;  // [m^3] reference
  /// From the nodes' own frames to the axes of space and back, in place: (nodes, dim).
  void to_space(std::span<double> values) const { rotate(values, false); }
  void to_frames(std::span<double> values) const { rotate(values, true); }

  /// Adds a matrix of some nodes of one cell (nodes x dim), in the axes of space, to a tangent.
  void add_to_tangent(const std::vector<std::int32_t>& nodes, Eigen::MatrixXd local,
                      SparseMatrix& tangent) const;

  /// State of one quadrature point.
  struct PointState {
    int block = 0, cell = 0, point = 0;
    double volume = 0.0;          // [m^3] reference
    Matrix3 deformation, stress;  // F; first Piola-Kirchhoff [Pa]
    std::span<const double> history;
  };
  /// Calls `see` for every quadrature point, in order. False: q is inadmissible.
  [[nodiscard]] bool visit(std::span<const double> q, std::span<const double> history,
                           const std::function<void(const PointState&)>& see);

 private:
  struct Block {  // reference geometry of the cells of one element
    Tabulation table;
    std::vector<double> volume, gradient, hoop;  // (cells, points), (..., nodes, dim), (..., nodes)
    std::vector<std::int32_t> position;  // (cells, nodes, nodes) of the first entry in the tangent
    std::size_t history = 0;             // where its numbers begin
  };

  [[nodiscard]] bool assemble(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out);
  void measure(const CellBlock& cells, Block& block) const;
  void find_units(const Block& block);
  void find_pattern();
  void assemble_mass();
  CellGeometry geometry(const Block& block, int cell) const;
  void gather(const CellBlock& cells, int cell, std::span<const double> q,
              std::vector<double>& u) const;
  void scatter(const CellBlock& cells, const Block& block, int cell, Want want, CellResponse& local,
               ModelResponse& out) const;
  void add_matrix(const CellBlock& cells, const Block& block, int cell,
                  const Eigen::MatrixXd& local, SparseMatrix& out) const;
  const Matrix3* frame(std::int32_t node) const;
  void rotate(std::span<double> values, bool into_frames) const;
  void turn(std::span<const std::int32_t> nodes, Eigen::VectorXd* force,
            Eigen::MatrixXd* matrix) const;

  Mesh mesh_;
  std::unique_ptr<const Material> material_;
  FeOptions options_;
  std::vector<Block> blocks_;
  std::size_t history_size_ = 0;
  std::vector<NodeFrame> frames_;  // sorted by node; usually none
  SparseMatrix pattern_;           // zeros where the tangent has entries
  SparseMatrix stiffness_;         // of linear models, which need no other
  double force_unit_ = 0.0;        // [N] largest force of a cell at unit strain
  double gradient_unit_ = 0.0;     // [1/m] largest gradient of a shape function
  SparseMatrix mass_;
  Vector lumped_;
  CellKernel kernel_;
  CellResponse local_;
  std::vector<double> u_;
};

}  // namespace abut
