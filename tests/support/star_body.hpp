#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// A body in space with a passive form in closed form: a mass in the centre, and points on springs
/// around it, the first ones on port "left", the rest on port "right". In its own scheme the points
/// have no mass and stay where their springs pull nothing, so that it flies as one. In its passive
/// form they have their own. It knows no rotation: damping leaves momentum alone.
class StarBody : public Subdomain, private PassiveForm {
 public:
  struct Options {
    std::vector<double> masses = {0.2, 0.3, 0.5};  // [kg] of the points
    std::size_t left = 2;                          // of them on the first port
    double centre = 1.5;                           // [kg]
    double stiffness = 40.0;                       // [N/m] of each spring
    std::array<double, 3> velocity = {1.0, -0.5, 2.0};
    std::array<double, 3> gravity = {0.0, 0.0, -9.81};
    double longest = std::numeric_limits<double>::infinity();  // [m] spring that still lets go
    bool has_form = true;
  };
  struct Counts {
    int saves = 0, restores = 0, enters = 0, leaves = 0, steps = 0, damps = 0;
  };

  StarBody() : StarBody(Options{}) {}
  explicit StarBody(const Options& options) : options_(options) {
    const std::size_t points = options.masses.size();
    description_.name = "star";
    description_.model = "points on springs around a mass";
    description_.dim = 3;
    description_.dofs = static_cast<std::int64_t>(3 * (points + 1));
    description_.mass = total();
    description_.stable_step = std::numeric_limits<double>::infinity();
    for (const auto& [name, first, last] :
         {Stretch{"left", 0, options.left}, Stretch{"right", options.left, points}}) {
      Port port;
      port.name = name;
      port.geometry.dim = 3;
      for (std::size_t p = first; p < last; ++p)
        for (const double at : {std::cos(1.0 + double(p)), std::sin(1.0 + double(p)), 0.1 * double(p)})
          port.geometry.points.push_back(at);
      port.geometry.normals.assign(port.geometry.points.size(), 0.0);
      description_.ports.push_back(port);
    }
    description_.can.passive = options.has_form;
    u_.assign(3 * (points + 1), 0.0);  // the centre is the last one
    for (std::size_t p = 0; p <= points; ++p)
      v_.insert(v_.end(), options.velocity.begin(), options.velocity.end());
    save();
    counts = Counts{};
  }

  std::function<void(PassiveReply&)> spoil;  // a test may make replies to steps unsound here
  Counts counts;

  const Description& describe() const override { return description_; }
  void meet(const Meeting&) override {}
  void save() override {
    ++counts.saves;
    saved_.clear();
    Archive archive = Archive::writer(saved_, Archive::Form::bare);
    state(archive);
  }
  void restore() override {
    ++counts.restores;
    Archive archive = Archive::reader(saved_, Archive::Form::bare);
    state(archive);
  }
  void start(const Advance& request) override { flight_ = &request; }

  [[nodiscard]] Outcome finish(Response& response) override {
    const TimeWindow& window = flight_->window;
    response = {};
    response.ports.resize(2);
    for (std::size_t p : {0u, 1u}) sample(p, window.begin, response.ports[p]);
    const int records = flight_->records;
    for (int r = 0; r < records; ++r) {
      fly(window.length() / records);
      for (std::size_t p : {0u, 1u}) add_box(p, window.length() / records, response.ports[p]);
      const double time = window.begin + window.length() * (r + 1) / records;
      response.records.push_back(record(r + 1 < records ? time : window.end));
    }
    for (std::size_t p : {0u, 1u}) {
      sample(p, window.end, response.ports[p]);
      response.ports[p].speed_bound = std::numeric_limits<double>::infinity();
    }
    response.steps = 1;
    return Advanced{};
  }

  PortKernel probe(const Probing&) override { return {}; }
  std::vector<std::byte> checkpoint() override {
    std::vector<std::byte> bytes;
    Archive archive = Archive::writer(bytes, Archive::Form::named);
    state(archive);
    return bytes;
  }
  void resume(std::span<const std::byte> bytes) override {
    Archive archive = Archive::reader(bytes, Archive::Form::named);
    state(archive);
    archive.finish();
  }
  std::uint64_t state_hash() override { return hash_state(*this); }
  PassiveForm* passive() override { return options_.has_form ? this : nullptr; }
  double energy() const { return kinetic() + stored(); }  // [J]

  void state(Archive& archive) {
    archive.field("u", u_);
    archive.field("v", v_);
    archive.field("work", work_);
    archive.field("passive", passive_);
  }

 private:
  struct Stretch {
    const char* name;
    std::size_t first, last;
  };

  std::size_t points() const { return options_.masses.size(); }
  double mass(std::size_t p) const { return p < points() ? options_.masses[p] : options_.centre; }
  double total() const {
    double sum = 0.0;
    for (std::size_t p = 0; p <= points(); ++p) sum += mass(p);
    return sum;
  }
  std::size_t first(std::size_t port) const { return port == 0 ? 0 : options_.left; }
  std::size_t last(std::size_t port) const { return port == 0 ? options_.left : points(); }
  std::array<double, 3> mean_velocity() const {
    std::array<double, 3> mean{};
    for (std::size_t k = 0; k < v_.size(); ++k) mean[k % 3] += mass(k / 3) * v_[k] / total();
    return mean;
  }
  double kinetic() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < v_.size(); ++k) sum += 0.5 * mass(k / 3) * v_[k] * v_[k];
    return sum;
  }
  double stored() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3 * points(); ++k) sum += 0.5 * options_.stiffness * pull(k) * pull(k);
    return sum;
  }
  double pull(std::size_t k) const { return u_[k] - u_[3 * points() + k % 3]; }  // [m]

  BodyRecord record(double time) const {
    const std::array<double, 3> mean = mean_velocity();
    BodyRecord told;
    told.time = time;
    told.energy = {kinetic(), stored(), 0.0, work_};
    for (const double v : mean) told.momentum.push_back(total() * v);
    return told;
  }
  void fly(double step) {
    for (std::size_t k = 0; k < v_.size(); ++k) {
      const double g = options_.gravity[k % 3];
      const double way = step * (v_[k] + 0.5 * step * g);
      u_[k] += way;
      v_[k] += step * g;
      work_ += mass(k / 3) * g * way;
    }
  }
  void sample(std::size_t port, double time, PortResponse& to) const {
    to.trace.width = static_cast<int>(3 * (last(port) - first(port)));
    to.trace.time.push_back(time);
    for (std::size_t k = 3 * first(port); k < 3 * last(port); ++k) {
      to.trace.u.push_back(u_[k]);
      to.trace.v.push_back(v_[k]);
      to.trace.a.push_back(options_.gravity[k % 3]);
      to.trace.f.push_back(0.0);
    }
  }
  /// Of the last stretch of a flight: no point leaves its end by more than its fastest way.
  void add_box(std::size_t port, double step, PortResponse& to) const {
    const std::vector<double>& at = description_.ports[port].geometry.points;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way =
          step * (std::abs(v_[axis]) + step * std::abs(options_.gravity[axis]));
      double lower = std::numeric_limits<double>::infinity(), upper = -lower;
      for (std::size_t k = axis; k < at.size(); k += 3) {
        const double here = at[k] + u_[3 * first(port) + k];
        lower = std::min(lower, here - way);
        upper = std::max(upper, here + way);
      }
      to.lower.push_back(lower);
      to.upper.push_back(upper);
    }
  }

  // ---- the passive form

  double enter() override {
    ++counts.enters;
    passive_ = true;
    return 0.0;  // all points move as the centre does: their own mass changes nothing
  }

  [[nodiscard]] Outcome leave(double time, double& lost) override {
    ++counts.leaves;
    for (std::size_t k = 0; k < 3 * points(); ++k)
      if (std::abs(pull(k)) > options_.longest)
        return Failed{Failed::Cause::no_convergence, time, "a spring does not let go"};
    const double before = energy();
    const std::array<double, 3> mean = mean_velocity();
    for (std::size_t k = 0; k < v_.size(); ++k) {
      v_[k] = mean[k % 3];
      u_[k] = u_[3 * points() + k % 3];
    }
    passive_ = false;
    lost = before - energy();
    return Advanced{};
  }

  void start(const PassiveStep& step) override { asked_ = &step; }

  /// Every axis for itself: the points hang on the centre alone, so they are eliminated one by one.
  [[nodiscard]] Outcome finish(PassiveReply& reply) override {
    ++counts.steps;
    const double step = asked_->length(), quarter = 0.25 * step * step * options_.stiffness;
    double left_over = options_.centre + double(points()) * quarter;
    for (std::size_t p = 0; p < points(); ++p) left_over -= quarter * share(p, quarter);
    for (std::size_t axis = 0; axis < 3; ++axis) move(axis, step, quarter, left_over);
    answer(quarter, left_over, reply);
    if (spoil) spoil(reply);
    for (const double u : u_)
      if (!(std::abs(u) < 1.0e100))
        return Failed{Failed::Cause::non_finite, asked_->end, "the star is lost"};
    return Advanced{};
  }

  double damp(double joules) override {
    ++counts.damps;
    const std::array<double, 3> mean = mean_velocity();
    double own = kinetic();
    for (const double v : mean) own -= 0.5 * total() * v * v;
    const double taken = std::min(joules, own);
    const double kept = own > 0.0 ? std::sqrt((own - taken) / own) : 0.0;
    for (std::size_t k = 0; k < v_.size(); ++k)
      v_[k] = mean[k % 3] + kept * (v_[k] - mean[k % 3]);
    return taken;
  }

  /// Of a point's velocity what it adds to the centre's side, and what the centre gives to it.
  double share(std::size_t p, double quarter) const { return quarter / (mass(p) + quarter); }

  double impulse(std::size_t p, std::size_t axis) const {
    const std::size_t port = p < options_.left ? 0 : 1;
    const std::vector<double>& of_port = asked_->impulses[port];
    return of_port.empty() ? 0.0 : of_port[3 * (p - first(port)) + axis];
  }

  void move(std::size_t axis, double step, double quarter, double left_over) {
    const double g = options_.gravity[axis], half = 0.5 * step;
    const std::size_t centre = 3 * points() + axis;
    double known = options_.centre * (v_[centre] + half * g);
    mean_.resize(points());
    for (std::size_t p = 0; p < points(); ++p) {
      const double spring = half * options_.stiffness * pull(3 * p + axis);
      mean_[p] = mass(p) * (v_[3 * p + axis] + half * g) - spring + 0.5 * impulse(p, axis);
      known += spring + share(p, quarter) * mean_[p];
    }
    const double w = known / left_over;
    take(centre, step, w);
    for (std::size_t p = 0; p < points(); ++p)
      take(3 * p + axis, step, (mean_[p] + quarter * w) / (mass(p) + quarter));
  }
  void take(std::size_t k, double step, double w) {
    u_[k] += step * w;
    v_[k] = 2.0 * w - v_[k];
    work_ += mass(k / 3) * options_.gravity[k % 3] * step * w;
  }

  void answer(double quarter, double left_over, PassiveReply& reply) const {
    reply.ports.resize(2);
    std::vector<std::size_t> rows;  // pressed points
    for (std::size_t p : {0u, 1u}) {
      const auto from = static_cast<std::ptrdiff_t>(3 * first(p));
      const auto to = static_cast<std::ptrdiff_t>(3 * last(p));
      reply.ports[p].displacement.assign(u_.begin() + from, u_.begin() + to);
      reply.ports[p].velocity.assign(v_.begin() + from, v_.begin() + to);
      for (const std::int32_t point : asked_->pressed[p]) rows.push_back(first(p) + index(point));
    }
    const std::size_t values = 3 * rows.size();
    reply.compliance.assign(values * values, 0.0);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows.size(); ++j) {
        double own = share(rows[i], quarter) * share(rows[j], quarter) / left_over;
        if (i == j) own += 1.0 / (mass(rows[i]) + quarter);
        for (std::size_t axis = 0; axis < 3; ++axis)
          reply.compliance[(3 * i + axis) * values + 3 * j + axis] = 0.5 * own;
      }
    reply.record = record(asked_->end);
    reply.bulge = 0.0;
  }

  Options options_;
  Description description_;
  std::vector<double> u_, v_;  // [m] [m/s] of the points, then of the centre
  double work_ = 0.0;          // [J] of gravity
  bool passive_ = false;
  std::vector<double> mean_;  // on the way: right sides of the points
  const Advance* flight_ = nullptr;
  const PassiveStep* asked_ = nullptr;
  std::vector<std::byte> saved_;
};

}  // namespace abut
