#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "base/archive.hpp"
#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "tests/support/star.hpp"

namespace abut {

/// A star as a body with a passive form: two of its points are port "left", the third is port
/// "right". In its own scheme the points have no mass and stay where their springs pull nothing, so
/// that it flies as one, whatever it is told; in its passive form they have their own.
class StarBody : public Subdomain, private PassiveForm {
 public:
  struct Counts {
    int saves = 0, restores = 0, enters = 0, leaves = 0, steps = 0, damps = 0;
  };

  StarBody() {
    description_.name = "star";
    description_.model = "points on springs around a mass";
    description_.dim = 3;
    description_.dofs = 12;
    description_.mass = star_.mass();
    description_.stable_step = std::numeric_limits<double>::infinity();
    Port left, right;
    left.name = "left", right.name = "right";
    left.geometry.points = {-1.0, 0.0, 0.0, -1.0, 0.5, 0.0};
    right.geometry.points = {1.0, 0.0, 0.25};
    description_.ports = {left, right};
    for (Port& port : description_.ports) {
      port.geometry.dim = 3;
      port.geometry.normals.assign(port.geometry.points.size(), 0.0);
    }
    description_.can.passive = true;
    save();
    counts = Counts{};
  }

  std::function<void(PassiveReply&)> spoil;  // a test may make replies to steps unsound here
  double longest = std::numeric_limits<double>::infinity();  // [m] spring with which it leaves
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
    sample(window.begin, response);
    for (int r = 1; r <= flight_->records; ++r) {
      const double part = window.length() / flight_->records;
      star_.fly(part);
      response.records.push_back(record(window.begin + r * part));
    }
    sample(window.end, response);
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
  PassiveForm* passive() override { return description_.can.passive ? this : nullptr; }

  void state(Archive& archive) {
    archive.field("u", star_.u);
    archive.field("v", star_.v);
    archive.field("work", star_.work);
    archive.field("passive", passive_);
  }

 protected:
  Description description_;

 private:
  double enter() override {
    ++counts.enters;
    passive_ = true;
    return 0.0;  // all points move as the centre does: their own mass changes nothing
  }
  [[nodiscard]] Outcome leave(double time, double& lost) override {
    ++counts.leaves;
    for (std::size_t k = 0; k < 3 * star_.points(); ++k)
      if (std::abs(star_.pull(k)) > longest)
        return Failed{Failed::Cause::no_convergence, time, "a spring does not let go"};
    const double before = star_.energy();
    star_.settle();
    passive_ = false;
    lost = before - star_.energy();
    return Advanced{};
  }
  void start(const PassiveStep& step) override { asked_ = &step; }
  [[nodiscard]] Outcome finish(PassiveReply& reply) override {
    ++counts.steps;
    std::vector<double> impulses(3 * star_.points(), 0.0);
    for (std::size_t p = 0; p < 2; ++p)
      std::ranges::copy(asked_->impulses[p], impulses.begin() + first(p));
    const bool goes = asked_->length() > 0.0;
    from_.assign(star_.u.size(), 0.0);
    if (goes) from_.assign(star_.u.begin(), star_.u.end());
    if (goes) star_.step(asked_->length(), impulses);
    answer(reply);
    if (spoil) spoil(reply);
    for (const double u : star_.u)
      if (!(std::abs(u) < 1.0e100))
        return Failed{Failed::Cause::non_finite, asked_->end, "the star is lost"};
    return Advanced{};
  }
  double damp(double joules) override {
    ++counts.damps;
    return star_.damp(joules);
  }

  /// Of a port's values among those of all points.
  static std::ptrdiff_t first(std::size_t port) { return port == 0 ? 0 : 6; }
  static std::ptrdiff_t end(std::size_t port) { return port == 0 ? 6 : 9; }

  void answer(PassiveReply& reply) const {
    reply.ports.resize(2);
    std::vector<std::size_t> rows;  // pressed points
    for (std::size_t p = 0; p < 2; ++p) {
      reply.ports[p].displacement.clear();
      for (std::ptrdiff_t k = first(p); k < end(p); ++k)
        reply.ports[p].displacement.push_back(star_.u[k] - from_[k]);
      reply.ports[p].velocity.assign(star_.v.begin() + first(p), star_.v.begin() + end(p));
      for (const std::int32_t point : asked_->pressed[p]) rows.push_back(2 * p + index(point));
    }
    const std::size_t values = 3 * rows.size();
    reply.compliance.assign(values * values, 0.0);
    for (std::size_t i = 0; i < values; ++i)
      for (std::size_t j = i % 3; j < values; j += 3)
        reply.compliance[i * values + j] =
            star_.compliance(rows[i / 3], rows[j / 3], asked_->length());
    reply.record = record(asked_->end);
    reply.bulge = reply.held = 0.0;
  }
  BodyRecord record(double time) const {
    BodyRecord told;
    told.time = time;
    told.energy = {star_.kinetic(), star_.stored(), 0.0, star_.work};
    for (const double v : star_.mean_velocity()) told.momentum.push_back(star_.mass() * v);
    return told;
  }
  void sample(double time, Response& response) const {
    for (std::size_t p = 0; p < 2; ++p) {
      PortResponse& port = response.ports[p];
      port.speed_bound = std::numeric_limits<double>::infinity();
      port.lower.assign(3 * index(flight_->records), -1.0e6);  // boxes may be wider than the way
      port.upper.assign(3 * index(flight_->records), 1.0e6);
      Waveform& trace = port.trace;
      trace.width = static_cast<int>(end(p) - first(p));
      trace.time.push_back(time);
      trace.u.insert(trace.u.end(), star_.u.begin() + first(p), star_.u.begin() + end(p));
      trace.v.insert(trace.v.end(), star_.v.begin() + first(p), star_.v.begin() + end(p));
      trace.a.resize(trace.u.size(), 0.0);
      trace.f.resize(trace.u.size(), 0.0);
    }
  }
  Star star_{{1.0, -0.5, 2.0}};
  bool passive_ = false;
  const Advance* flight_ = nullptr;
  std::vector<double> from_;  // [m] where the step began
  const PassiveStep* asked_ = nullptr;
  std::vector<std::byte> saved_;
};

}  // namespace abut
