#include "coordinator/coupling/net.hpp"

#include <algorithm>
#include <bit>

#include "base/archive.hpp"
#include "base/one_each.hpp"
#include "coordinator/coupling/compliant_obstacle.hpp"

namespace abut {

void Net::begin(const TimeWindow& window, const Island& island, std::span<const Joint> joints,
                Bodies& bodies) {
  island_ = &island;
  joints_ = joints;
  window_ = window;
  known_.ties.clear();
  known_.obstacles.clear();
  obstacles_.assign(count(), nullptr);
  for (std::size_t i = 0; i < count(); ++i) exchange(i).enter(joint(i), i, known_);
  for (const auto& [own, obstacle, part] : known_.obstacles) {
    obstacle->share(std::ranges::binary_search(island.shared, own->neumann_side().body));
    obstacles_[part] = obstacle;
  }
  first_.assign(1, 0);
  for (std::size_t i = 0; i < count(); ++i) {
    exchange(i).begin(window, joint(i), bodies);
    first_.push_back(first_.back() + exchange(i).values());
  }
  begin_ties(known_, first_, bodies);
}

/// In single precision, because ends of equal windows are rounded differently.
std::uint64_t Net::layout_key() const {
  std::uint64_t key = std::bit_cast<std::uint32_t>(static_cast<float>(window_.length()));
  for (Eigen::Index i : first_) key = hash_combine(key, static_cast<std::uint64_t>(i));
  return key;
}

// ---- first guesses ------------------------------------------------------------------------------

bool Net::flies(const Island::End& end) const {
  return obstacles_[end.joint] != nullptr && obstacles_[end.joint]->flies() &&
         end.side != joint(end.joint).role.kinematic;
}

/// Asks the Neumann sides of a level to fly; the bodies that do.
std::vector<int> Net::release(std::size_t level, const Eigen::VectorXd& x, Bodies& bodies) const {
  std::vector<int> flown;
  for (const Island::End& end : island_->ends[level]) {
    if (!flies(end)) continue;
    obstacles_[end.joint]->release(joint(end.joint), bodies);
    flown.push_back(joint(end.joint).neumann_side().body);
  }
  keep_one_each(flown);
  for (const Island::End& end : island_->ends[level]) {
    const Joint& own = joint(end.joint);
    if (end.side == own.role.kinematic &&
        std::ranges::binary_search(flown, own.kinematic_side().body))
      own.exchange->impose(end.side, part(x, end.joint), own, bodies);
  }
  return flown;
}

/// The last levels fly first: a body that finds contact as well flies against the surfaces that it
/// finds, where these were told to go.
std::optional<Failed> Net::predict(Eigen::VectorXd& x, Bodies& bodies) {
  for (std::size_t i = 0; i < count(); ++i)
    if (obstacles_[i] == nullptr || !obstacles_[i]->flies()) exchange(i).predict(part(x, i));
  for (std::size_t level = island_->ends.size(); level-- > 0;) {
    const std::vector<int> flown = release(level, x, bodies);
    if (flown.empty()) continue;
    if (std::optional<Failed> failed = bodies.advance(flown)) return failed;
    for (const Island::End& end : island_->ends[level]) {
      if (!flies(end)) continue;
      obstacles_[end.joint]->see_flight(joint(end.joint), bodies);
      obstacles_[end.joint]->predict(part(x, end.joint));
    }
    for (const int body : flown) bodies[body].restore();
  }
  tie_net_.predict(x);
  return std::nullopt;
}

// ---- of a sweep ---------------------------------------------------------------------------------

void Net::impose(std::size_t level, const Eigen::VectorXd& x, Bodies& bodies) const {
  for (const auto& [i, side] : island_->ends[level])
    exchange(i).impose(side, part(x, i), joint(i), bodies);
}

void Net::image(const Eigen::VectorXd& x, const Bodies& bodies, Eigen::VectorXd& g,
                Eigen::VectorXd& s) {
  for (std::size_t i = 0; i < count(); ++i) {
    exchange(i).image(part(x, i), joint(i), bodies, part(g, i));
    exchange(i).scales(part(s, i));
  }
  double most = 0.0;
  for (const auto& [own, obstacle, i] : known_.obstacles)
    most = std::max(most, obstacle->pressed(*own));
  for (const auto& [own, obstacle, i] : known_.obstacles) obstacle->measure_forces_by(most);
}

FieldResiduals Net::residual(const Eigen::VectorXd& x, const Eigen::VectorXd& g) const {
  FieldResiduals residual;
  for (std::size_t i = 0; i < count(); ++i)
    residual.include(exchange(i).measure(part(x, i), part(g, i)),
                     obstacles_[i] == nullptr ? 1.0 : obstacles_[i]->stray());
  residual.force = std::max(residual.force, force(x, g));
  return residual;
}

double Net::force(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  double most = 0.0;
  for (const auto& [own, obstacle, i] : known_.obstacles)
    most = std::max(most, obstacle->force_of(part(from, i), part(to, i)));
  return most;
}

double Net::distance(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  double most = 0.0;
  for (std::size_t i = 0; i < count(); ++i)
    most = std::max(most, exchange(i).measure(part(from, i), part(to, i)).largest());
  return most;
}

std::string Net::contradiction(const Eigen::VectorXd& r, double tolerance, const Bodies& bodies,
                               bool& stays_open) const {
  return tie_net_.contradiction(r, tolerance, window_.end, bodies, stays_open);
}

Eigen::VectorXd Net::inverse(const Eigen::VectorXd& r) const {
  Eigen::VectorXd out = r;
  for (std::size_t i = 0; i < count(); ++i) part(out, i) = exchange(i).apply_inverse(part(r, i));
  tie_net_.apply_inverse(out);
  if (tie_net_.empty()) return out;
  for (const auto& [own, obstacle, i] : known_.obstacles) obstacle->follow(out, part(out, i));
  return out;
}

Eigen::VectorXd Net::relaxed(const Eigen::VectorXd& r) const {
  Eigen::VectorXd out = r;
  for (std::size_t i = 0; i < count(); ++i) part(out, i) *= exchange(i).first_factor();
  return out;
}

// ---- how the iteration may go -------------------------------------------------------------------

bool Net::contracts() const {
  return !known_.obstacles.empty() && known_.obstacles.size() + known_.ties.size() == count();
}

bool Net::leaves_out() const {
  return std::ranges::any_of(known_.obstacles,
                             [](const auto& entry) { return entry.exchange->leaves_out(); });
}

bool Net::projects() const {
  for (std::size_t i = 0; kernels_ && i < count(); ++i)
    if (exchange(i).projects()) return true;
  return false;
}

bool Net::ease(Bodies& bodies) {
  if (!kernels_ || !contact_beside_ties()) return false;
  bool answered = contacts_apart(*island_, joints_, bodies);
  for (const auto& [own, obstacle, i] : known_.obstacles)
    answered = answered && obstacle->ease(tie_net_, *own, bodies);
  if (!answered) withdraw(bodies);
  return answered;
}

void Net::withdraw(Bodies& bodies) {
  for (const auto& [own, obstacle, i] : known_.obstacles) obstacle->withdraw(*own, bodies);
}

}  // namespace abut
