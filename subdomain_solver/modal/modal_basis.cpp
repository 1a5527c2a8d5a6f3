#include "subdomain_solver/modal/modal_basis.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/dense.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/orthonormal.hpp"

namespace abut {

namespace {

using Columns = Eigen::MatrixXd;

/// Square of a frequency in parts of the mesh's highest one, below which it is round-off.
constexpr double stiffless = 1.0e-14;

/// (rows, list): column k is 1 at list[k].
SparseMatrix selection(int rows, const std::vector<int>& list) {
  SparseMatrix out(rows, static_cast<Eigen::Index>(list.size()));
  for (std::size_t k = 0; k < list.size(); ++k)
    out.insert(list[k], static_cast<Eigen::Index>(k)) = 1.0;
  out.makeCompressed();
  return out;
}

SparseMatrix part(const SparseMatrix& rows, const SparseMatrix& all, const SparseMatrix& columns) {
  const SparseMatrix half = all * columns;
  return rows.transpose() * half;
}

/// Those of 0 ... count - 1 that a sorted list does not hold.
std::vector<int> others(int count, const std::vector<int>& list) {
  std::vector<int> out;
  for (int i = 0; i < count; ++i) {
    if (!std::binary_search(list.begin(), list.end(), i)) out.push_back(i);
  }
  return out;
}

[[noreturn]] void refuse_singular(const std::string& where) {
  throw InputError(
      "cannot be reduced: its stiffness is singular beyond rigid motions", where,
      "Use formulation full, or give one_point its hourglass stiffness; join the parts "
      "of the mesh.");
}

/// The body with its ports fixed: static answers and modes.
class FixedPorts {
 public:
  /// `free`: rigid motions that neither supports nor ports prevent, orthonormal.
  FixedPorts(SparseMatrix stiffness, SparseMatrix mass, Columns free, const std::string& where)
      : stiffness_(std::move(stiffness)),
        mass_(std::move(mass)),
        free_(std::move(free)),
        where_(where),
        solver_(make_direct_solver()) {
    const int n = static_cast<int>(mass_.rows());
    held_ = selection(n, others(n, determining_rows(free_, free_.cols())));
    if (held_.cols() > 0 && !solver_->factor(part(held_, stiffness_, held_)))
      refuse_singular(where);
  }

  /// F b [M.56]: b without the part that moves the body as a whole, on the body held at just as
  /// many coordinates, then moved to where the body's mass is at rest.
  Columns flexibility(Columns b) const {
    b -= mass_ * (free_ * (free_.transpose() * b).eval());
    const Columns held = held_.transpose() * b;
    Columns x;
    if (!solver_->solve_columns(held, x)) refuse_singular(where_);
    Columns out = held_ * x;
    remove_components(free_, mass_, out);
    return out;
  }

  Modes modes(const WantedModes& wanted) const {
    return lowest_modes({stiffness_, mass_, static_cast<int>(free_.cols()),
                         [this](const Columns& b) { return flexibility(b); }},
                        wanted);
  }

 private:
  SparseMatrix stiffness_, mass_;
  Columns free_;
  SparseMatrix held_;  // selects what is not held
  const std::string& where_;
  std::unique_ptr<LinearSolver> solver_;
};

/// Columns scaled to a norm of one.
void scale(Columns& x, const SparseMatrix& mass) {
  const Columns momentum = mass * x;
  const Vector squares = x.cwiseProduct(momentum).colwise().sum();
  x *= squares.cwiseSqrt().cwiseInverse().asDiagonal();
}

/// The largest component of each column is positive.
void fix_signs(Columns& x) {
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    Eigen::Index at = 0;
    x.col(k).cwiseAbs().maxCoeff(&at);
    if (x(at, k) < 0.0) x.col(k) *= -1.0;
  }
}

/// The pencil on the span of rigid motions R and elastic shapes, made diagonal [M.57].
void diagonalise(const SparseMatrix& stiffness, const SparseMatrix& mass, const Columns& rigid,
                 Columns elastic, const std::string& where, ModalBasis& out) {
  out.shapes = rigid;
  out.frequencies.setZero(rigid.cols() + elastic.cols());
  if (elastic.cols() > 0) {
    scale(elastic, mass);
    remove_components(rigid, mass, elastic);
    scale(elastic, mass);
    elastic = orthonormal(std::move(elastic), mass, 0.0);
    const Columns force = stiffness * elastic;
    Columns reduced(elastic.cols(), elastic.cols());
    reduced.triangularView<Eigen::Lower>() = elastic.transpose() * force;  // the half looked at
    const EigenPairs eigen = symmetric_eigen(reduced);
    // Where a frequency is round-off of the highest one, the motion has no stiffness.
    const double highest = stiffness.diagonal().cwiseQuotient(mass.diagonal()).maxCoeff();
    if (!(eigen.values(0) > stiffless * highest)) refuse_singular(where);
    out.shapes.conservativeResize(Eigen::NoChange, rigid.cols() + elastic.cols());
    out.shapes.rightCols(elastic.cols()) = elastic * eigen.vectors;
    out.frequencies.tail(elastic.cols()) = eigen.values.cwiseSqrt();
  }
  fix_signs(out.shapes);
}

/// Before all are computed as well: what the mesh has is known from its coordinates.
void refuse_more_modes(const WantedModes& wanted, int all, const std::string& where) {
  if (wanted.count == std::numeric_limits<int>::max() || wanted.count <= all) return;
  throw InputError(fmt::format("{} modes are wanted, but the mesh has {}", wanted.count, all),
                   where, fmt::format("Give at most {}, or a finer mesh.", all));
}

}  // namespace

ModalBasis reduce(FeModel& model, const std::vector<int>& supports, const std::vector<int>& ports,
                  MassForm form, const WantedModes& wanted, const std::string& where) {
  ABUT_ASSERT(model.is_linear());
  const int n = model.dofs();
  ModelResponse rest;
  const std::vector<double> zero(index(n), 0.0);
  const std::vector<double> history(model.history_size(), 0.0);
  const bool admissible = model.evaluate(zero, history, Model::Want::tangent, rest);
  ABUT_ASSERT(admissible);
  const SparseMatrix mass = mass_matrix(model, form);
  std::vector<int> boundary;  // port coordinates that no support holds
  std::set_difference(ports.begin(), ports.end(), supports.begin(), supports.end(),
                      std::back_inserter(boundary));
  std::vector<int> outside = supports;
  outside.insert(outside.end(), boundary.begin(), boundary.end());
  std::sort(outside.begin(), outside.end());
  const SparseMatrix inside = selection(n, others(n, outside)), port = selection(n, boundary);

  const Columns rigid = orthonormal(vanishing_on(supports, rigid_motions(model)), mass, 0.0);
  const SparseMatrix inner_mass = part(inside, mass, inside);
  const Columns loose = inside.transpose() * vanishing_on(boundary, rigid);
  const Columns free = orthonormal(loose, inner_mass, 0.0);
  refuse_more_modes(wanted, static_cast<int>(inner_mass.rows() - free.cols()), where);
  const FixedPorts fixed(part(inside, rest.tangent, inside), inner_mass, free, where);
  const Modes modes = fixed.modes(wanted);
  const int found = static_cast<int>(modes.eigenvalues.size());
  refuse_more_modes(wanted, found, where);
  // As many port shapes as rigid motions move the ports follow from these and the others.
  const Columns port_rigid = port.transpose() * rigid;
  const std::vector<int> implied = determining_rows(port_rigid, rigid.cols() - loose.cols());
  const SparseMatrix unit = port * selection(static_cast<int>(boundary.size()),
                                             others(static_cast<int>(boundary.size()), implied));
  Columns elastic(n, unit.cols() + found);
  const SparseMatrix pull = inside.transpose() * (rest.tangent * unit).eval();
  elastic << Columns(unit) - inside * fixed.flexibility(pull), inside * modes.shapes;
  ModalBasis out;
  diagonalise(rest.tangent, mass, rigid, std::move(elastic), where, out);
  out.rigid = static_cast<int>(rigid.cols());
  out.port_coordinates = static_cast<int>(boundary.size());
  out.fixed_modes = found;
  return out;
}

}  // namespace abut
