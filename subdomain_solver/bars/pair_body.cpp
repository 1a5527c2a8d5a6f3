#include "subdomain_solver/bars/pair_body.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/bars/bar_fields.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"
#include "subdomain_solver/saved_state.hpp"

namespace abut {

namespace {
/// Element-steps between two signs of life: about 50 ms of work.
constexpr double progress_work = 2.0e7;
}  // namespace

PairBody::PairBody(std::string name, const Parameters& parameters)
    : pair_(parameters.bars[0], parameters.bars[1], parameters.lengths) {
  state_.u.assign(pair_.nodes(), 0.0);
  state_.v.assign(pair_.nodes(), 0.0);
  state_.a.assign(pair_.nodes(), 0.0);
  for (int m : {0, 1}) {
    for (std::size_t i = pair_.first(m); i <= pair_.last(m); ++i)
      state_.v[i] = pair_.bar(m).data().velocity;
  }
  if (parameters.weights) {
    integrator_ = std::make_unique<ImplicitPair>(pair_, parameters.contact, *parameters.weights);
  } else {
    integrator_ =
        std::make_unique<ExplicitPair>(pair_, parameters.contact, parameters.step, state_);
  }
  description_.name = std::move(name);
  description_.model = parameters.words;
  description_.dofs = static_cast<std::int64_t>(pair_.nodes());
  description_.step = parameters.step;
  description_.stable_step = parameters.weights ? std::numeric_limits<double>::infinity()
                                                : pair_.stable_step(parameters.contact.penalty);
  description_.fields = bar_fields();
  describe_members(parameters);
}

void PairBody::describe_members(const Parameters& parameters) {
  constexpr const char* names[] = {"left", "right"};
  for (int m : {0, 1}) {
    const BarProperties& bar = parameters.bars[index(m)];
    description_.members.push_back({names[m], bar.mass_total(), {m}});
    description_.mass += bar.mass_total();
    Port port;
    port.name = std::string(names[m]) + "_tip";
    port.geometry.points = {m == 0 ? bar.position + bar.length : bar.position};
    port.geometry.normals = {m == 0 ? 1.0 : -1.0};
    port.geometry.spacing = pair_.bar(m).spacing();
    port.geometry.transit = port.geometry.spacing / bar.wave_speed();
    description_.ports.push_back(std::move(port));
  }
}

void PairBody::save() { save_state(state_, saved_); }

void PairBody::restore() {
  restore_state(state_, saved_);
  pair_.follow(state_.u);
}

std::vector<std::byte> PairBody::checkpoint() { return checkpoint_of(state_); }

void PairBody::resume(std::span<const std::byte> bytes) {
  PairState resumed = state_of_checkpoint<PairState>(bytes);
  const std::size_t n = pair_.nodes();
  if (resumed.u.size() != n || resumed.v.size() != n || resumed.a.size() != n) {
    throw RunError(
        fmt::format("the checkpoint holds {} nodes, but the body has {}", resumed.u.size(), n),
        fmt::format("body '{}'", description_.name),
        "Resume with the mesh that wrote the checkpoint.");
  }
  state_ = std::move(resumed);
  pair_.follow(state_.u);
}

std::uint64_t PairBody::state_hash() { return hash_state(state_); }

Grid PairBody::grid() {
  Grid grid;
  for (int m : {0, 1}) add_bar(pair_.bar(m).data(), grid);
  return grid;
}

std::vector<FieldValues> PairBody::fields() {
  std::vector<double> stress;
  for (int m : {0, 1}) {
    for (std::size_t e = pair_.first(m); e < pair_.last(m); ++e)
      stress.push_back(pair_.stress(m, e, state_.u));
  }
  return bar_field_values(state_.u, state_.v, stress);
}

PortKernel PairBody::probe(int, std::span<const double>, double, int) {
  throw RunError("does not answer for port kernels", fmt::format("body '{}'", description_.name),
                 "Ask bodies for kernels only when they offer them.");
}

Outcome PairBody::finish(Response& response) {
  ABUT_ASSERT(request_ != nullptr);
  const Advance& request = *request_;
  request_ = nullptr;
  const auto began = std::chrono::steady_clock::now();
  response.records.clear();
  response.ports.resize(2);
  for (PortResponse& port : response.ports) {
    port.trace.clear();
    port.trace.support = ForceSupport::nodal;
    port.reactions.clear();
    port.lower.clear();
    port.upper.clear();
    port.recoil.reset();
    port.work = 0.0;
    // Contact inside the body asks nobody: no flight is free.
    port.speed_bound = std::numeric_limits<double>::infinity();
    port.acceleration_bound = 0.0;
  }
  for (std::size_t m : {0u, 1u}) low_[m] = high_[m] = state_.u[pair_.tip(static_cast<int>(m))];
  push_traces(request, request.window.begin, response);
  const Substeps grid =
      Substeps::divide(request.window.begin, request.window.end, description_.step);
  if (std::optional<Failed> failed = advance_window(request, grid, response)) return *failed;
  response.steps = grid.count;
  response.compute_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  return Advanced{};
}

std::optional<Failed> PairBody::advance_window(const Advance& request, const Substeps& grid,
                                               Response& response) {
  RecordClock clock(request, grid.count);
  for (int i = 1; i <= grid.count; ++i) {
    if (!integrator_->substep(state_, grid.length(i))) {
      return Failed{Failed::Cause::inverted_element, grid.time(i),
                    fmt::format("an element of body '{}' has no length left; assembled on current "
                                "lengths it cannot go on",
                                description_.name)};
    }
    sweep();
    report_progress();
    const bool due = i == clock.substep();
    if (request.sampling == Sampling::substeps) {
      push_traces(request, grid.time(i), response);
    } else if (due) {
      push_traces(request, clock.time(), response);
    }
    for (; i == clock.substep(); clock.next()) {
      if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
    }
  }
  for (; !clock.done(); clock.next()) {  // a window of no length
    if (std::optional<Failed> failed = record(clock.time(), response)) return failed;
  }
  return std::nullopt;
}

void PairBody::push_traces(const Advance& request, double time, Response& response) const {
  for (int m : {0, 1}) {
    const std::size_t tip = pair_.tip(m);
    Waveform& trace = response.ports[index(m)].trace;
    trace.time.push_back(time);
    const Want want = request.want.empty() ? Want{} : request.want[index(m)];
    if (want.u) trace.u.push_back(state_.u[tip]);
    if (want.v) trace.v.push_back(state_.v[tip]);
    if (want.a) trace.a.push_back(state_.a[tip]);
    if (want.f) trace.f.push_back(m == 0 ? -state_.force : state_.force);
  }
}

void PairBody::sweep() {
  for (std::size_t m : {0u, 1u}) {
    const double u = state_.u[pair_.tip(static_cast<int>(m))];
    low_[m] = std::min(low_[m], u);
    high_[m] = std::max(high_[m], u);
  }
}

std::optional<Failed> PairBody::record(double time, Response& response) {
  BodyRecord r;
  r.time = time;
  r.momentum = {0.0};
  r.energy.stored = integrator_->contact_energy(state_);
  for (int m : {0, 1}) {
    MemberRecord member;
    member.energy.kinetic = integrator_->kinetic(state_, m);
    member.energy.stored = pair_.stored(m, state_.u);
    member.momentum = {pair_.momentum(m, state_.v)};
    r.energy.kinetic += member.energy.kinetic;
    r.energy.stored += member.energy.stored;
    r.momentum[0] += member.momentum[0];
    r.members.push_back(std::move(member));
    PortResponse& port = response.ports[index(m)];
    const double reference = description_.ports[index(m)].geometry.points[0];
    port.lower.push_back(reference + low_[index(m)]);
    port.upper.push_back(reference + high_[index(m)]);
    low_[index(m)] = high_[index(m)] = state_.u[pair_.tip(m)];
  }
  const bool finite = std::isfinite(r.energy.total() + r.momentum[0]);
  response.records.push_back(std::move(r));
  const std::span<const double> u = state_.u;
  if (finite) {
    std::optional<Failed> failed = compressed_to_nothing(
        u.first(pair_.tip(0) + 1), pair_.bar(0).spacing(), time, description_.members[0].name);
    return failed ? failed
                  : compressed_to_nothing(u.subspan(pair_.tip(1)), pair_.bar(1).spacing(), time,
                                          description_.members[1].name);
  }
  return Failed{
      Failed::Cause::non_finite, time,
      fmt::format("the state of body '{}' is no longer finite; its step of {:g} s may be unstable "
                  "or a value out of range: give a smaller step, check the scene's values",
                  description_.name, description_.step)};
}

void PairBody::report_progress() {
  if (!progress_) return;
  work_since_progress_ += static_cast<double>(pair_.nodes());
  if (work_since_progress_ < progress_work) return;
  work_since_progress_ = 0.0;
  progress_();
}

}  // namespace abut
