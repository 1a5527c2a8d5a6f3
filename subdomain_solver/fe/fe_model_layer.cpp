// The surface layer of finite elements: coordinates whose mass the others of their cells have.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/dense.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/layer_inertia.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"

namespace abut {

namespace {

/// Whether what keeps its mass holds the layer of an undeformed body: a single inner node, and ones
/// that lie on a line, let the surface around them turn. Rounding may give a tangent factors then,
/// so its softest motion is looked for by iterations with them.
bool is_held(FeModel& model, std::size_t massless) {
  if (massless == 0) return true;
  constexpr double singular = 1.0e12;  // stiffest over softest; that of meshes is below 1e9
  constexpr int iterations = 4;
  const std::vector<double> q(index(model.dofs()), 0.0), history(model.history_size(), 0.0);
  LayerResponse response;
  const std::unique_ptr<LinearSolver> solver = make_own_solver();
  if (!model.evaluate_layer(q, history, Model::Want::tangent, response) ||
      !solver->factor(response.tangent))
    return false;
  const double stiffest = response.tangent.diagonal().maxCoeff();
  Vector softest(static_cast<Eigen::Index>(massless)), next;
  for (Eigen::Index i = 0; i < softest.size(); ++i) softest(i) = std::cos(1.0 + double(i * i));
  for (int k = 0; k < iterations; ++k) {
    softest.normalize();
    if (!solver->solve(softest, next) || !next.allFinite()) return false;
    softest.swap(next);
  }
  return stiffest * softest.norm() < singular;
}

/// Of its mass, by how much a node may gain or lose so that centres of mass are one; less than
/// roundings of places is none.
constexpr double most_tilt = 0.9, least_tilt = 1.0e-12;
/// Of the radius of gyration: by how much the centres may differ all the same. What flies would
/// change its angular momentum by more than bodies that turn have.
constexpr double most_apart = 0.05;

/// `whole` [kg] (dofs), all mass on the nodes, made lighter on one side and heavier on the other so
/// that in every direction its centre is that of `layered`, which has the same sum [M.150]. None:
/// they are too far apart for that.
std::optional<Vector> with_centre_of(const Mesh& mesh, const Vector& whole, const Vector& layered) {
  const Eigen::Index dim = mesh.dim, nodes = whole.size() / dim;
  const Eigen::Map<const Eigen::MatrixXd> points(mesh.points.data(), dim, nodes);
  Vector out = whole;
  for (Eigen::Index i = 0; i < dim; ++i) {
    const Eigen::VectorXd mass = whole(Eigen::seqN(i, nodes, dim));
    const Eigen::VectorXd centre = points * mass / mass.sum();
    const Eigen::MatrixXd arms = points.colwise() - centre;
    const Eigen::VectorXd shift = arms * Eigen::VectorXd(layered(Eigen::seqN(i, nodes, dim)));
    const Eigen::VectorXd slope = least_squares(arms * mass.asDiagonal() * arms.transpose(), shift);
    Eigen::VectorXd tilt = arms.transpose() * slope;
    const double most = tilt.cwiseAbs().maxCoeff();
    if (!(most > least_tilt)) continue;
    if (most > most_tilt) {
      const double left = (1.0 - most_tilt / most) * shift.norm() / mass.sum();
      const double gyration = std::sqrt(arms.colwise().squaredNorm().dot(mass) / mass.sum());
      if (left > most_apart * gyration) return std::nullopt;
      tilt *= most_tilt / most;
    }
    out(Eigen::seqN(i, nodes, dim)) += mass.cwiseProduct(tilt);
  }
  return out;
}

}  // namespace

bool FeModel::is_bare(std::int32_t node, int direction) const {
  return std::ranges::binary_search(bare_, node * mesh_.dim + direction);
}

bool FeModel::takes_mass(std::int32_t node, int direction) const {
  return !is_bare(node, direction) &&
         !std::ranges::binary_search(held_, node * mesh_.dim + direction);
}

int FeModel::layer_place(int dof) const {
  const auto at = std::ranges::lower_bound(massless_, dof);
  return at != massless_.end() && *at == dof ? static_cast<int>(at - massless_.begin()) : -1;
}

void FeModel::make_massless(std::vector<int> bare, const std::vector<int>& held,
                            double least_inertia) {
  ABUT_ASSERT(bare_.empty() && (!assembly_ || assembly_->mass.size() == 0));
  bare_ = std::move(bare);
  held_ = held;
  std::ranges::set_difference(bare_, held, std::back_inserter(massless_));
  try {
    find_layer();
    if (!is_held(*this, massless_.size()))
      throw InputError(
          "has a surface that too few nodes inside hold while it is free of "
          "mass, as "
          "contact needs it",
          "mesh", "Make the mesh three elements across, or give fewer ports contact.");
    whole_ = lumped_;
    lump_mass();
    // What is held, and what is round, has no angular momentum to keep.
    if (mesh_.dim > 1 && held.empty() && frames_.empty() && !round()) {
      inertia_left_ = abut::inertia_left(mesh_, whole_, lumped_);
      if (inertia_left_ < least_inertia)
        throw InputError(
            fmt::format("has a surface that leaves {:.0f} % of the moments of inertia while it is "
                        "free of mass",
                        100.0 * inertia_left_),
            "mesh", "Make the mesh three elements across, or give fewer ports contact.");
      std::optional<Vector> centred = with_centre_of(mesh_, whole_, lumped_);
      if (!centred)
        throw InputError(
            "has a surface that leaves most of its mass on one side while it is free of mass, as "
            "contact needs it",
            "mesh", "Make the mesh three elements across, or give fewer ports contact.");
      whole_ = std::move(*centred);
    }
  } catch (const InputError&) {
    if (whole_.size() > 0) lumped_ = std::exchange(whole_, Vector());
    inertia_left_ = 1.0;
    bare_.clear();
    massless_.clear();
    held_.clear();
    layer_cells_.clear();
    heirs_ = {};
    layer_rows_.resize(0, 0);
    layer_measures_.clear();
    throw;
  }
}

/// Cells with bare nodes, and who takes the mass of those that have no other nodes.
void FeModel::find_layer() {
  const auto bare_anywhere = [this](std::int32_t node) {
    const auto first = std::ranges::lower_bound(bare_, node * mesh_.dim);
    return first != bare_.end() && *first < (node + 1) * mesh_.dim;
  };
  for (std::size_t k = 0; k < mesh_.blocks.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    for (int c = 0; c < cells.count(); ++c) {
      if (std::ranges::any_of(nodes_of(cells, c), bare_anywhere))
        layer_cells_.emplace_back(static_cast<int>(k), c);
    }
  }
  for (int i = 0; i < mesh_.dim; ++i) find_heirs(i);
}

/// Cells all of whose nodes are in the layer or held, tetrahedra in corners for instance, have no
/// node that could take their mass: nodes of their neighbours do, or of these ones' neighbours.
void FeModel::find_heirs(int direction) {
  std::vector<std::size_t> poor_cells;  // of layer_cells_
  for (std::size_t l = 0; l < layer_cells_.size(); ++l) {
    const auto& [block, cell] = layer_cells_[l];
    const std::span<const std::int32_t> nodes = nodes_of(mesh_.blocks[block], cell);
    const bool bare =
        std::ranges::any_of(nodes, [=, this](auto n) { return is_bare(n, direction); });
    const bool takes =
        std::ranges::any_of(nodes, [=, this](auto n) { return takes_mass(n, direction); });
    if (bare && !takes) poor_cells.push_back(l);
  }
  if (poor_cells.empty()) return;
  std::vector<std::vector<std::size_t>> around(index(mesh_.node_count()));  // of layer_cells_
  for (std::size_t l = 0; l < layer_cells_.size(); ++l) {
    for (const std::int32_t node :
         nodes_of(mesh_.blocks[layer_cells_[l].first], layer_cells_[l].second))
      around[node].push_back(l);
  }
  for (const std::size_t first : poor_cells) {
    std::vector<std::size_t> reached = {first}, ring = {first};
    std::vector<std::int32_t>& heirs = heirs_[direction][layer_cells_[first]];
    while (heirs.empty() && !ring.empty()) {
      std::vector<std::size_t> next;
      for (const std::size_t l : ring) {
        for (const std::int32_t node :
             nodes_of(mesh_.blocks[layer_cells_[l].first], layer_cells_[l].second)) {
          if (takes_mass(node, direction)) heirs.push_back(node);
          for (const std::size_t other : around[node]) {
            if (std::ranges::find(reached, other) != reached.end()) continue;
            reached.push_back(other);
            next.push_back(other);
          }
        }
      }
      ring = std::move(next);
    }
    if (heirs.empty()) {
      throw InputError(fmt::format("{} has no free node inside the mesh near it, which could take "
                                   "the mass of the surface that contact needs free of mass",
                                   cell_text(mesh_, index(layer_cells_[first].first),
                                             index(layer_cells_[first].second))),
                       "mesh", "Use a finer mesh, or fewer ports for contact.");
    }
    keep_one_each(heirs);
  }
}

/// Of one cell's mass in a direction, what belongs to massless nodes goes to its free others in
/// equal parts: the matrix keeps its sum. Held nodes take none: it would be lost to the motion.
/// That of a cell which has no free others is left to its heirs.
void FeModel::hand_over(std::span<const std::int32_t> nodes, int direction,
                        Eigen::MatrixXd& nodal) const {
  const double total = nodal.sum();
  std::vector<Eigen::Index> takers;
  bool bare = false;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const Eigen::Index at = static_cast<Eigen::Index>(a);
    if (takes_mass(nodes[a], direction)) takers.push_back(at);
    if (!is_bare(nodes[a], direction)) continue;
    bare = true;
    nodal.row(at).setZero();
    nodal.col(at).setZero();
  }
  if (!bare) return;
  const double each = (total - nodal.sum()) / static_cast<double>(takers.size());
  for (const Eigen::Index at : takers) nodal(at, at) += each;
}

/// Calls `take` with every dof of an heir of a cell and the mass [kg] that it takes: what is left
/// of whole(block, cell), the cell's matrix, when it is handed over.
template <class Whole, class Take>
void FeModel::inherit(const Whole& whole, const Take& take) const {
  for (int i = 0; i < mesh_.dim; ++i) {
    for (const auto& [cell, heirs] : heirs_[i]) {
      Eigen::MatrixXd nodal = whole(cell.first, cell.second);
      const double total = nodal.sum();
      hand_over(nodes_of(mesh_.blocks[cell.first], cell.second), i, nodal);
      const double each = (total - nodal.sum()) / static_cast<double>(heirs.size());
      for (const std::int32_t heir : heirs) take(heir * mesh_.dim + i, each);
    }
  }
}

void FeModel::inherit(Vector& lumped) const {
  inherit(
      [this](int block, int cell) { return Eigen::MatrixXd(cell_mass(block, cell).asDiagonal()); },
      [&](int dof, double mass) { lumped(dof) += mass; });
}

void FeModel::inherit(SparseMatrix& mass) const {
  inherit([this](int block, int cell) { return nodal_mass(index(block), cell); },
          [&](int dof, double part) { mass.coeffRef(dof, dof) += part; });
}

/// What a state's part in the layer's answers is, and how large their numbers are.
void FeModel::find_layer_inputs(LayerResponse& out) {
  layer_measures_.assign(blocks_.size(), {});
  for (const auto& [block, cell] : layer_cells_)
    measure_cell(mesh_, mesh_.blocks[block], cell, blocks_[block].table, options_,
                 material_->moduli(), layer_measures_[block]);
  Assembly units;
  for (const CellMeasures& measures : layer_measures_) find_units(measures, units);
  out.force_unit = units.force_unit;
  out.gradient_unit = units.gradient_unit;
  out.coordinates.clear();
  out.history.clear();
  for (const auto& [block, cell] : layer_cells_) {
    for (const std::int32_t node : nodes_of(mesh_.blocks[block], cell))
      for (int i = 0; i < mesh_.dim; ++i) out.coordinates.push_back(node * mesh_.dim + i);
    for (std::size_t k = 0; k < blocks_[block].cell_history; ++k)
      out.history.push_back(first_history(block, cell) + k);
  }
  keep_one_each(out.coordinates);
  find_near_heirs(out.heirs);
}

/// Of the coordinates that take mass in a massless one's cells the nearest, in the reference.
void FeModel::find_near_heirs(std::vector<int>& heirs) const {
  const int dim = mesh_.dim;
  heirs.assign(massless_.size(), -1);
  std::vector<double> nearest(massless_.size(), std::numeric_limits<double>::infinity());
  const auto offer = [&](std::int32_t node, int i, std::int32_t taker) {
    const int place = layer_place(node * dim + i);
    if (place < 0 || !takes_mass(taker, i)) return;
    double square = 0.0;
    for (int k = 0; k < dim; ++k) {
      const double apart = mesh_.points[taker * dim + k] - mesh_.points[node * dim + k];
      square += apart * apart;
    }
    if (!(square < nearest[index(place)])) return;
    nearest[index(place)] = square;
    heirs[index(place)] = taker * dim + i;
  };
  for (const auto& cell : layer_cells_) {
    const std::span<const std::int32_t> nodes = nodes_of(mesh_.blocks[cell.first], cell.second);
    for (int i = 0; i < dim; ++i) {
      const auto others = heirs_[index(i)].find(cell);
      const bool poor = others != heirs_[index(i)].end();
      const std::span<const std::int32_t> takers = poor ? others->second : nodes;
      for (const std::int32_t node : nodes)
        for (const std::int32_t taker : takers) offer(node, i, taker);
    }
  }
}

/// Zeros where the layer's tangent has entries, and where its cells' matrices go.
void FeModel::find_layer_pattern(LayerResponse& out) {
  const int size = static_cast<int>(massless_.size()), dim = mesh_.dim;
  std::vector<Eigen::Triplet<double>> entries;
  layer_places_.clear();
  const auto each_cell = [&](const auto& visit) {
    std::size_t first = 0;
    for (const auto& [block, cell] : layer_cells_) {
      const std::size_t count = nodes_of(mesh_.blocks[block], cell).size() * index(dim);
      visit(std::span(layer_places_).subspan(first, count));
      first += count;
    }
  };
  for (const auto& [block, cell] : layer_cells_)
    for (const std::int32_t node : nodes_of(mesh_.blocks[block], cell))
      for (int i = 0; i < dim; ++i) layer_places_.push_back(layer_place(node * dim + i));
  each_cell([&entries](std::span<const int> places) {
    for (const int row : places)
      for (const int column : places)
        if (row >= 0 && column >= 0) entries.emplace_back(row, column, 0.0);
  });
  out.tangent.resize(size, size);
  out.tangent.setFromTriplets(entries.begin(), entries.end());
  layer_slots_.clear();
  each_cell([&](std::span<const int> places) {
    for (const int column : places)
      for (const int row : places)
        layer_slots_.push_back(
            row < 0 || column < 0
                ? -1
                : static_cast<int>(&out.tangent.coeffRef(row, column) - out.tangent.valuePtr()));
  });
}

/// Rows of the stiffness of a linear model that belong to its layer.
void FeModel::find_layer_rows(std::span<const double> q, std::span<const double> history) {
  const int dim = mesh_.dim;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [block, cell] : layer_cells_) {
    const bool admissible = respond(block, cell, q, history);
    ABUT_ASSERT(admissible);
    const std::span<const std::int32_t> own = nodes_of(mesh_.blocks[block], cell);
    turn(own, nullptr, &local_.tangent);
    for (int a = 0; a < static_cast<int>(local_.tangent.rows()); ++a) {
      const int row = layer_place(own[a / dim] * dim + a % dim);
      for (int b = 0; row >= 0 && b < static_cast<int>(local_.tangent.cols()); ++b)
        entries.emplace_back(row, own[b / dim] * dim + b % dim, local_.tangent(a, b));
    }
  }
  layer_rows_.resize(static_cast<Eigen::Index>(massless_.size()), dofs());
  layer_rows_.setFromTriplets(entries.begin(), entries.end());
}

/// Forces on some coordinates of one node, the rows from `row` on, which have all coordinates of
/// the same nodes as columns. `here`: what displacements differ from. Rows are summed up side by
/// side, each in its order, so that none waits for its own last sum.
template <int dim, int count>
void FeModel::add_layer_rows(Eigen::Index row, const double* q, const double* here,
                             Vector& force) const {
  const int first = layer_rows_.outerIndexPtr()[row];
  const int entries = layer_rows_.outerIndexPtr()[row + 1] - first;
  const int* column = layer_rows_.innerIndexPtr() + first;
  const double* value = layer_rows_.valuePtr() + first;
  std::array<double, count> sum{};
  for (int e = 0; e < entries; e += dim) {
    for (int i = 0; i < dim; ++i) {
      const double difference = q[column[e] + i] - here[i];
      for (int r = 0; r < count; ++r) sum[r] += value[r * entries + e + i] * difference;
    }
  }
  for (int r = 0; r < count; ++r) force(row + r) = sum[r];
}

template <int dim>
void FeModel::linear_layer_force(std::span<const double> q, Vector& force) const {
  const bool translates = frames_.empty() && !round();
  const std::array<double, 3> origin{};
  for (Eigen::Index row = 0; row < layer_rows_.rows();) {
    const int node = massless_[row] / dim;
    Eigen::Index end = row + 1;
    while (end < layer_rows_.rows() && massless_[end] / dim == node) ++end;
    const double* here = translates ? q.data() + node * dim : origin.data();
    if (end - row == 3) {
      add_layer_rows<dim, 3>(row, q.data(), here, force);
    } else if (end - row == 2) {
      add_layer_rows<dim, 2>(row, q.data(), here, force);
    } else {
      add_layer_rows<dim, 1>(row, q.data(), here, force);
    }
    row = end;
  }
}

/// Forces from differences of displacements: a translation makes none, and in one dimension what is
/// far smaller than a rounding of F, which is about 1, counts too.
void FeModel::linear_layer(std::span<const double> q, Want want, LayerResponse& out) {
  if (layer_rows_.size() == 0) find_layer_rows(q, {});
  out.force.setZero(static_cast<Eigen::Index>(massless_.size()));
  if (mesh_.dim == 3) linear_layer_force<3>(q, out.force);
  if (mesh_.dim == 2) linear_layer_force<2>(q, out.force);
  if (mesh_.dim == 1) linear_layer_force<1>(q, out.force);
  if (want == Want::force) return;
  for (Eigen::Index row = 0; row < layer_rows_.rows(); ++row) {
    for (LayerRows::InnerIterator at(layer_rows_, row); at; ++at) {
      const int column = layer_place(static_cast<int>(at.col()));
      if (column >= 0) out.tangent.coeffRef(row, column) = at.value();
    }
  }
}

bool FeModel::batched_layer_force(std::span<const double> q, std::span<const double> history,
                                  LayerResponse& out) {
  if (!batched_layer_) {
    BatchedOptions options = batched_options();
    options.threads = 1;
    std::vector<BatchedLayer::Cell> cells;
    for (const auto& [block, cell] : layer_cells_)
      cells.push_back({block, cell, static_cast<std::int64_t>(first_history(block, cell))});
    batched_layer_ = std::make_unique<BatchedLayer>(mesh_, *material_, options, cells, massless_);
  }
  out.force.resize(static_cast<Eigen::Index>(massless_.size()));
  if (!batched_layer_->evaluate(q, history, {out.force.data(), massless_.size()})) return false;
  out.size = batched_layer_->size();
  return true;
}

/// Tangents come in batches where they can; then forces do, too.
bool FeModel::evaluate_layer(std::span<const double> q, std::span<const double> history, Want want,
                             LayerResponse& out) {
  if (out.tangent.size() == 0) {
    find_layer_pattern(out);
    if (!is_linear()) find_layer_inputs(out);
  }
  if (is_linear()) {
    linear_layer(q, want, out);
    return true;
  }
  const bool tangent = want == Want::tangent;
  bool batched = batched_ && !layer_cells_.empty() && frames_.empty() && !kernel_.guarded();
  if (batched && !tangent) return batched_layer_force(q, history, out);
  for (const auto& [block, cell] : layer_cells_)
    batched = batched && answers_->batched(layer_measures_[block]);
  out.force.setZero(static_cast<Eigen::Index>(massless_.size()));
  if (batched && !batched_layer_force(q, history, out)) return false;
  if (tangent) std::fill_n(out.tangent.valuePtr(), out.tangent.nonZeros(), 0.0);
  double squares = 0.0;
  const int *place = layer_places_.data(), *slot = layer_slots_.data();
  const auto add_tangent = [&out, &slot](const Eigen::MatrixXd& of_cell) {
    for (Eigen::Index k = 0; k < of_cell.size(); ++k, ++slot)
      if (*slot >= 0) out.tangent.valuePtr()[*slot] += of_cell.data()[k];
  };
  for (std::size_t l = 0, begin = 0; l < layer_cells_.size();) {
    const auto [block, cell] = layer_cells_[l];
    if (block != layer_cells_[begin].first) begin = l;  // of the block
    const CellBlock& cells = mesh_.blocks[block];
    if (batched) {
      const auto displacement = [&, this](int k, std::vector<double>& u) {
        gather(cells, layer_cells_[begin + index(k)].second, q, u);
      };
      int count = 1;
      while (count < answers_->most() && l + index(count) < layer_cells_.size() &&
             layer_cells_[l + index(count)].first == block)
        ++count;
      if (!answers_->find_tangents({layer_measures_[block],
                                    static_cast<int>(l - begin),
                                    count,
                                    std::ref(displacement),
                                    {},
                                    {}}))
        return false;
      for (int c = 0; c < count; ++c, ++l) add_tangent(answers_->of(c).tangent);
      continue;
    }
    const CellGeometry geometry = layer_measures_[block].of(static_cast<int>(l++ - begin));
    if (!respond(block, cell, geometry, q, history, tangent ? Need::tangent : Need::stress))
      return false;
    turn(nodes_of(cells, cell), &local_.force, tangent ? &local_.tangent : nullptr);
    squares += local_.force.squaredNorm();
    for (Eigen::Index a = 0; a < local_.force.size(); ++a, ++place)
      if (*place >= 0) out.force(*place) += local_.force(a);
    if (tangent) add_tangent(local_.tangent);
  }
  if (!batched) out.size = std::sqrt(squares);
  return true;
}

}  // namespace abut
