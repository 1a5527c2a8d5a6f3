#include "subdomain_solver/fe/slower_cells.hpp"

#include <algorithm>
#include <optional>

#include "subdomain_solver/fe/batched_law.hpp"

namespace abut {

namespace {

/// By which the square is lowered: far above the rounding of tangents and of elimination, so that a
/// cell that is told slower is so for whoever computes it in another order.
constexpr double room_for_rounding = 1.0e-9;

/// (nodes, dim, 8) what the cells' nodes have; the last cell stands in for those that there are
/// not.
void lay_out_nodes(const CellBlock& cells, std::span<const int> asked, int dim,
                   std::span<const double> values, std::vector<double>& out) {
  const int nodes = cells.element->nodes;
  out.resize(index(nodes * dim * batch_lanes));
  for (int l = 0; l < batch_lanes; ++l) {
    const int cell = asked[std::min(index(l), asked.size() - 1)];
    const std::int32_t* own = cells.nodes.data() + index(cell) * index(nodes);
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i)
        out[index((a * dim + i) * batch_lanes + l)] = values[index(own[a]) * index(dim) + index(i)];
  }
}

bool all_zero(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return x == 0.0; });
}

}  // namespace

SlowerCells::SlowerCells(const FeModel& model) : model_(model), kernels_(stiffness_here()) {
  const Mesh& mesh = model.mesh();
  const FeOptions& options = model.options();
  const std::optional<BatchedLaw> law = batched_law_of(model.material());
  parameters_.moduli = model.material().moduli();
  blocks_.resize(mesh.blocks.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const CellBlock& cells = mesh.blocks[b];
    Block& block = blocks_[b];
    const bool mean = options.formulation == Formulation::mean_dilatation;
    block.one_volume = mean && model.rule(static_cast<int>(b)).points > 1;
    block.can = kernels_.fuses && law && mesh.dim > 1 && cells.element->dim == mesh.dim &&
                !model.round() && options.formulation != Formulation::one_point &&
                (!mean || cells.element->order == 1) && cells.shares.empty();
    if (block.can && !model.is_linear())
      block.stiffness = kernels_.of(*law, mesh.dim, block.one_volume);
  }
}

/// At rest all laws have the tangent of Saint Venant's and Kirchhoff's with their moduli; linear
/// ones have it always. False: a law has no batched tangent here, or a cell no answer.
bool SlowerCells::find_stiffness(int block, std::span<const int> cells, std::span<const double> u,
                                 std::span<const double> history) {
  const Mesh& mesh = model_.mesh();
  const CellBlock& of = mesh.blocks[index(block)];
  const Tabulation& rule = model_.rule(block);
  const Block& how = blocks_[index(block)];
  const int each = rule.nodes * mesh.dim;
  StiffnessKernel kernel = how.stiffness;
  lay_out_nodes(of, cells, mesh.dim, u, displacement_);
  if (kernel == nullptr) {
    if (!model_.is_linear() && !(all_zero(displacement_) && all_zero(history))) return false;
    displacement_.assign(displacement_.size(), 0.0);
    kernel = kernels_.of(BatchedLaw::saint_venant_kirchhoff, mesh.dim, how.one_volume);
  }
  gradient_.resize(index(rule.points * each * batch_lanes));
  volume_.resize(index(rule.points * batch_lanes));
  const ShapeKernel measure = mesh.dim == 3 ? kernels_.space_shape : kernels_.flat_shape;
  measure({rule.nodes, rule.points, rule.weight.data(), rule.dn.data(), place_.data(),
           volume_.data(), gradient_.data()});
  stiffness_.resize(index(rule.nodes * (rule.nodes + 1) / 2 * mesh.dim * mesh.dim * batch_lanes));
  return kernel({rule.nodes, rule.points, volume_.data(), gradient_.data(), displacement_.data(),
                 stiffness_.data()},
                parameters_);
}

/// Shares as FeModel::cell_mass() scales them; of unit thickness, as the stiffness is.
void SlowerCells::find_mass(int block) {
  const Tabulation& rule = model_.mass_rule(block);
  volume_.resize(index(rule.points * batch_lanes));
  const bool space = model_.mesh().dim == 3;
  (space ? kernels_.space_shape : kernels_.flat_shape)(
      {rule.nodes, rule.points, rule.weight.data(), rule.dn.data(), place_.data(), volume_.data()});
  mass_.assign(index(rule.nodes * batch_lanes), 0.0);
  double whole[batch_lanes] = {}, trace[batch_lanes] = {};
  for (int p = 0; p < rule.points; ++p) {
    const double* volume = volume_.data() + p * batch_lanes;
    for (int l = 0; l < batch_lanes; ++l) whole[l] += volume[l];
    for (int a = 0; a < rule.nodes; ++a) {
      const double n = rule.n[index(p * rule.nodes + a)], square = n * n;
      double* mass = mass_.data() + a * batch_lanes;
      for (int l = 0; l < batch_lanes; ++l) mass[l] += square * volume[l];
    }
  }
  for (int a = 0; a < rule.nodes; ++a)
    for (int l = 0; l < batch_lanes; ++l) trace[l] += mass_[index(a * batch_lanes + l)];
  const double density = model_.material().density();
  for (int l = 0; l < batch_lanes; ++l) trace[l] = density * whole[l] / trace[l];
  for (int a = 0; a < rule.nodes; ++a)
    for (int l = 0; l < batch_lanes; ++l) mass_[index(a * batch_lanes + l)] *= trace[l];
}

unsigned SlowerCells::find(int block, std::span<const int> cells, std::span<const double> u,
                           std::span<const double> history, double square) {
  const Mesh& mesh = model_.mesh();
  const CellBlock& of = mesh.blocks[index(block)];
  lay_out_nodes(of, cells, mesh.dim, mesh.points, place_);
  if (!can(block) || !find_stiffness(block, cells, u, history)) return 0;
  find_mass(block);
  const int nodes = of.element->nodes, size = nodes * mesh.dim;
  rows_.resize(index(size * (size + 1) / 2 * batch_lanes));
  const SlownessBatch batch{nodes, (1.0 - room_for_rounding) * square, stiffness_.data(),
                            mass_.data(), rows_.data()};
  const unsigned slower =
      mesh.dim == 3 ? kernels_.space_slowness(batch) : kernels_.flat_slowness(batch);
  return slower & ((1u << cells.size()) - 1u);
}

}  // namespace abut
