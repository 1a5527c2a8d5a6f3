#pragma once

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

/// The smallest Subdomain: a point mass on a line, pushed by a spring to the origin and by the
/// force on its one port. Deterministic; rewinds exactly; counts what is asked of it.
class FakeSubdomain : public Subdomain {
 public:
  struct Options {
    std::string name = "fake";
    double mass = 2.0;        // [kg]
    double stiffness = 50.0;  // [N/m]
    double position = 0.0;    // [m]
    double velocity = 3.0;    // [m/s]
    int substeps = 10;        // per window
  };
  struct Counts {
    int advances = 0, saves = 0, restores = 0, kernels = 0, grids = 0, fields = 0, meetings = 0;
    int kernels_told = 0;
  };

  FakeSubdomain() : FakeSubdomain(Options{}) {}
  explicit FakeSubdomain(const Options& options)
      : options_(options), u_(options.position), v_(options.velocity) {
    description_.name = options.name, description_.model = "point mass on a spring";
    description_.dofs = 1;
    description_.mass = options.mass;
    description_.stable_step = std::numeric_limits<double>::infinity();
    Port port;
    port.name = "tip";
    port.geometry.points = {0.25};
    port.geometry.normals = {1.0};
    description_.ports.push_back(port);
    description_.can = Capabilities{false, true, false, true, true};
    description_.fields = {{"displacement", FieldPlace::nodes, 3}};
    save();
    counts = Counts{};
  }

  /// Called once per substep, and for a probe: a test may sleep, fail or report progress here.
  std::function<void()> during_substep, before_probe;
  std::function<void(Grid&)> spoil_grid;  // a test may make the grid or the fields unsound here
  std::function<void(std::vector<FieldValues>&)> spoil_fields;
  Counts counts;
  PortKernel told;  // the last kernel that it was told

  const Description& describe() const override { return description_; }
  void meet(const Meeting& meeting) override {
    if (meeting.surface != nullptr) ++counts.meetings;
    if (meeting.kernel != nullptr) ++counts.kernels_told, told = *meeting.kernel;
  }
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

  void start(const Advance& request) override { request_ = &request; }

  [[nodiscard]] Outcome finish(Response& response) override {
    ++counts.advances;
    const TimeWindow& window = request_->window;
    const BoundaryData& boundary = request_->boundary.at(0);
    if (!boundary.impulse.empty()) v_ += boundary.impulse[0] / options_.mass;
    response.ports.resize(1);
    PortResponse& port = response.ports[0];
    port.trace.clear();
    port.trace.width = 1;
    const double place = description_.ports[0].geometry.points[0];
    port.lower = port.upper = {place + u_};
    sample(window.begin, port.trace);
    const double step = window.length() / options_.substeps;
    for (int i = 1; i <= options_.substeps; ++i) {
      if (during_substep) during_substep();
      const double time = i == options_.substeps ? window.end : window.begin + i * step;
      double force = 0.0, part = 0.0;
      for (const Waveform& given : boundary.forces) {
        if (!given.empty()) given.force_at(time, std::span<double>(&part, 1));
        force += given.empty() ? 0.0 : part;
      }
      v_ += step * (force - options_.stiffness * u_) / options_.mass;
      u_ += step * v_;
      port.lower[0] = std::min(port.lower[0], place + u_);
      port.upper[0] = std::max(port.upper[0], place + u_);
      sample(time, port.trace);
    }
    const std::size_t records = index(std::max(1, request_->records));
    port.lower.resize(records, port.lower[0]);  // the range of the whole window covers its parts
    port.upper.resize(records, port.upper[0]), port.speed_bound = std::abs(v_);
    port.recoil = Recoil{v_, 1.0 / options_.mass};
    answer(boundary, window, port);
    fill_records(window, response);
    response.steps = options_.substeps;
    if (!(std::abs(u_) < 1.0e100))
      return Failed{Failed::Cause::non_finite, window.end, "the mass is lost"};
    return Advanced{};
  }

  PortKernel probe(const Probing& asked) override {
    ++counts.kernels;
    if (before_probe) before_probe();
    PortKernel kernel;
    kernel.step = asked.step, kernel.support = ForceSupport::step;
    kernel.patterns = static_cast<int>(asked.patterns.size());
    for (int i = 1; i <= asked.count; ++i)
      for (const double force : asked.patterns)
        kernel.displacement.push_back(force * asked.step * asked.step * i / options_.mass);
    return kernel;
  }

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

  Grid grid() override {
    ++counts.grids;
    Grid grid{{0.25, 0.0, 0.0}, {1}, {0}, {0, 1}};
    if (spoil_grid) spoil_grid(grid);
    return grid;
  }
  std::vector<FieldValues> fields() override {
    ++counts.fields;
    std::vector<FieldValues> values{{u_, 0.0, 0.0}};
    if (spoil_fields) spoil_fields(values);
    return values;
  }

  void state(Archive& archive) {
    archive.field("u", u_);
    archive.field("v", v_);
  }

 private:
  void sample(double time, Waveform& trace) const {
    trace.time.push_back(time);
    trace.u.push_back(u_);
    trace.v.push_back(v_);
    trace.a.push_back(-options_.stiffness * u_ / options_.mass);
    trace.f.push_back(-options_.stiffness * u_);
  }
  /// Touches no obstacle, and says so.
  static void answer(const BoundaryData& boundary, const TimeWindow& window, PortResponse& port) {
    port.reactions.resize(boundary.obstacles.size());
    for (std::size_t i = 0; i < port.reactions.size(); ++i) {
      const Waveform& motion = boundary.obstacles[i].motion;
      Waveform& force = port.reactions[i].force = Waveform(motion.width);
      if (motion.empty()) continue;
      force.points = motion.points;
      force.time = {window.begin, window.end};
      force.f.assign(2 * index(motion.width), 0.0);
    }
  }
  void fill_records(const TimeWindow& window, Response& response) const {
    response.records.resize(index(request_->records));
    for (std::size_t i = 0; i < response.records.size(); ++i) {
      BodyRecord& record = response.records[i];
      const double part = static_cast<double>(i + 1) / static_cast<double>(request_->records);
      record.time = window.begin + part * window.length();
      record.energy.kinetic = 0.5 * options_.mass * v_ * v_;
      record.energy.stored = 0.5 * options_.stiffness * u_ * u_;
      record.momentum.assign(1, options_.mass * v_);
    }
  }

  Options options_;
  Description description_;
  double u_, v_;  // [m] [m/s]
  const Advance* request_ = nullptr;
  std::vector<std::byte> saved_;
};

}  // namespace abut
