#include "subdomain_solver/fe/fe_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/materials/stress_free.hpp"

namespace abut {

namespace {

// Parts of one node, and what it shares with all nodes of a cell: bounded, so that they need no
// allocation.
constexpr int most_values = 3 * 27;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using Axes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using CellRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, most_values>;
using CellColumns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_values, 3>;

std::unique_ptr<const Material> in_its_space(std::unique_ptr<const Material> law, int dim,
                                             const FeOptions& options) {
  const bool sheet = dim == 2 && options.plane == Plane::stress;
  if (dim != 1 && !sheet) return law;
  if (options.formulation == Formulation::mean_dilatation)
    throw InputError("mean_dilatation does not apply where the volume is free to change across",
                     "formulation", "Use full: plane and uniaxial stress cannot lock.");
  if (sheet) return std::make_unique<PlaneStress>(std::move(law));
  return std::make_unique<UniaxialStress>(std::move(law));
}

/// Degrees that the radius adds: one as the factor of the volume. At the one point of a triangle
/// the hoop strain of a ring that turns in its section would vanish, and its energy with it.
int ring_degrees(const Element& element) {
  return element.shape == Shape::triangle && element.order == 1 ? 2 : 1;
}

}  // namespace

FeModel::FeModel(Mesh mesh, std::unique_ptr<const Material> material, const FeOptions& options,
                 const std::vector<NodeFrame>& frames)
    : mesh_(std::move(mesh)),
      material_(in_its_space(std::move(material), mesh_.dim, options)),
      options_(options),
      frames_(frames),
      kernel_(*material_) {
  ABUT_ASSERT(mesh_.dim >= 1 && mesh_.dim <= 3);
  std::sort(frames_.begin(), frames_.end(),
            [](const NodeFrame& a, const NodeFrame& b) { return a.node < b.node; });
  for (const CellBlock& cells : mesh_.blocks) {
    const Element& element = *cells.element;
    ABUT_ASSERT(options.formulation != Formulation::one_point || element.order == 1);
    Block block;
    const int degree = stiffness_degree(element) + (round() ? ring_degrees(element) : 0);
    block.table = tabulate(element, quadrature(element.shape, degree));
    block.mass_table = tabulate(element, quadrature(element.shape, mass_degree(element)));
    block.history = history_size_;
    const int points = law_points(element, block.table, options.formulation);
    block.cell_history = index(points) * index(kernel_.history_size());
    history_size_ += index(cells.count()) * block.cell_history;
    blocks_.push_back(std::move(block));
  }
  lump_mass();
  const bool plain = mesh_.dim == 3 || options.plane == Plane::strain;
  if (options.batched && plain && BatchedCells::can(mesh_, *material_, options.formulation)) {
    batched_ = std::make_unique<BatchedCells>(mesh_, *material_, batched_options());
    // Frequencies are then found cell by cell, step after step, by measures that are kept.
    if (!batched_->bounds() && !is_linear()) assembly();
  }
  answers_ =
      std::make_unique<CellAnswers>(*material_, options, mesh_.dim,
                                    batched_ ? &batched_->threads() : nullptr, batched_ != nullptr);
}

BatchedOptions FeModel::batched_options() const {
  return {options_.formulation, options_.hourglass, options_.thickness, options_.threads};
}

FeModel::Assembly& FeModel::assembly() const {
  if (assembly_) return *assembly_;
  assembly_ = std::make_unique<Assembly>();
  const Moduli moduli = material_->moduli();
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    CellMeasures measures;
    for (int c = 0; c < mesh_.blocks[k].count(); ++c)
      measure_cell(mesh_, mesh_.blocks[k], c, blocks_[k].table, options_, moduli, measures);
    measures.volume.shrink_to_fit();
    measures.gradient.shrink_to_fit();
    find_units(measures, *assembly_);
    assembly_->measures.push_back(std::move(measures));
  }
  find_pattern(*assembly_);
  return *assembly_;
}

/// Largest gradient of a shape function, and the force of a unit strain on a cell.
void FeModel::find_units(const CellMeasures& measures, Assembly& out) const {
  const std::size_t points = index(measures.points);
  for (std::size_t p = 0; p < measures.volume.size(); p += points) {
    double volume = 0.0, steepest = 0.0;
    for (std::size_t k = 0; k < points; ++k) volume += measures.volume[p + k];
    const std::size_t each = index(measures.nodes * measures.dim);
    for (std::size_t k = p * each; k < (p + points) * each; ++k)
      steepest = std::max(steepest, std::abs(measures.gradient[k]));
    out.gradient_unit = std::max(out.gradient_unit, steepest);
    out.force_unit = std::max(out.force_unit, material_->moduli().p_wave() * volume * steepest);
  }
}

/// Entries of the tangent: all pairs of nodes that share a cell. Columns of one node have the same
/// rows, so the place of a pair's first entry is enough to find the others.
void FeModel::find_pattern(Assembly& out) const {
  const int dim = mesh_.dim;
  std::vector<std::vector<std::int32_t>> neighbours(index(mesh_.node_count()));
  for (const CellBlock& cells : mesh_.blocks) {
    for (int c = 0; c < cells.count(); ++c) {
      for (std::int32_t a : nodes_of(cells, c)) {
        for (std::int32_t b : nodes_of(cells, c)) neighbours[b].push_back(a);
      }
    }
  }
  Eigen::VectorXi sizes(dofs());
  for (std::size_t b = 0; b < neighbours.size(); ++b) {
    keep_one_each(neighbours[b]);
    for (int k = 0; k < dim; ++k)
      sizes(static_cast<int>(b) * dim + k) = static_cast<int>(neighbours[b].size()) * dim;
  }
  out.pattern.resize(dofs(), dofs());
  out.pattern.reserve(sizes);
  for (std::size_t b = 0; b < neighbours.size(); ++b) {
    for (int k = 0; k < dim; ++k) {
      for (std::int32_t a : neighbours[b]) {
        for (int i = 0; i < dim; ++i)
          out.pattern.insert(a * dim + i, static_cast<int>(b) * dim + k) = 0.0;
      }
    }
  }
  out.pattern.makeCompressed();
  for (const CellBlock& cells : mesh_.blocks) {
    std::vector<std::int32_t>& position = out.position.emplace_back();
    for (int c = 0; c < cells.count(); ++c) {
      for (std::int32_t a : nodes_of(cells, c)) {
        for (std::int32_t b : nodes_of(cells, c)) {
          const std::vector<std::int32_t>& rows = neighbours[b];
          const auto at = std::lower_bound(rows.begin(), rows.end(), a) - rows.begin();
          position.push_back(out.pattern.outerIndexPtr()[b * dim] +
                             static_cast<std::int32_t>(at) * dim);
        }
      }
    }
  }
}

/// Of a linear model.
const SparseMatrix& FeModel::linear_stiffness() {
  SparseMatrix& stiffness = assembly().stiffness;
  if (stiffness.size() > 0) return stiffness;
  const std::vector<double> rest(index(dofs()), 0.0);
  ModelResponse response;
  const bool admissible = assemble(rest, {}, Want::tangent, response);
  ABUT_ASSERT(admissible);
  stiffness = response.tangent;
  return stiffness;
}

bool FeModel::evaluate(std::span<const double> q, std::span<const double> history, Want want,
                       ModelResponse& out) {
  if (batched_ && want == Want::force && !kernel_.guarded()) return batched_force(q, history, out);
  if (!is_linear()) return assemble(q, history, want, out);
  const SparseMatrix& stiffness = linear_stiffness();
  out.dissipation = 0.0;
  out.history.clear();
  if (want == Want::tangent) out.tangent = stiffness;
  if (mesh_.dim == 1 && frames_.empty() && mesh_.blocks.front().element->nodes == 2) {
    spring_force(q, out);
    return true;
  }
  const Vector& u = strain_displacement(q);
  out.force.noalias() = stiffness * u;
  out.stored = 0.5 * u.dot(out.force);
  return true;
}

/// Displacements less that of the first node, where the body has gone far: a translation makes no
/// force, whose rounding would grow with the way and move the body.
const Vector& FeModel::strain_displacement(std::span<const double> q) {
  relative_ = Eigen::Map<const Vector>(q.data(), dofs());
  if (!frames_.empty() || round()) return relative_;
  const int dim = mesh_.dim;
  Eigen::Map<Eigen::MatrixXd> by_node(relative_.data(), dim, dofs() / dim);
  const Eigen::Map<const Vector> first(q.data(), dim);
  by_node.colwise() -= first;
  constexpr double far = 16.0;
  if (first.lpNorm<Eigen::Infinity>() < far * relative_.lpNorm<Eigen::Infinity>())
    relative_ = Eigen::Map<const Vector>(q.data(), dofs());
  return relative_;
}

/// Forces of a linear bar cancel exactly in pairs, and a translation makes none: they come from
/// differences of displacements.
void FeModel::spring_force(std::span<const double> q, ModelResponse& out) const {
  const CellBlock& cells = mesh_.blocks.front();
  std::vector<double>& springs = assembly().springs;
  if (springs.empty()) {
    for (int c = 0; c < cells.count(); ++c)
      springs.push_back(-assembly().stiffness.coeff(nodes_of(cells, c)[0], nodes_of(cells, c)[1]));
  }
  out.force.setZero(dofs());
  out.stored = 0.0;
  for (std::size_t c = 0; c < springs.size(); ++c) {
    const std::int32_t left = cells.nodes[2 * c], right = cells.nodes[2 * c + 1];
    const double stretch = q[right] - q[left], tension = springs[c] * stretch;
    out.force(left) -= tension;
    out.force(right) += tension;
    out.stored += 0.5 * tension * stretch;
  }
}

std::size_t FeModel::first_history(int block, int cell) const {
  return blocks_[block].history + index(cell) * blocks_[block].cell_history;
}

bool FeModel::batched_force(std::span<const double> q, std::span<const double> history,
                            ModelResponse& out) {
  out.history.resize(history_size_);
  out.force.resize(dofs());
  const std::span<double> force(out.force.data(), index(dofs()));
  const PointHistories histories{history, out.history};
  if (!frames_.empty()) {
    u_.assign(q.begin(), q.end());
    to_space(u_);
    q = u_;
  }
  CellEnergies energies;
  const bool admissible = batched_->evaluate(q, histories, force, energies);
  out.stored = energies.stored;
  out.dissipation = energies.dissipated;
  if (!frames_.empty()) to_frames(force);
  return admissible;
}

/// Strains are differences of displacements over a node distance: a body that has travelled loses
/// what its displacement has more digits than that distance. Other laws than linear ones also round
/// F, which is about 1.
double FeModel::roundoff(std::span<const double> q) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const Assembly& units = assembly();
  const Eigen::Map<const Vector> u(q.data(), dofs());
  const double travel = u.lpNorm<Eigen::Infinity>() * units.gradient_unit;
  const double strain = is_linear() ? travel : std::max(1.0, travel);
  return summed_roundings * epsilon * units.force_unit * strain *
         std::sqrt(static_cast<double>(dofs()));
}

/// Threads answer for some cells at a time, one adds them up, cell after cell. Where tangents come
/// in batches, so do forces, and all at once.
bool FeModel::assemble(std::span<const double> q, std::span<const double> history, Want want,
                       ModelResponse& out) {
  const Assembly& reference = assembly();
  const bool tangents = want == Want::tangent;
  const bool batches = tangents && batched_ &&
                       std::ranges::all_of(reference.measures, [this](const CellMeasures& m) {
                         return answers_->batched(m);
                       });
  if (batches) {
    if (!batched_force(q, history, out)) return false;
  } else {
    out.force.setZero(dofs());
    out.history.resize(history_size_);
    out.stored = out.dissipation = 0.0;
  }
  if (tangents) out.tangent = reference.pattern;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const auto displacement = [&cells, q, this](int cell, std::vector<double>& u) {
      gather(cells, cell, q, u);
    };
    for (int first = 0; first < cells.count(); first += answers_->most()) {
      const std::size_t at = first_history(static_cast<int>(k), first);
      const CellsAsked asked{reference.measures[k],
                             first,
                             std::min(answers_->most(), cells.count() - first),
                             std::ref(displacement),
                             history.subspan(at),
                             std::span(out.history).subspan(at)};
      const bool admissible =
          batches ? answers_->find_tangents(asked)
                  : answers_->evaluate(asked, tangents ? Need::tangent : Need::stress);
      if (!admissible) return false;
      for (int c = 0; c < asked.count; ++c) {
        CellResponse& answer = answers_->of(c);
        turn(nodes_of(cells, first + c), batches ? nullptr : &answer.force,
             tangents ? &answer.tangent : nullptr);
        if (!batches) scatter(k, first + c, answer, out);
        if (tangents) add_matrix(k, first + c, reference, answer.tangent, out.tangent);
      }
    }
  }
  return true;
}

void FeModel::gather(const CellBlock& cells, int cell, std::span<const double> q,
                     std::vector<double>& u) const {
  const int dim = mesh_.dim;
  u.clear();
  for (std::int32_t node : nodes_of(cells, cell)) {
    for (int i = 0; i < dim; ++i) u.push_back(q[node * dim + i]);
    if (const Matrix3* axes = frame(node)) {
      Eigen::Map<Vector> local(u.data() + u.size() - index(dim), dim);
      const SmallVector given = local;
      local.noalias() = axes->topLeftCorner(dim, dim) * given;
    }
  }
}

void FeModel::scatter(std::size_t block, int cell, CellResponse& local, ModelResponse& out) const {
  const int dim = mesh_.dim;
  int a = 0;
  for (std::int32_t node : nodes_of(mesh_.blocks[block], cell)) {
    out.force.segment(node * dim, dim) += local.force.segment(dim * a, dim);
    ++a;
  }
  out.stored += local.stored;
  out.dissipation += local.dissipation;
}

void FeModel::add_matrix(std::size_t block, int cell, const Assembly& assembly,
                         const Eigen::MatrixXd& local, SparseMatrix& out) const {
  const CellBlock& cells = mesh_.blocks[block];
  const int dim = mesh_.dim, n = cells.element->nodes;
  const std::span<const std::int32_t> nodes = nodes_of(cells, cell);
  const std::int32_t* position = assembly.position[block].data() + index(cell) * index(n * n);
  double* values = out.valuePtr();
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      const std::int32_t first = position[a * n + b];
      const std::int32_t* column = assembly.pattern.outerIndexPtr() + nodes[b] * dim;
      for (int k = 0; k < dim; ++k) {
        double* at = values + first + (column[k] - column[0]);
        for (int i = 0; i < dim; ++i) at[i] += local(a * dim + i, b * dim + k);
      }
    }
  }
}

const Matrix3* FeModel::frame(std::int32_t node) const {
  if (frames_.empty()) return nullptr;
  const auto at = std::lower_bound(frames_.begin(), frames_.end(), node,
                                   [](const NodeFrame& f, std::int32_t n) { return f.node < n; });
  return at != frames_.end() && at->node == node ? &at->axes : nullptr;
}

void FeModel::rotate(std::span<double> values, bool into_frames) const {
  const int dim = mesh_.dim;
  for (const NodeFrame& f : frames_) {
    Eigen::Map<Vector> local(values.data() + index(f.node * dim), dim);
    const Axes axes = f.axes.topLeftCorner(dim, dim);
    const SmallVector given = local;
    if (into_frames) {
      local.noalias() = axes.transpose() * given;
    } else {
      local.noalias() = axes * given;
    }
  }
}

/// A cell's force and matrix in the frames of its nodes.
void FeModel::turn(std::span<const std::int32_t> nodes, Eigen::VectorXd* force,
                   Eigen::MatrixXd* matrix) const {
  if (frames_.empty()) return;
  const int dim = mesh_.dim;
  int a = 0;
  for (std::int32_t node : nodes) {
    const int at = dim * a++;
    const Matrix3* f = frame(node);
    if (f == nullptr) continue;
    const Axes axes = f->topLeftCorner(dim, dim);
    if (force != nullptr) {
      const SmallVector given = force->segment(at, dim);
      force->segment(at, dim).noalias() = axes.transpose() * given;
    }
    if (matrix == nullptr) continue;
    const CellRows rows = matrix->middleRows(at, dim);
    matrix->middleRows(at, dim).noalias() = axes.transpose() * rows;
    const CellColumns columns = matrix->middleCols(at, dim);
    matrix->middleCols(at, dim).noalias() = columns * axes;
  }
}

void FeModel::add_to_tangent(const std::vector<std::int32_t>& nodes, Eigen::MatrixXd& local,
                             SparseMatrix& tangent) const {
  const int dim = mesh_.dim;
  turn(nodes, nullptr, &local);
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      for (int k = 0; k < dim; ++k) {
        for (int i = 0; i < dim; ++i) {
          tangent.coeffRef(nodes[a] * dim + i, nodes[b] * dim + k) +=
              local(static_cast<int>(a) * dim + i, static_cast<int>(b) * dim + k);
        }
      }
    }
  }
}

CellMeasures FeModel::cell_measures(int block, int cell) const {
  CellMeasures measures;
  measure_cell(mesh_, mesh_.blocks[block], cell, blocks_[block].table, options_,
               material_->moduli(), measures);
  return measures;
}

/// One cell's force, and its tangent where that is wanted, left in local_.
bool FeModel::respond(int block, int cell, std::span<const double> q,
                      std::span<const double> history) {
  if (assembly_)
    return respond(block, cell, assembly_->measures[block].of(cell), q, history, Need::tangent);
  const CellMeasures own = cell_measures(block, cell);
  return respond(block, cell, own.of(0), q, history, Need::tangent);
}

bool FeModel::respond(int block, int cell, const CellGeometry& geometry, std::span<const double> q,
                      std::span<const double> history, Need need) {
  const std::size_t each = index(geometry.points * kernel_.history_size());
  const std::size_t first = first_history(block, cell);
  after_.resize(each);
  gather(mesh_.blocks[block], cell, q, u_);
  return kernel_.evaluate(geometry, u_, history.subspan(first, each), after_, need, local_);
}

bool FeModel::cell_tangent(int block, int cell, std::span<const double> q,
                           std::span<const double> history, Eigen::MatrixXd& tangent) {
  if (!respond(block, cell, q, history)) return false;
  tangent = local_.tangent;
  return true;
}

double FeModel::volume() const {
  return lumped_(Eigen::seqN(0, mesh_.node_count(), mesh_.dim)).sum() / material_->density();
}

bool FeModel::visit(std::span<const double> q, std::span<const double> history,
                    const std::function<void(const PointState&)>& see) {
  std::vector<double> after;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const std::size_t per_point = index(kernel_.history_size());
    // Bodies of forces alone need no geometry that is kept: it is measured cell by cell.
    CellMeasures one;
    for (int c = 0; c < cells.count(); ++c) {
      if (!assembly_) {
        one = {};
        measure_cell(mesh_, cells, c, blocks_[k].table, options_, material_->moduli(), one);
      }
      const CellMeasures& measures = assembly_ ? assembly_->measures[k] : one;
      const std::size_t each = index(measures.points) * per_point;
      after.resize(each);
      const std::span<const double> before =
          history.subspan(first_history(static_cast<int>(k), c), each);
      const CellGeometry cell = measures.of(assembly_ ? c : 0);
      gather(cells, c, q, u_);
      if (!kernel_.evaluate(cell, u_, before, after, Need::stress, local_)) return false;
      for (int p = 0; p < cell.points; ++p) {
        const std::span<const double> own =
            std::span<const double>(after).subspan(index(p) * per_point, per_point);
        see({static_cast<int>(k), c, p, cell.volume[p],
             material_->completed(kernel_.deformation(p), own), kernel_.stress(p),
             before.subspan(index(p) * per_point, per_point)});
      }
    }
  }
  return true;
}

}  // namespace abut
