#include "subdomain_solver/time/contact_turns.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

/// Of a change of contact forces that is taken.
constexpr double smallest_factor = 0.02;

}  // namespace

void ContactTurns::begin(Contact* contact, const std::vector<double>& force) {
  contact_ = contact;
  if (contact == nullptr) {
    force_.resize(0);
    return;
  }
  const Eigen::Index n = static_cast<Eigen::Index>(contact->coordinates().size());
  if (touched_ != contact->coordinates()) {
    touched_ = contact->coordinates();
    columns_.resize(std::max(columns_.size(), touched_.size()));
    forget();
  }
  force_.resize(n);
  pose_.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) force_(k) = force[touched_[index(k)]];
}

void ContactTurns::weigh(double load, double move) {
  if (load == load_ && move == move_) return;
  load_ = load;
  move_ = move;
  forget();
}

void ContactTurns::add_to(Vector& external) const {
  for (Eigen::Index k = 0; k < force_.size(); ++k) external(touched_[k]) += force_(k);
}

const Vector* ContactTurns::column(int k) {
  Vector& column = columns_[k];
  if (known_[k]) return &column;
  known_[k] = 1;
  column.setZero(static_cast<Eigen::Index>(touched_.size()));
  const int place = free_.place(touched_[k]);
  if (place < 0) return &column;
  unit_.setZero(free_.count());
  unit_(place) = load_;
  if (!solver_.solve(unit_, answer_)) return nullptr;
  for (std::size_t i = 0; i < touched_.size(); ++i) {
    const int at = free_.place(touched_[i]);
    if (at >= 0) column(static_cast<Eigen::Index>(i)) = move_ * answer_(at);
  }
  return &column;
}

bool ContactTurns::apply(const Vector& force, Vector& moved) {
  unit_.setZero(free_.count());
  for (std::size_t k = 0; k < touched_.size(); ++k)
    if (const int place = free_.place(touched_[k]); place >= 0)
      unit_(place) = load_ * force(static_cast<Eigen::Index>(k));
  if (!solver_.solve(unit_, answer_)) return false;
  moved.setZero(static_cast<Eigen::Index>(touched_.size()));
  for (std::size_t k = 0; k < touched_.size(); ++k)
    if (const int place = free_.place(touched_[k]); place >= 0)
      moved(static_cast<Eigen::Index>(k)) = move_ * answer_(place);
  return true;
}

/// Aitken's factor, from the third turn on: where a material begins to yield, factors of either
/// side would lead to and fro.
void ContactTurns::relax(int turn) {
  if (turn == 0) factor_ = 1.0;
  if (turn < 2) return;
  const double between = (change_ - last_change_).squaredNorm();
  if (between == 0.0) return;
  factor_ *= std::abs(last_change_.dot(last_change_ - change_)) / between;
  factor_ = std::clamp(factor_, smallest_factor, 1.0);
}

bool ContactTurns::press(double time, const Vector& q, int turn, Vector& x, double& change) {
  for (Eigen::Index k = 0; k < force_.size(); ++k) pose_(k) = q(touched_[k]);
  if (!add_given_way(*this, -1.0, force_, moved_by_, pose_)) return false;
  const Vector* force = contact_->solve(time, pose_, *this);
  if (force == nullptr) return false;
  last_change_.swap(change_);
  change_ = *force - force_;
  change = change_.norm();
  relax(turn);
  force_ += factor_ * change_;
  unit_.setZero(free_.count());
  for (std::size_t k = 0; k < touched_.size(); ++k) {
    const int place = free_.place(touched_[k]);
    if (place >= 0) unit_(place) = load_ * factor_ * change_(static_cast<Eigen::Index>(k));
  }
  rounded_ = true;
  if (unit_.isZero(0.0)) return true;
  if (!solver_.solve(unit_, answer_)) return false;
  x += answer_;
  rounded_ = answer_.lpNorm<Eigen::Infinity>() <= factor_ * contact_->rounding();
  return true;
}

}  // namespace abut
