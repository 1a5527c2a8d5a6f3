#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/batched_cells.hpp"
#include "subdomain_solver/fe/batched_layer.hpp"
#include "subdomain_solver/fe/cell_answers.hpp"
#include "subdomain_solver/fe/node_frame.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

/// Finite elements in one, two or three dimensions, total Lagrangian [M.41]: q holds the nodal
/// displacements (nodes, dim), in the node's own frame where it has one. What only tangents need
/// (geometry at all points, pattern, consistent mass) is made when first asked for: forces by
/// batched cells need none of it.
class FeModel final : public Model {
 public:
  /// A mesh in one dimension is a bar of the options' area, under uniaxial stress. Throws
  /// InputError for mean_dilatation under plane or uniaxial stress.
  FeModel(Mesh mesh, std::unique_ptr<const Material> material, const FeOptions& options,
          const std::vector<NodeFrame>& frames = {});

  int dofs() const override { return mesh_.node_count() * mesh_.dim; }
  bool is_linear() const override { return material_->is_linear(); }
  std::size_t history_size() const override { return history_size_; }
  const SparseMatrix& mass() const override;
  const Vector& lumped_mass() const override { return lumped_; }
  WorkerThreads* threads() override { return &answers_->threads(); }
  double roundoff(std::span<const double> q) const override;
  [[nodiscard]] bool evaluate(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out) override;
  const std::vector<int>& massless() const override { return massless_; }
  [[nodiscard]] bool evaluate_layer(std::span<const double> q, std::span<const double> history,
                                    Want want, LayerResponse& out) override;

  /// Moves the mass of these dofs (sorted) to those of the others of their cells, direction by
  /// direction (the surface layer, [M.85]), once, before anything asks for a mass; cells that have
  /// no others give theirs to the nearest nodes that have some. `held`: dofs (sorted) whose motion
  /// is prescribed, no coordinates of the layer. Throws InputError where no node is left, or less
  /// than `least_inertia` of the moments of inertia; all masses are as before then.
  void make_massless(std::vector<int> bare, const std::vector<int>& held,
                     double least_inertia = 0.0);

  /// [kg] (dofs) lumped, as if none were massless, with the centre that the layer leaves [M.150].
  const Vector& whole_mass() const { return whole_.size() > 0 ? whole_ : lumped_; }
  SparseMatrix whole_consistent_mass() const;  // [kg] (dofs, dofs) as if none were massless
  /// [kg] (dofs, dofs) that coordinates without mass, the rows, gave to others.
  SparseMatrix given_mass() const;
  double inertia_left() const { return inertia_left_; }  // [M.162]; 1 of what is held or round

  const Mesh& mesh() const { return mesh_; }
  const Material& material() const { return *material_; }
  const FeOptions& options() const { return options_; }
  bool round() const { return mesh_.dim == 2 && options_.plane == Plane::axisymmetric; }
  double volume() const;  // [m^3] reference
  bool has_frames() const { return !frames_.empty(); }
  const Matrix3* frame(std::int32_t node) const;  // its own; null: the axes of space
  /// From the nodes' own frames to the axes of space and back, in place: (nodes, dim).
  void to_space(std::span<double> values) const { rotate(values, false); }
  void to_frames(std::span<double> values) const { rotate(values, true); }
  /// Adds a matrix of a cell's nodes (nodes x dim), in the axes of space, to a tangent of frames.
  void add_to_tangent(const std::vector<std::int32_t>& nodes, Eigen::MatrixXd& local,
                      SparseMatrix& tangent) const;
  /// The tangent, where cells that are indefinite even together with `inertia` [1/s^2] times their
  /// own lumped mass have that of their definite part. False: q is inadmissible.
  [[nodiscard]] bool definite_tangent(std::span<const double> q, std::span<const double> history,
                                      double inertia, SparseMatrix& tangent);
  /// From now on the law is stiffened, or not, where cells are crushed [M.140]; whether it is.
  bool guard(bool on);
  /// The least det F of the quadrature points at q; of bodies that cannot be guarded 1.
  double least_volume(std::span<const double> q) const;

  /// Tangent of one cell at q (nodes x dim), in the axes of space. False: inadmissible.
  [[nodiscard]] bool cell_tangent(int block, int cell, std::span<const double> q,
                                  std::span<const double> history, Eigen::MatrixXd& tangent);
  /// Its share of the lumped mass [kg] (nodes), that of massless nodes still theirs: stable steps
  /// that hold with it hold with a layer, which only adds to the masses inside.
  Vector cell_mass(int block, int cell) const;
  /// Its reference geometry, as that of one cell.
  CellMeasures cell_measures(int block, int cell) const;
  /// The rule at which a block's cells are integrated.
  const Tabulation& rule(int block) const { return blocks_[block].table; }
  const Tabulation& mass_rule(int block) const { return blocks_[block].mass_table; }
  BatchedCells* batched() { return batched_.get(); }  // null: forces are found cell by cell

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
  struct Block {  // the cells of one element
    Tabulation table, mass_table;
    std::size_t history = 0, cell_history = 0;  // where its numbers begin; numbers of each cell
  };
  struct Assembly {                                   // of whole matrices
    std::vector<CellMeasures> measures;               // (blocks)
    std::vector<std::vector<std::int32_t>> position;  // (blocks; cells, pairs) first entry of each
    SparseMatrix pattern;                             // zeros where the tangent has entries
    SparseMatrix stiffness;                           // of linear models, which need no other
    std::vector<double> springs;                      // [N/m] (cells) of linear bars
    SparseMatrix mass;
    std::vector<Vector> cell_masses;  // [kg] (cells; nodes), when first asked for
    double force_unit = 0.0;          // [N] largest force of a cell at unit strain
    double gradient_unit = 0.0;       // [1/m] largest gradient of a shape function
  };

  Assembly& assembly() const;
  [[nodiscard]] bool assemble(std::span<const double> q, std::span<const double> history, Want want,
                              ModelResponse& out);
  void find_units(const CellMeasures& measures, Assembly& out) const;
  void find_pattern(Assembly& out) const;
  void assemble_mass(SparseMatrix& out, bool layered) const;
  void lump_mass();
  Eigen::MatrixXd nodal_mass(std::size_t block, int cell) const;
  int layer_place(int dof) const;                        // among the massless; -1: it is none
  bool is_bare(std::int32_t node, int direction) const;  // it has no mass in it
  bool can_be_crushed() const;
  bool takes_mass(std::int32_t node, int direction) const;  // of bare ones: it is free
  void find_layer();
  void find_heirs(int direction);
  void hand_over(std::span<const std::int32_t> nodes, int direction, Eigen::MatrixXd& nodal) const;
  template <class Whole, class Take>
  void inherit(const Whole& whole, const Take& take) const;
  void inherit(Vector& lumped) const;
  const std::vector<Vector>& cell_masses() const;
  void inherit(SparseMatrix& mass) const;
  const SparseMatrix& linear_stiffness();
  const Vector& strain_displacement(std::span<const double> q);
  void find_layer_pattern(LayerResponse& out);
  void find_layer_inputs(LayerResponse& out);
  void find_near_heirs(std::vector<int>& heirs) const;
  void find_layer_rows(std::span<const double> q, std::span<const double> history);
  template <int dim, int count>
  void add_layer_rows(Eigen::Index row, const double* q, const double* here, Vector& force) const;
  template <int dim>
  void linear_layer_force(std::span<const double> q, Vector& force) const;
  void linear_layer(std::span<const double> q, Want want, LayerResponse& out);
  void spring_force(std::span<const double> q, ModelResponse& out) const;
  BatchedOptions batched_options() const;
  [[nodiscard]] bool batched_layer_force(std::span<const double> q, std::span<const double> history,
                                         LayerResponse& out);
  [[nodiscard]] bool batched_force(std::span<const double> q, std::span<const double> history,
                                   ModelResponse& out);
  std::size_t first_history(int block, int cell) const;  // where a cell's numbers begin
  [[nodiscard]] bool respond(int block, int cell, std::span<const double> q,
                             std::span<const double> history);
  [[nodiscard]] bool respond(int block, int cell, const CellGeometry& geometry,
                             std::span<const double> q, std::span<const double> history, Need need);
  void gather(const CellBlock& cells, int cell, std::span<const double> q,
              std::vector<double>& u) const;
  void scatter(std::size_t block, int cell, CellResponse& local, ModelResponse& out) const;
  void add_matrix(std::size_t block, int cell, const Assembly& assembly,
                  const Eigen::MatrixXd& local, SparseMatrix& out) const;
  void rotate(std::span<double> values, bool into_frames) const;
  void turn(std::span<const std::int32_t> nodes, Eigen::VectorXd* force,
            Eigen::MatrixXd* matrix) const;

  Mesh mesh_;
  std::unique_ptr<const Material> material_;
  FeOptions options_;
  std::vector<Block> blocks_;
  std::size_t history_size_ = 0;
  std::vector<NodeFrame> frames_;  // sorted by node; usually none
  using LayerRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  std::vector<int> bare_;                         // dofs without mass, ascending; usually none
  std::vector<int> massless_;                     // of them, those that are not held
  std::vector<int> held_;                         // dofs, ascending, where there are bare ones
  std::vector<std::pair<int, int>> layer_cells_;  // (block, cell) that touch them
  // by direction, of cells without a node that takes mass there: nodes near that do
  std::array<std::map<std::pair<int, int>, std::vector<std::int32_t>>, 3> heirs_;
  // by cell of the layer: its coordinates among the massless (-1: none), its entries in the tangent
  std::vector<int> layer_places_, layer_slots_;
  std::vector<CellMeasures> layer_measures_;  // the same, where no assembly has them
  LayerRows layer_rows_;  // [N/m] (massless, dofs) of linear models, when first asked for
  mutable std::unique_ptr<Assembly> assembly_;
  std::unique_ptr<BatchedCells> batched_;        // null: cell by cell
  std::unique_ptr<BatchedLayer> batched_layer_;  // where batched_ is; when first asked for
  Vector lumped_, whole_;  // whole_: as lumped_ was before make_massless(); empty: the same
  double inertia_left_ = 1.0;
  CellKernel kernel_;
  std::unique_ptr<CellAnswers> answers_;  // of all cells
  CellResponse local_;
  std::vector<double> u_;
  Vector relative_;            // (dofs) of linear models
  std::vector<double> after_;  // history that nobody asked for
};

}  // namespace abut
