// Impulses of all rows at once, where rows one after the other come to an end too slowly: a heavy
// body on a light one gets there by the ratio of their masses a sweep.

#include <algorithm>
#include <cmath>

#include "base/dense.hpp"
#include "coordinator/passive/row_impulses.hpp"

namespace abut {

namespace {

/// Components: more are left to sweeps, as their matrix is dense.
constexpr std::size_t most_at_once = 60;
/// Of what a row holds along its surfaces at most: from there on it slides.
constexpr double slides_from = 1.0 - 1.0e-9;
/// Of the rows' largest: what changes velocities by less are rows that say the same, which do not
/// press each other. Masses that differ by more are left to sweeps.
constexpr double the_same = 1.0e-6;

}  // namespace

/// [1/kg] by which a unit impulse of one component changes the velocity of another one.
double RowImpulses::response(const Component& of, const Component& to) const {
  double sum = 0.0;
  const Answer& answer = answers_[to.row];
  for (const std::size_t s : {0u, 1u}) {
    if (answer.body[s] < 0) continue;
    const Change& change = answer.change[index(to.direction)][s];
    visit_pressed(rows_[of.row], answer.body[s], [&](int slot, std::size_t i) {
      const Eigen::Vector3d share = rows_[of.row].share_on(i, of.direction);
      if (change.all.size() > 0) sum += along(share, change.all, slot);
      for (const auto& [at, moved] : change.some)
        if (at == slot) sum += share.dot(moved);
    });
  }
  return sum;
}

/// The same of a change of what presses a row that slides, which slides on with it.
double RowImpulses::response_with(const Component& of, const Component& to) const {
  double sum = response(of, to);
  if (to.direction != 0) return sum;
  const std::array<double, 2> along = slid_along(to.row);
  for (int t = 0; t + 1 < dim_; ++t)
    if (along[index(t)] != 0.0) sum += along[index(t)] * response(of, {to.row, t + 1});
  return sum;
}

/// Those that push, and along the surfaces those that stick.
std::vector<RowImpulses::Component> RowImpulses::pressing() const {
  std::vector<Component> out;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const DistanceRow& row = rows_[k];
    if (row.recoils || !(answers_[k].normal > 0.0)) continue;
    if (!(row.normal_impulse > (row.aimed ? -row.pushed : 0.0))) continue;
    out.push_back({k, 0});
    const double most = row.friction * row.normal_impulse;
    if (!(most > 0.0) || !(answers_[k].tangential > 0.0)) continue;
    if (std::hypot(row.tangential_impulse[0], row.tangential_impulse[1]) >= slides_from * most)
      continue;
    for (int t = 0; t + 1 < dim_; ++t) out.push_back({k, t + 1});
  }
  return out;
}

/// What slides goes on with the same part of what presses it. Rows that would pull end the step
/// where the first of them does not press any more: sweeps tell how the others go on.
bool RowImpulses::leap() {
  const std::vector<Component> all = pressing();
  if (all.size() < 2 || all.size() > most_at_once) return false;
  const auto count = static_cast<Eigen::Index>(all.size());
  Eigen::MatrixXd matrix(count, count);
  Eigen::VectorXd missing(count), unit(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Component& of = all[index(i)];
    const Answer& own = answers_[of.row];
    unit(i) = 1.0 / std::sqrt(of.direction == 0 ? own.normal : own.tangential);
    missing(i) = -velocity(rows_[of.row], of.direction);
    if (of.direction == 0) missing(i) += rows_[of.row].held();
    for (Eigen::Index j = 0; j < count; ++j) matrix(i, j) = response_with(of, all[index(j)]);
  }
  matrix = unit.asDiagonal() * matrix * unit.asDiagonal();
  const Eigen::VectorXd change =
      unit.cwiseProduct(pseudo_inverse(matrix, the_same) * unit.cwiseProduct(missing));
  if (!change.allFinite()) return false;
  double part = 1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (all[index(i)].direction != 0) continue;
    const DistanceRow& row = rows_[all[index(i)].row];
    const double room = row.normal_impulse + (row.aimed ? row.pushed : 0.0);
    if (change(i) < -room) part = std::min(part, room / -change(i));
  }
  for (Eigen::Index i = 0; i < count; ++i) add(all[index(i)], part * change(i));
  return true;
}

void RowImpulses::keep() {
  kept_.clear();
  for (const DistanceRow& row : rows_)
    kept_.push_back({row.normal_impulse, row.tangential_impulse[0], row.tangential_impulse[1]});
}

void RowImpulses::return_to_kept() {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    DistanceRow& row = rows_[k];
    press(k, 0, kept_[k][0] - row.normal_impulse);
    row.normal_impulse = kept_[k][0];
    if (!(row.friction > 0.0)) continue;
    for (int t = 0; t + 1 < dim_; ++t) {
      press(k, t + 1, kept_[k][index(t) + 1] - row.tangential_impulse[index(t)]);
      row.tangential_impulse[index(t)] = kept_[k][index(t) + 1];
    }
  }
}

/// By how much a unit of what presses a row moves what it holds along its surfaces, where it
/// slides.
std::array<double, 2> RowImpulses::slid_along(std::size_t k) const {
  const DistanceRow& row = rows_[k];
  const double most = row.friction * row.normal_impulse;
  const double length = std::hypot(row.tangential_impulse[0], row.tangential_impulse[1]);
  if (!(most > 0.0) || length < slides_from * most) return {};
  return {row.friction * row.tangential_impulse[0] / length,
          row.friction * row.tangential_impulse[1] / length};
}

void RowImpulses::add(const Component& to, double change) {
  DistanceRow& row = rows_[to.row];
  if (to.direction > 0) {
    row.tangential_impulse[index(to.direction - 1)] += change;
    return press(to.row, to.direction, change);
  }
  const std::array<double, 2> along = slid_along(to.row);
  row.normal_impulse += change;
  press(to.row, 0, change);
  for (int t = 0; t + 1 < dim_; ++t) {
    if (along[index(t)] == 0.0) continue;
    row.tangential_impulse[index(t)] += along[index(t)] * change;
    press(to.row, t + 1, along[index(t)] * change);
  }
}

}  // namespace abut
