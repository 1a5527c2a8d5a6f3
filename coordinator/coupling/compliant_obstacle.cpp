#include "coordinator/coupling/compliant_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/force_means.hpp"
#include "contract/kernel.hpp"
#include "coordinator/coupling/banded_kernel.hpp"
#include "coordinator/coupling/contact.hpp"
#include "coordinator/coupling/exchange_parts.hpp"
#include "coordinator/coupling/kernel_bytes.hpp"
#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/coupling/static_give.hpp"
#include "coordinator/coupling/tie_net.hpp"

namespace abut {

namespace {

/// Substeps over which a force goes on rising or falling as it did; then it stays.
constexpr int most_rising = 3;

/// Sweeps before it come from guesses: what slides in them may be far from what will. From the
/// next one on points that slid count as sliding: they become more and never fewer, which ends.
constexpr int first_that_counts = 3;

}  // namespace

void CompliantObstacle::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  const Side& k = joint.kinematic_side();
  const Side& n = joint.neumann_side();
  kinematic_grid_ = substeps_of(bodies, k, window);
  iterate_ = {substeps_of(bodies, n, window),
              static_cast<int>(bodies.port(n).geometry.points.size())};
  dim_ = index(bodies.port(n).geometry.dim);
  const Waveform& trace = trace_of(bodies, n);
  const std::size_t now = index_at_begin(trace, window.begin);
  keep_row(trace, trace.u, now, u_begin_);
  keep_row(trace, trace.v, now, v_begin_);
  keep_begin(window, joint, bodies);
  find_give(joint, bodies);
  find_kernel(window.length(), joint, bodies);
  linear_ = bodies.describe(n.body).linear;
  const bool stands = std::isinf(bodies.describe(n.body).mass) && largest(v_begin_) == 0.0;
  flight_.resize(0);
  const bool looked = free_ahead() && see_look(joint, bodies);
  flies_ = !stands && !looked;
  looks_ = !stands && free_ahead() ? window.length() : 0.0;
  expect_beyond(window);
  scale_.step = std::max(kinematic_grid_.step, iterate_.steps.step);
  scale_.velocity = usual_speed_ = measured_speed_ = joint.contact.closing_speed;
  swept_ = false;
  sweeps_ = 0;
  slid_.clear();
}

/// Where its last reply told the Neumann side would fly: over a window like this one.
bool CompliantObstacle::see_look(const Joint& joint, const Bodies& bodies) {
  const Waveform* look = look_of(bodies, joint.neumann_side(), iterate_.steps);
  if (look == nullptr) return false;
  flight_ = Eigen::Map<const Eigen::VectorXd>(look->u.data() + iterate_.width, iterate_.size());
  return true;
}

/// What the kernel leaves out is nearly what it left out in the window before, where that was as
/// long. A window that is gone through again has the guess of its first time.
void CompliantObstacle::expect_beyond(const TimeWindow& window) {
  constexpr double as_long = 1.0e-9;
  const bool again = window.begin == beyond_begin_;
  const bool next = window.begin == beyond_end_ &&
                    std::abs((beyond_end_ - beyond_begin_) / window.length() - 1.0) <= as_long;
  if (!again) beyond_ = next && free_ahead() ? beyond_now_ : Eigen::VectorXd();
  beyond_begin_ = window.begin;
  beyond_end_ = window.end;
  beyond_now_.resize(0);
}

/// What presses on the Neumann side when the window begins, as the window before left it.
void CompliantObstacle::keep_begin(const TimeWindow& window, const Joint& joint,
                                   const Bodies& bodies) {
  f_begin_.assign(u_begin_.size(), 0.0);
  f_rate_.assign(u_begin_.size(), 0.0);
  const std::vector<Reaction>& reactions = port_of(bodies, joint.kinematic_side()).reactions;
  const std::size_t partner = index(joint.kinematic_side().partner);
  if (partner >= reactions.size() || reactions[partner].force.empty()) return;
  const Waveform& force = reactions[partner].force;
  const std::size_t now = index_at_begin(force, window.begin);
  const std::span<const double> pressed = row(force, force.f, now);
  for (std::size_t c = 0; c < pressed.size(); ++c) f_begin_[value(force.points, c)] = pressed[c];
  if (now == 0) return;
  const std::span<const double> before = row(force, force.f, now - 1);
  for (std::size_t c = 0; c < before.size(); ++c)
    f_rate_[value(force.points, c)] =
        (pressed[c] - before[c]) / (force.time[now] - force.time[now - 1]);
}

void CompliantObstacle::find_zone(double length, const Joint& joint, const Bodies& bodies) {
  const Waveform& trace = trace_of(bodies, joint.kinematic_side());
  const std::size_t now = index_at_begin(trace, iterate_.steps.begin);
  keep_row(trace, trace.u, now, u_k_);
  const double speed = largest(v_begin_) + largest(row(trace, trace.v, now));
  zone_.see(joint, bodies, u_k_, u_begin_, f_begin_, speed * length);
}

/// Of statics.
void CompliantObstacle::find_give(const Joint& joint, Bodies& bodies) {
  give_ = deformation_ = 0.0;
  for (const Side& side : joint.sides) {
    const Description& body = bodies.describe(side.body);
    if (!body.quasi_static && !std::isinf(body.mass)) return;
  }
  for (const Side& side : joint.sides) give_ += static_give(side, bodies);
}

void CompliantObstacle::find_kernel(double length, const Joint& joint, Bodies& bodies) {
  const Side& k = joint.kinematic_side();
  const Side& n = joint.neumann_side();
  kernel_ = nullptr;
  first_factor_ = 1.0;
  const Description& body = bodies.describe(n.body);
  if (std::isinf(body.mass)) return;
  find_zone(length, joint, bodies);
  if (zone_.empty() || !body.can.kernel) return;
  const double values =
      zone_.points().empty() ? iterate_.width : static_cast<double>(zone_.points().size() * dim_);
  const double size = kernel_bytes(values, iterate_.steps.count);
  const bool holds = answer_.count() >= iterate_.steps.count && answer_.points == zone_.points() &&
                     answer_.step == bodies.step(n.body);
  if (!bodies.describe(k.body).can.yielding || (!holds && !probe(size, k, n, bodies))) {
    if (!bodies.describe(k.body).can.kernel) return;
    const double own = bodies.kernel(k.body, k.port, kinematic_grid_.count).displacement.front();
    const double others = bodies.kernel(n.body, n.port, iterate_.steps.count).displacement.front();
    if (own > 0.0) first_factor_ = own / (own + std::max(0.0, others));
    return;
  }
  kernel_ = &answer_;
  if (holds && answer_told_) return;
  bodies.meet(k, k.partner, n, answer_);
  answer_told_ = true;
  eased_[1].told = {};
}

/// The kernel of all points on all others where that is small, `size` [B], else of near ones where
/// these suffice. False: none fits.
bool CompliantObstacle::probe(double size, const Side& k, const Side& n, Bodies& bodies) {
  const int count = iterate_.steps.count;
  beyond_.resize(0);
  beyond_now_.resize(0);
  const std::size_t points = zone_.points().size() + 1;  // and one, as none stand for all
  const bool bands = bodies.describe(k.body).can.bands && !bodies.describe(n.body).quasi_static;
  answer_ = {};
  if (size > std::min(always_full_kernel, largest_kernel_) && bands && unbanded_ != points) {
    answer_ = banded_kernel({n.body, n.port, count, zone_.points()}, largest_kernel_, size, bodies);
    unbanded_ = answer_.count() == 0 ? points : 0;
  }
  if (answer_.count() == 0) {
    if (size > largest_kernel_) return false;
    answer_ = bodies.full_kernel(n.body, n.port, count, zone_.points());
  }
  answer_told_ = false;
  if (levels_of(kinematic_grid_) == levels_of(iterate_.steps)) answer_.compliance.clear();
  return true;
}

/// The flight of the Neumann side: what pressed at the begin goes, as the force of the instant. A
/// body without a kernel, or whose kernel is that of another state, flies under what presses,
/// carried on.
void CompliantObstacle::release(const Joint& joint, Bodies& bodies) {
  lay_times(iterate_.steps, iterate_.width, guess_);
  guess_.support = ForceSupport::linear;
  for (int i = 0; i <= iterate_.steps.count; ++i) {
    const double ahead = guess_.time[std::min(i, most_rising)] - guess_.time[0];
    for (std::size_t c = 0; c < f_begin_.size(); ++c) {
      const double on = f_begin_[c] + ahead * f_rate_[c];
      const bool turned = on * f_begin_[c] < 0.0 || f_begin_[c] == 0.0;
      guess_.f.push_back(i == 0 ? f_begin_[c] : free_ahead() || turned ? 0.0 : on);
    }
  }
  bodies.force(joint.neumann_side()) = guess_;
}

void CompliantObstacle::see_flight(const Joint& joint, const Bodies& bodies) {
  const Waveform& trace = trace_of(bodies, joint.neumann_side());
  flight_.resize(iterate_.size());
  for (int i = 1; i <= iterate_.steps.count; ++i)
    trace.interpolate(trace.u, iterate_.steps.time(i),
                      {&flight_[iterate_.at(i)], index(iterate_.width)});
  if (kernel_ == nullptr) return;
  take(guess_);
  take_back(taken_, flight_);
}

void CompliantObstacle::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  if (flight_.size() > 0) {
    x = flight_;
    if (beyond_.size() == x.size()) x += beyond_;
    return;
  }
  for (int i = 1; i <= iterate_.steps.count; ++i) {
    const double ahead = iterate_.steps.time(i) - iterate_.steps.begin;
    for (std::size_t c = 0; c < u_begin_.size(); ++c)
      x[iterate_.at(i) + static_cast<Eigen::Index>(c)] = u_begin_[c] + v_begin_[c] * ahead;
  }
}

void CompliantObstacle::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x,
                               const Joint& joint, Bodies& bodies) {
  const Side& here = joint.sides[side];
  if (side != joint.role.kinematic) {
    bodies.force(here) = bodies.reaction(joint.kinematic_side());
    bodies.request(here.body).ahead = looks_;
    return;
  }
  lay_times(iterate_.steps, iterate_.width, given_);
  given_.u = u_begin_;
  given_.u.insert(given_.u.end(), x.begin(), x.end());
  if (kernel_ != nullptr) {  // what pressed at the begin is in d
    given_.f.assign(given_.u.size(), 0.0);
    std::ranges::copy(f_begin_, given_.f.begin());
    if (eased_[1].port != nullptr) fit_ties();
  }
  Obstacle& obstacle = bodies.obstacle(here);
  obstacle.motion = given_;
  obstacle.slid = slid_;
  if (eased_[0].port != nullptr) bodies.boundary(here).balanced = balanced_;
}

/// The tie forces balance f of the sweep before: the surface is where that moves it, and the kernel
/// adds the effect of what exceeds it.
void CompliantObstacle::fit_ties() {
  Eigen::Map<Eigen::VectorXd> moved(given_.u.data() + iterate_.width, iterate_.size());
  take_back(-fits_, moved);
  for (int i = 1; i <= iterate_.steps.count; ++i)
    Eigen::Map<Eigen::VectorXd>(given_.f.data() + index(i * iterate_.width), iterate_.width) =
        fits_.col(i);
}

bool CompliantObstacle::ease(TieNet& net, const Joint& joint, Bodies& bodies) {
  const Side &k = joint.kinematic_side(), &n = joint.neumann_side();
  layout_ = &net.layout();
  eased_[0].port = eased_[1].port = nullptr;
  if (net.joins(k.body) && bodies.describe(k.body).can.neighbours)
    eased_[0].port = net.touching(k, {}, largest_kernel_, bodies);
  if (net.joins(n.body) && kernel_ != nullptr && !kernel_->band.empty()) return false;
  if (net.joins(n.body) && kernel_ != nullptr)
    eased_[1].port = net.touching(n, zone_.points(), largest_kernel_, bodies);
  if (net.joins(k.body) && eased_[0].port == nullptr) return false;
  if (net.joins(n.body) && eased_[1].port == nullptr && !zone_.empty()) return false;
  if (eased_[0].port != nullptr) {
    tell_neighbours(k, eased_[0].port->give(), bodies);
    balance_begin(k, bodies);
  }
  if (eased_[1].port == nullptr) return true;
  fits_.setZero(iterate_.width, iterate_.steps.count + 1);
  for (int i = 1; i <= iterate_.steps.count; ++i)
    fits_.col(i) = Eigen::Map<const Eigen::VectorXd>(f_begin_.data(), iterate_.width);
  PortKernel all = answer_;
  const std::vector<double>& more = eased_[1].port->give().displacement;
  for (std::size_t v = 0; v < std::min(more.size(), all.displacement.size()); ++v)
    all.displacement[v] += more[v];
  if (eased_[1].told.points == all.points && eased_[1].told.displacement == all.displacement)
    return true;
  bodies.meet(k, k.partner, n, all);
  eased_[1].told = std::move(all);
  return true;
}

void CompliantObstacle::tell_neighbours(const Side& k, const PortKernel& give, Bodies& bodies) {
  if (eased_[0].told.displacement == give.displacement) return;
  bodies.meet(k, own_surface, k, give);
  eased_[0].told = give;
}

void CompliantObstacle::withdraw(const Joint& joint, Bodies& bodies) {
  const Side& k = joint.kinematic_side();
  for (Eased& eased : eased_) eased.port = nullptr;
  bodies.boundary(k).balanced.clear();
  PortKernel& told = eased_[1].told;
  if (told.count() > 0) bodies.meet(k, k.partner, joint.neumann_side(), answer_);
  told = {};
}

/// In the first sweep the tie forces balance what presses when the window begins.
void CompliantObstacle::balance_begin(const Side& k, const Bodies& bodies) {
  const Waveform& trace = trace_of(bodies, k);
  const std::span<const double> begin =
      row(trace, trace.f, index_at_begin(trace, kinematic_grid_.begin));
  lay_times(kinematic_grid_, trace.width, balanced_);
  for (std::size_t i = 0; i < balanced_.time.size(); ++i)
    balanced_.f.insert(balanced_.f.end(), begin.begin(), begin.end());
}

/// What the kinematic side found in this sweep, for the next one.
void CompliantObstacle::keep_found(const Side& k, const Bodies& bodies) {
  ++sweeps_;
  if (sweeps_ >= first_that_counts) slid_ = port_of(bodies, k).reactions.at(index(k.partner)).slid;
  if (eased_[0].port == nullptr) return;
  const Waveform& trace = trace_of(bodies, k);
  balanced_.time = trace.time;
  balanced_.f = trace.f;
}

void CompliantObstacle::follow(const Eigen::VectorXd& change,
                               Eigen::Ref<Eigen::VectorXd> own) const {
  if (eased_[1].port != nullptr) eased_[1].port->follow(*layout_, change, iterate_.width, own);
}

/// d = y - kernel * reaction, of the last replies.
void CompliantObstacle::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                              const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  keep_found(joint.kinematic_side(), bodies);
  const Waveform& trace = trace_of(bodies, joint.neumann_side());
  const int width = iterate_.width;
  for (int i = 1; i <= iterate_.steps.count; ++i)
    trace.interpolate(trace.u, iterate_.steps.time(i), {&g[iterate_.at(i)], index(width)});
  const double length = iterate_.steps.end - iterate_.steps.begin;
  double now = std::max(reached(trace), reached(trace_of(bodies, joint.kinematic_side())));
  // Gaps are differences of places, and no rounder than these.
  const double place = largest(bodies.port(joint.neumann_side()).geometry.points);
  scale_.roundoff = roundoff_of(place + largest(u_begin_), g.tail(width).lpNorm<Eigen::Infinity>());
  if (!zone_.empty()) {
    take(bodies.reaction(joint.kinematic_side()));
    if (kernel_ != nullptr) {
      moved_ = g.tail(width);
      fits_ = taken_;
      take_back(taken_, g);
      take_back_end(g);
      if (leaves_out() && free_ahead() && flight_.size() == g.size()) beyond_now_ = g - flight_;
      moved_ -= g.tail(width);  // by the reaction: bodies at rest move by nothing else
      now = std::max(now, moved_.lpNorm<Eigen::Infinity>() / length);
    }
    leave_far(x, g);
  }
  see_speed(std::max(now, push_of_all(joint.kinematic_side().body, bodies, length)));
}

/// A speed [m/s] of this sweep: mismatches are measured by the largest.
void CompliantObstacle::see_speed(double now) {
  if (!std::exchange(swept_, true)) usual_speed_ = std::max(usual_speed_, now);
  measured_speed_ = std::max(usual_speed_, now);
  scale_.velocity = std::max(scale_.velocity, now);
}

/// Nothing presses on points outside the zone: where they are is not contact's affair.
void CompliantObstacle::leave_far(const Eigen::Ref<const Eigen::VectorXd>& x,
                                  Eigen::Ref<Eigen::VectorXd> g) const {
  const std::vector<std::int32_t>& zone = zone_.points();
  if (zone.empty()) return;
  std::size_t next = 0;
  for (int first = 0; first < iterate_.width; first += static_cast<int>(dim_)) {
    const bool inside = next < zone.size() && index(zone[next]) * dim_ == index(first);
    next += inside ? 1 : 0;
    const Eigen::Index dim = static_cast<Eigen::Index>(dim_);
    if (inside || !taken_.middleRows(first, dim).isZero(0.0)) continue;
    for (int i = 1; i <= iterate_.steps.count; ++i)
      g.segment(iterate_.at(i) + first, dim) = x.segment(iterate_.at(i) + first, dim);
  }
}

/// Takes from the Neumann side's motion what the forces taken have moved it by the kernel.
void CompliantObstacle::take_back(const Eigen::MatrixXd& taken,
                                  Eigen::Ref<Eigen::VectorXd> motion) const {
  const std::size_t width = index(kernel_->width);
  level_force_.resize(width);
  level_moved_.resize(width);
  for (int j = 0; j <= iterate_.steps.count; ++j) {
    for (std::size_t p = 0; p < width; ++p)
      level_force_[p] = taken(static_cast<Eigen::Index>(value(kernel_->points, p)), j);
    if (std::ranges::all_of(level_force_, [](double force) { return force == 0.0; })) continue;
    for (int i = std::max(1, j); i <= iterate_.steps.count; ++i) {
      double* at = &motion[iterate_.at(i)];
      for (std::size_t q = 0; q < width; ++q) level_moved_[q] = at[value(kernel_->points, q)];
      add_response(*kernel_, j == 0 ? i - 1 : i - j, j == 0, -1.0, level_force_, level_moved_);
      for (std::size_t q = 0; q < width; ++q) at[value(kernel_->points, q)] = level_moved_[q];
    }
  }
}

/// When the window ends the Neumann side stands under the force of the instant, not its mean.
void CompliantObstacle::take_back_end(Eigen::Ref<Eigen::VectorXd> motion) const {
  if (kernel_->compliance.empty()) return;
  const std::size_t width = index(kernel_->width);
  level_force_.resize(width);
  level_moved_.resize(width);
  double* moved = &motion[iterate_.at(iterate_.steps.count)];
  for (std::size_t p = 0; p < width; ++p) {
    const auto at = static_cast<Eigen::Index>(value(kernel_->points, p));
    level_force_[p] = pressed_(at, pressed_.cols() - 1) - taken_(at, iterate_.steps.count);
    level_moved_[p] = moved[value(kernel_->points, p)];
  }
  add_moved(*kernel_, kernel_->compliance, -1.0, level_force_, level_moved_);
  for (std::size_t q = 0; q < width; ++q) moved[value(kernel_->points, q)] = level_moved_[q];
}

std::size_t CompliantObstacle::value(const std::vector<std::int32_t>& points, std::size_t k) const {
  return points.empty() ? k : index(points[k / dim_]) * dim_ + k % dim_;
}

/// A force at the Neumann side's levels, as it takes it; what pressed at the begin is in d.
void CompliantObstacle::take(const Waveform& force) {
  const Substeps& steps = iterate_.steps;
  const std::vector<double> parts = force_means(levels_of(steps), force.time);
  const Eigen::Index times = static_cast<Eigen::Index>(force.size());
  const Eigen::Map<const Eigen::MatrixXd> part(parts.data(), times, steps.count + 1);
  pressed_.setZero(iterate_.width, times);
  for (std::size_t k = 0; k < index(force.width); ++k)
    for (Eigen::Index i = 0; i < times; ++i)
      pressed_(static_cast<Eigen::Index>(value(force.points, k)), i) =
          force.f[index(i) * index(force.width) + k];
  taken_.noalias() = pressed_ * part;
  taken_.col(0) -= Eigen::Map<const Eigen::VectorXd>(f_begin_.data(), iterate_.width);
}

/// [m/s] mean speed over the window of the point that went furthest.
double CompliantObstacle::reached(const Waveform& trace) const {
  const double length = trace.time.back() - trace.time.front();
  if (trace.u.empty() || length <= 0.0) return 0.0;
  const std::span<const double> from = row(trace, trace.u, 0);
  const std::span<const double> to = row(trace, trace.u, trace.size() - 1);
  double most = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k) most = std::max(most, std::abs(to[k] - from[k]));
  return most / length;
}

FieldResiduals CompliantObstacle::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                          const Eigen::Ref<const Eigen::VectorXd>& g) const {
  FieldResiduals r;
  r.displacement =
      scaled((g - x).lpNorm<Eigen::Infinity>(), scale_.velocity * scale_.step, scale_.roundoff);
  return r;
}

double CompliantObstacle::pressed(const Joint& joint) const {
  if (give_ == 0.0) return 0.0;
  double most = joint.contact.force_scale;
  for (Eigen::Index i = 0; !zone_.empty() && i < pressed_.cols(); ++i) {
    double sum = 0.0;
    for (Eigen::Index v = 0; v < pressed_.rows(); v += static_cast<Eigen::Index>(dim_))
      sum += pressed_.col(i).segment(v, static_cast<Eigen::Index>(dim_)).norm();
    most = std::max(most, sum);
  }
  return most;
}

double CompliantObstacle::force_of(const Eigen::Ref<const Eigen::VectorXd>& x,
                                   const Eigen::Ref<const Eigen::VectorXd>& g) const {
  if (!(deformation_ > 0.0)) return 0.0;
  return scaled((g - x).lpNorm<Eigen::Infinity>(), deformation_, scale_.roundoff);
}

double CompliantObstacle::stray() const {
  constexpr double nothing = 1.0e-200;  // [m/s]
  return scale_.velocity > measured_speed_ ? scale_.velocity / std::max(measured_speed_, nothing)
                                           : 1.0;
}

void CompliantObstacle::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  const double unit = scale_.velocity * scale_.step;
  s.setConstant(unit > 0.0 ? 1.0 / unit : 1.0);
}

/// The kernel as well: that of a body that is not linear is of the state in which it was probed.
void CompliantObstacle::state(Archive& archive) {
  zone_.state(archive);
  field(archive, "answer", answer_);
  field(archive, "beyond", beyond_);
  field(archive, "beyond_now", beyond_now_);
  archive.field("beyond_begin", beyond_begin_);
  archive.field("beyond_end", beyond_end_);
  if (archive.writing()) return;
  answer_told_ = false;
  eased_ = {};
}

}  // namespace abut
