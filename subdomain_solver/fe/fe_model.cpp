#include "subdomain_solver/fe/fe_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include "base/assert.hpp"

namespace abut {

namespace {

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Nodes of one cell.
std::span<const std::int32_t> nodes_of(const CellBlock& cells, int cell) {
  const std::size_t n = index(cells.element->nodes);
  return std::span(cells.nodes).subspan(index(cell) * n, n);
}

std::unique_ptr<const Material> in_its_space(std::unique_ptr<const Material> law, int dim,
                                             Plane plane) {
  if (dim == 3 || plane != Plane::stress) return law;
  return std::make_unique<PlaneStress>(std::move(law));
}

}  // namespace

FeModel::FeModel(Mesh mesh, std::unique_ptr<const Material> material, const FeOptions& options,
                 const std::vector<NodeFrame>& frames)
    : mesh_(std::move(mesh)),
      material_(in_its_space(std::move(material), mesh_.dim, options.plane)),
      options_(options),
      frames_(frames),
      kernel_(*material_, options.formulation) {
  ABUT_ASSERT(mesh_.dim == 2 || mesh_.dim == 3);
  std::sort(frames_.begin(), frames_.end(),
            [](const NodeFrame& a, const NodeFrame& b) { return a.node < b.node; });
  blocks_.resize(mesh_.blocks.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const CellBlock& cells = mesh_.blocks[b];
    blocks_[b].table =
        tabulate(*cells.element, quadrature(cells.element->shape,
                                            stiffness_degree(*cells.element) + (round() ? 1 : 0)));
    measure(cells, blocks_[b]);
    blocks_[b].history = history_size_;
    history_size_ += blocks_[b].volume.size() * index(kernel_.history_size());
    find_units(blocks_[b]);
  }
  find_pattern();
  assemble_mass();
  if (!is_linear()) return;
  ModelResponse response;
  const std::vector<double> rest(index(dofs()), 0.0);
  const bool admissible = assemble(rest, {}, Want::tangent, response);
  ABUT_ASSERT(admissible);
  stiffness_ = std::move(response.tangent);
}

/// Volumes and dN/dX at the points of the block's table.
void FeModel::measure(const CellBlock& cells, Block& block) const {
  const Tabulation& t = block.table;
  const int dim = mesh_.dim;
  const bool round = this->round();
  block.volume.clear();
  block.gradient.clear();
  block.hoop.clear();
  Eigen::MatrixXd x(t.nodes, dim);
  for (int cell = 0; cell < cells.count(); ++cell) {
    const std::span<const std::int32_t> nodes = nodes_of(cells, cell);
    for (int a = 0; a < t.nodes; ++a) {
      for (int i = 0; i < dim; ++i) x(a, i) = mesh_.points[index(nodes[index(a)] * dim + i)];
    }
    for (int p = 0; p < t.points; ++p) {
      using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const Eigen::Map<const Rows> dn(t.dn.data() + index(p * t.nodes * dim), t.nodes, dim);
      const Eigen::Map<const Vector> n(t.n.data() + index(p * t.nodes), t.nodes);
      const Eigen::MatrixXd jacobian = x.transpose() * dn;  // dX/dxi
      const double radius = round ? n.dot(x.col(0)) : 0.0;
      const double depth = round      ? 2.0 * std::numbers::pi * radius
                           : dim == 2 ? options_.thickness
                                      : 1.0;
      block.volume.push_back(t.weight[index(p)] * jacobian.determinant() * depth);
      const Rows gradient = dn * jacobian.inverse();
      block.gradient.insert(block.gradient.end(), gradient.data(),
                            gradient.data() + gradient.size());
      if (!round) continue;
      for (int a = 0; a < t.nodes; ++a) block.hoop.push_back(n(a) / radius);
    }
  }
}

/// Largest gradient of a shape function, and the force of a unit strain on a cell.
void FeModel::find_units(const Block& block) {
  const int points = block.table.points;
  for (std::size_t p = 0; p < block.volume.size(); p += index(points)) {
    double volume = 0.0, steepest = 0.0;
    for (std::size_t k = 0; k < index(points); ++k) volume += block.volume[p + k];
    const std::size_t each = index(block.table.nodes * mesh_.dim);
    for (std::size_t k = p * each; k < (p + index(points)) * each; ++k)
      steepest = std::max(steepest, std::abs(block.gradient[k]));
    gradient_unit_ = std::max(gradient_unit_, steepest);
    force_unit_ = std::max(force_unit_, material_->moduli().p_wave() * volume * steepest);
  }
}

/// Entries of the tangent: all pairs of nodes that share a cell. Columns of one node have the same
/// rows, so the place of a pair's first entry is enough to find the others.
void FeModel::find_pattern() {
  const int dim = mesh_.dim;
  std::vector<std::vector<std::int32_t>> neighbours(index(mesh_.node_count()));
  for (const CellBlock& cells : mesh_.blocks) {
    for (int c = 0; c < cells.count(); ++c) {
      for (std::int32_t a : nodes_of(cells, c)) {
        for (std::int32_t b : nodes_of(cells, c)) neighbours[index(b)].push_back(a);
      }
    }
  }
  Eigen::VectorXi sizes(dofs());
  for (std::size_t b = 0; b < neighbours.size(); ++b) {
    std::sort(neighbours[b].begin(), neighbours[b].end());
    neighbours[b].erase(std::unique(neighbours[b].begin(), neighbours[b].end()),
                        neighbours[b].end());
    for (int k = 0; k < dim; ++k)
      sizes(static_cast<int>(b) * dim + k) = static_cast<int>(neighbours[b].size()) * dim;
  }
  pattern_.resize(dofs(), dofs());
  pattern_.reserve(sizes);
  for (std::size_t b = 0; b < neighbours.size(); ++b) {
    for (int k = 0; k < dim; ++k) {
      for (std::int32_t a : neighbours[b]) {
        for (int i = 0; i < dim; ++i)
          pattern_.insert(a * dim + i, static_cast<int>(b) * dim + k) = 0.0;
      }
    }
  }
  pattern_.makeCompressed();
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    for (int c = 0; c < cells.count(); ++c) {
      for (std::int32_t a : nodes_of(cells, c)) {
        for (std::int32_t b : nodes_of(cells, c)) {
          const std::vector<std::int32_t>& rows = neighbours[index(b)];
          const auto at = std::lower_bound(rows.begin(), rows.end(), a) - rows.begin();
          blocks_[k].position.push_back(pattern_.outerIndexPtr()[b * dim] +
                                        static_cast<std::int32_t>(at) * dim);
        }
      }
    }
  }
}

/// Consistent mass; lumped by scaling its diagonal to the cell's mass (Hinton, Rock, Zienkiewicz
/// 1976), which equals the row sum for linear elements on parallelepipeds and is positive for all.
void FeModel::assemble_mass() {
  const int dim = mesh_.dim;
  const double density = material_->density();
  mass_ = pattern_;
  lumped_.setZero(dofs());
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    Block fine;
    fine.table =
        tabulate(*cells.element, quadrature(cells.element->shape, mass_degree(*cells.element)));
    measure(cells, fine);
    const Tabulation& t = fine.table;
    for (int c = 0; c < cells.count(); ++c) {
      Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(t.nodes, t.nodes);
      for (int p = 0; p < t.points; ++p) {
        const Eigen::Map<const Vector> n(t.n.data() + index(p * t.nodes), t.nodes);
        nodal += density * fine.volume[index(c * t.points + p)] * n * n.transpose();
      }
      const double scale = nodal.sum() / nodal.trace();
      const std::span<const std::int32_t> nodes = nodes_of(cells, c);
      Eigen::MatrixXd local = Eigen::MatrixXd::Zero(t.nodes * dim, t.nodes * dim);
      for (int a = 0; a < t.nodes; ++a) {
        for (int i = 0; i < dim; ++i) {
          lumped_(nodes[index(a)] * dim + i) += scale * nodal(a, a);
          for (int b = 0; b < t.nodes; ++b) local(a * dim + i, b * dim + i) = nodal(a, b);
        }
      }
      turn(nodes, nullptr, &local);
      add_matrix(cells, blocks_[k], c, local, mass_);
    }
  }
  mass_.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
}

CellGeometry FeModel::geometry(const Block& block, int cell) const {
  const Tabulation& t = block.table;
  const std::size_t points = index(t.points), nodes = index(t.nodes), dim = index(t.dim);
  const std::size_t first = index(cell) * points;
  CellGeometry g{t.nodes, t.points, t.dim, {}, {}, {}};
  g.volume = std::span(block.volume).subspan(first, points);
  g.gradient = std::span(block.gradient).subspan(first * nodes * dim, points * nodes * dim);
  if (!block.hoop.empty()) g.hoop = std::span(block.hoop).subspan(first * nodes, points * nodes);
  return g;
}

bool FeModel::evaluate(std::span<const double> q, std::span<const double> history, Want want,
                       ModelResponse& out) {
  if (!is_linear()) return assemble(q, history, want, out);
  const Eigen::Map<const Vector> u(q.data(), dofs());
  out.force.noalias() = stiffness_ * u;
  if (want == Want::tangent) out.tangent = stiffness_;
  out.stored = 0.5 * u.dot(out.force);
  out.dissipation = 0.0;
  out.history.clear();
  return true;
}

double FeModel::roundoff(std::span<const double> q) const {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const Eigen::Map<const Vector> u(q.data(), dofs());
  const double strain = is_linear() ? u.lpNorm<Eigen::Infinity>() * gradient_unit_ : 1.0;
  return epsilon * force_unit_ * strain * std::sqrt(static_cast<double>(dofs()));
}

bool FeModel::assemble(std::span<const double> q, std::span<const double> history, Want want,
                       ModelResponse& out) {
  out.force.setZero(dofs());
  if (want == Want::tangent) out.tangent = pattern_;
  out.history.resize(history_size_);
  out.stored = out.dissipation = 0.0;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const std::size_t each = index(blocks_[k].table.points * kernel_.history_size());
    for (int c = 0; c < cells.count(); ++c) {
      const std::size_t at = blocks_[k].history + index(c) * each;
      gather(cells, c, q, u_);
      const bool admissible = kernel_.evaluate(
          geometry(blocks_[k], c), u_, history.subspan(at, each),
          std::span(out.history).subspan(at, each),
          want == Want::tangent ? abut::Want::tangent : abut::Want::stress, local_);
      if (!admissible) return false;
      scatter(cells, blocks_[k], c, want, local_, out);
    }
  }
  return true;
}

void FeModel::gather(const CellBlock& cells, int cell, std::span<const double> q,
                     std::vector<double>& u) const {
  const int dim = mesh_.dim;
  u.clear();
  for (std::int32_t node : nodes_of(cells, cell)) {
    for (int i = 0; i < dim; ++i) u.push_back(q[index(node * dim + i)]);
    if (const Matrix3* axes = frame(node)) {
      Eigen::Map<Vector> local(u.data() + u.size() - index(dim), dim);
      local = (axes->topLeftCorner(dim, dim) * local).eval();
    }
  }
}

void FeModel::scatter(const CellBlock& cells, const Block& block, int cell, Want want,
                      CellResponse& local, ModelResponse& out) const {
  const int dim = mesh_.dim;
  turn(nodes_of(cells, cell), &local.force, want == Want::tangent ? &local.tangent : nullptr);
  int a = 0;
  for (std::int32_t node : nodes_of(cells, cell)) {
    out.force.segment(node * dim, dim) += local.force.segment(dim * a, dim);
    ++a;
  }
  if (want == Want::tangent) add_matrix(cells, block, cell, local.tangent, out.tangent);
  out.stored += local.stored;
  out.dissipation += local.dissipation;
}

void FeModel::add_matrix(const CellBlock& cells, const Block& block, int cell,
                         const Eigen::MatrixXd& local, SparseMatrix& out) const {
  const int dim = mesh_.dim, n = cells.element->nodes;
  const std::span<const std::int32_t> nodes = nodes_of(cells, cell);
  const std::int32_t* position = block.position.data() + index(cell) * index(n * n);
  double* values = out.valuePtr();
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      const std::int32_t first = position[a * n + b];
      const std::int32_t* column = pattern_.outerIndexPtr() + nodes[index(b)] * dim;
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
    const Eigen::MatrixXd axes = f.axes.topLeftCorner(dim, dim);
    local = (into_frames ? (axes.transpose() * local).eval() : (axes * local).eval());
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
    const Eigen::MatrixXd axes = f->topLeftCorner(dim, dim);
    if (force != nullptr)
      force->segment(at, dim) = (axes.transpose() * force->segment(at, dim)).eval();
    if (matrix == nullptr) continue;
    matrix->middleRows(at, dim) = (axes.transpose() * matrix->middleRows(at, dim)).eval();
    matrix->middleCols(at, dim) = (matrix->middleCols(at, dim) * axes).eval();
  }
}

void FeModel::add_to_tangent(const std::vector<std::int32_t>& nodes, Eigen::MatrixXd local,
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

double FeModel::volume() const {
  double sum = 0.0;
  for (const Block& block : blocks_) {
    for (double v : block.volume) sum += v;
  }
  return sum;
}

bool FeModel::visit(std::span<const double> q, std::span<const double> history,
                    const std::function<void(const PointState&)>& see) {
  std::vector<double> after;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const std::size_t per_point = index(kernel_.history_size());
    const std::size_t each = index(blocks_[k].table.points) * per_point;
    after.resize(each);
    for (int c = 0; c < cells.count(); ++c) {
      const std::span<const double> before =
          history.subspan(blocks_[k].history + index(c) * each, each);
      const CellGeometry cell = geometry(blocks_[k], c);
      gather(cells, c, q, u_);
      if (!kernel_.evaluate(cell, u_, before, after, abut::Want::stress, local_)) return false;
      for (int p = 0; p < cell.points; ++p) {
        see({static_cast<int>(k), c, p, cell.volume[index(p)], kernel_.deformation(p),
             kernel_.stress(p), before.subspan(index(p) * per_point, per_point)});
      }
    }
  }
  return true;
}

}  // namespace abut
