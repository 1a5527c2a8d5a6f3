#include "coordinator/passive/row_impulses.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

namespace {

/// Sweeps over all rows. More do not change overlaps or losses: the next step's gaps do.
constexpr int most_sweeps = 100;
/// Of the velocity that the largest impulse makes: less is no change. Stiff bodies at rest give way
/// by less than a thousandth of the thickness, and their weight makes no more speed in a step.
constexpr double of_pressed = 1.0e-4;
/// Rows that are aimed at a velocity have it to this share of that with which their sides came,
/// however short the step; corners that share one plane take many sweeps.
constexpr double of_approach = 1.0e-6;
constexpr int most_aimed_sweeps = 1000;
/// After so many of them all rows are solved for at once, from how they press then.
constexpr int sweeps_to_leap = 25;
/// After the last of these, where rows are aimed or bodies rest: friction is for sweeps to settle.
/// Others, as heavy bodies on light ones, are not to lose what they have found.
constexpr int sweeps_to_settle = 5;

}  // namespace

double row_velocity(const DistanceRow& row, std::span<const Eigen::Vector3d> velocities,
                    int direction) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    if (row.counts(i))
      sum += row.share_on(i, direction).dot(velocities[index(row.features.points[i])]);
  return sum;
}

RowImpulses::RowImpulses(std::vector<DistanceRow>& rows, PressedPoints& points,
                         const TouchingSurfaces& surfaces,
                         std::span<const Eigen::Vector3d> velocities)
    : rows_(rows),
      points_(points),
      surfaces_(surfaces),
      velocities_(velocities),
      dim_(surfaces.skin().dim) {
  for (const DistanceRow& row : rows_) answers_.push_back(answer_of(row));
}

/// Product of a direction with the values of a point from `slot` on.
double RowImpulses::along(const Eigen::Vector3d& direction, const Eigen::VectorXd& values,
                          int slot) const {
  double sum = 0.0;
  for (int k = 0; k < dim_; ++k) sum += direction(k) * values(slot + k);
  return sum;
}

RowImpulses::Answer RowImpulses::answer_of(const DistanceRow& row) const {
  Answer answer;
  for (const std::size_t s : {0u, 1u}) {
    const int body = points_.owner(row.first_point(static_cast<int>(s)));
    if (points_.any(body) && answer.body[0] != body) answer.body[s] = body;
  }
  const int directions = row.friction > 0.0 ? dim_ : 1;
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  for (const std::size_t s : {0u, 1u}) {
    if (answer.body[s] < 0) continue;
    if (points_.bound(answer.body[s]).size() > 0)
      find_bounds(row, directions, s, answer, own);
    else
      find_changes(row, directions, s, answer, own);
  }
  answer.normal = own(0, 0);
  const double trace = own(1, 1) + own(2, 2);
  const double apart = std::hypot(own(1, 1) - own(2, 2), own(1, 2) + own(2, 1));
  answer.tangential = dim_ == 2 ? own(1, 1) : 0.5 * (trace + apart);
  return answer;
}

/// By the whole compliance of a side's body.
void RowImpulses::find_changes(const DistanceRow& row, int directions, std::size_t side,
                               Answer& answer, Eigen::Matrix3d& own) const {
  const int body = answer.body[side];
  const Eigen::MatrixXd& compliance = points_.compliance(body);
  for (int d = 0; d < directions; ++d) answer.change[index(d)][side].all.setZero(compliance.rows());
  visit_pressed(row, body, [&](int slot, std::size_t i) {
    for (int d = 0; d < directions; ++d)
      answer.change[index(d)][side].all.noalias() +=
          compliance.middleCols(slot, dim_) * row.share_on(i, d).head(dim_);
  });
  visit_pressed(row, body, [&](int slot, std::size_t i) {
    for (int d = 0; d < directions; ++d)
      for (int e = 0; e < directions; ++e)
        own(e, d) += along(row.share_on(i, e), answer.change[index(d)][side].all, slot);
  });
}

/// By a diagonal that bounds it.
void RowImpulses::find_bounds(const DistanceRow& row, int directions, std::size_t side,
                              Answer& answer, Eigen::Matrix3d& own) const {
  const int body = answer.body[side];
  const Eigen::VectorXd& bound = points_.bound(body);
  visit_pressed(row, body, [&](int slot, std::size_t i) {
    for (int d = 0; d < directions; ++d) {
      Eigen::Vector3d moved = Eigen::Vector3d::Zero();
      moved.head(dim_) = bound.segment(slot, dim_).cwiseProduct(row.share_on(i, d).head(dim_));
      answer.change[index(d)][side].some.emplace_back(slot, moved);
      for (int e = 0; e < directions; ++e) own(e, d) += row.share_on(i, e).dot(moved);
    }
  });
}

double RowImpulses::velocity(const DistanceRow& row, int direction) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!row.counts(i)) continue;
    const std::int32_t point = row.features.points[i];
    const int slot = points_.slot(point);
    const Eigen::VectorXd* pressed = slot < 0 ? nullptr : &points_.velocity(points_.owner(point));
    const Eigen::Vector3d share = row.share_on(i, direction);
    for (int k = 0; k < dim_; ++k)
      sum += share(k) * (pressed != nullptr ? (*pressed)(slot + k) : velocities_[index(point)](k));
  }
  return sum;
}

void RowImpulses::press(std::size_t row, int direction, double impulse) {
  const Answer& answer = answers_[row];
  for (const std::size_t s : {0u, 1u}) {
    if (answer.body[s] < 0) continue;
    const Change& change = answer.change[index(direction)][s];
    Eigen::VectorXd& velocity = points_.velocity(answer.body[s]);
    if (change.all.size() > 0) velocity += impulse * change.all;
    for (const auto& [slot, moved] : change.some)
      velocity.segment(slot, dim_) += impulse * moved.head(dim_);
  }
}

void RowImpulses::press_from(std::size_t row, double share) {
  for (std::size_t k = row; k < rows_.size(); ++k) {
    press(k, 0, share * rows_[k].normal_impulse);
    for (int t = 0; t + 1 < dim_ && rows_[k].friction > 0.0; ++t)
      press(k, 1 + t, share * rows_[k].tangential_impulse[index(t)]);
  }
}

/// By the midpoint rule what an impulse works on is the velocity that closes the gap, so the
/// impulse that closes it, to c >= -push, is the smaller one wherever push is paid for.
double RowImpulses::solve_normal(std::size_t k) {
  DistanceRow& row = rows_[k];
  const double own = answers_[k].normal;
  if (!(own > 0.0)) return 0.0;
  const double some = regularised * own;
  const double w = velocity(row, 0) - row.held() + some * row.normal_impulse;
  double now = std::max(row.aimed ? -row.pushed : 0.0, row.normal_impulse - w / (own + some));
  if (row.recoils) now = std::max(now, recoil(k));
  const double change = now - row.normal_impulse;
  if (change != 0.0) press(k, 0, change);
  row.normal_impulse = now;
  return std::abs(change) * own;
}

/// J with J (w + a J) = what is owed, w the velocity without it and a its own compliance [M.145].
double RowImpulses::recoil(std::size_t k) const {
  const DistanceRow& row = rows_[k];
  const double own = answers_[k].normal;
  const double w = velocity(row) - own * row.normal_impulse;
  const double root = std::sqrt(w * w + 4.0 * own * row.owed);
  return w > 0.0 ? 2.0 * row.owed / (w + root) : (root - w) / (2.0 * own);
}

double RowImpulses::release(const Negligible& negligible) {
  double released = 0.0;
  for (double sum = let_go(); sum > released; sum = let_go()) {
    released = sum;
    solve(negligible);
  }
  return released;
}

/// Those that press no more and part, as velocities are.
double RowImpulses::let_go() {
  double sum = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    DistanceRow& row = rows_[k];
    if (row.owed > 0.0 && row.normal_impulse == 0.0 && answers_[k].normal > 0.0 &&
        velocity(row) > 0.0)
      row.recoils = true;
    if (row.recoils) sum += row.owed;
  }
  return sum;
}

/// Towards sticking, held on Coulomb's disc: by the larger compliance of the tangents, so that it
/// stays between nothing and what does no work.
std::array<double, 2> RowImpulses::held(std::size_t k) const {
  const DistanceRow& row = rows_[k];
  std::array<double, 2> now = row.tangential_impulse;
  for (int t = 0; t + 1 < dim_; ++t) now[index(t)] -= velocity(row, t + 1) / answers_[k].tangential;
  const double length = std::hypot(now[0], now[1]), most = row.friction * row.normal_impulse;
  if (length > most)
    for (double& value : now) value *= most / length;
  return now;
}

/// Of rigid sides that are pulled after they were pushed: what friction took with that beyond what
/// it may with both, and no more work than it took.
std::array<double, 2> RowImpulses::given_back(const DistanceRow& row) const {
  const double length = std::hypot(row.rubbed[0], row.rubbed[1]);
  const double most = row.friction * std::max(0.0, row.pushed + row.normal_impulse);
  if (length <= most) return {0.0, 0.0};
  double part = most / length - 1.0, work = 0.0;
  for (int t = 0; t + 1 < dim_; ++t) work += part * row.rubbed[index(t)] * velocity(row, t + 1);
  if (work > row.heat) part *= row.heat / work;
  return {part * row.rubbed[0], part * row.rubbed[1]};
}

double RowImpulses::solve_friction(std::size_t k) {
  DistanceRow& row = rows_[k];
  const double own = answers_[k].tangential;
  if (!(row.friction > 0.0) || !(own > 0.0)) return 0.0;
  const std::array<double, 2> now = row.normal_impulse < 0.0 ? given_back(row) : held(k);
  double largest = 0.0;
  for (int t = 0; t + 1 < dim_; ++t) {
    const double change = now[index(t)] - row.tangential_impulse[index(t)];
    if (change != 0.0) press(k, 1 + t, change);
    largest = std::max(largest, std::abs(change) * own);
  }
  row.tangential_impulse = now;
  return largest;
}

void RowImpulses::solve(const Negligible& negligible) {
  int sweeps = most_sweeps;
  double least = negligible.velocity;
  for (const DistanceRow& row : rows_) {
    if (!row.aimed) continue;
    least = std::min(least, of_approach * row.approach);
    sweeps = most_aimed_sweeps;
  }
  double before = 0.0;
  bool leaped = false;
  const bool settles = negligible.settles || sweeps > most_sweeps;
  const int last = sweeps + (settles ? sweeps_to_settle : 0);
  for (int sweep = 1; sweep <= last; ++sweep) {
    double pressed = 0.0, impulses = 0.0;
    const double change = this->sweep(pressed, impulses);
    const bool works = change * impulses > negligible.work && change > of_pressed * pressed;
    if (change < least && !works) return;
    if (leaped && change > before) return_to_kept();
    leaped = sweep % sweeps_to_leap == 0 && sweep <= sweeps;
    if (!leaped) continue;
    before = change;
    keep();
    leaped = leap();
  }
}

/// Largest change of a velocity [m/s] by it, of any row; of impulses, the most that one makes of a
/// velocity, and their sum.
double RowImpulses::sweep(double& pressed, double& impulses) {
  double change = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    change = std::max({change, solve_normal(k), solve_friction(k)});
    const double impulse = std::abs(rows_[k].normal_impulse);
    pressed = std::max(pressed, answers_[k].normal * impulse);
    impulses += impulse;
  }
  return change;
}

double RowImpulses::parted() const {
  double sum = 0.0;
  for (const DistanceRow& row : rows_) {
    if (!row.aimed) continue;
    sum += std::max(0.0, row.normal_impulse * velocity(row, 0));
  }
  return sum;
}

double RowImpulses::returned() const {
  double sum = 0.0;
  for (const DistanceRow& row : rows_)
    for (int t = 0; t + 1 < dim_ && row.normal_impulse < 0.0; ++t)
      sum += std::max(0.0, row.tangential_impulse[index(t)] * velocity(row, t + 1));
  return sum;
}

double RowImpulses::work() const {
  double sum = 0.0;
  for (const DistanceRow& row : rows_) {
    sum += row.normal_impulse * velocity(row, 0);
    for (int t = 0; t + 1 < dim_; ++t)
      if (row.tangential_impulse[index(t)] != 0.0)
        sum += row.tangential_impulse[index(t)] * velocity(row, t + 1);
  }
  return sum;
}

double RowImpulses::limit(double most) {
  const double with = work();
  if (with <= most) return 1.0;
  press_from(0, -1.0);
  const double free = work();  // of the same impulses, at the velocities without them
  const double curved = with - free;
  const double root = std::sqrt(std::max(0.0, free * free + 4.0 * curved * most));
  const double factor = curved > 0.0 ? std::clamp((root - free) / (2.0 * curved), 0.0, 1.0) : 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    rows_[k].normal_impulse *= factor;
    for (double& value : rows_[k].tangential_impulse) value *= factor;
  }
  press_from(0);
  return factor;
}

}  // namespace abut
