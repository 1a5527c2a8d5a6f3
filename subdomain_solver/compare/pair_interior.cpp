#include "subdomain_solver/compare/pair_interior.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "subdomain_solver/bars/bar_fields.hpp"
#include "subdomain_solver/bars/compressed_bar.hpp"

namespace abut {

namespace {
/// Node-steps in about 50 ms.
constexpr double usual_pair_work = 2.0e7;
}  // namespace

PairInterior::PairInterior(std::string name, const Parameters& parameters)
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
  traits_.effort = static_cast<double>(pair_.nodes()) / usual_pair_work;
  describe_members(parameters);
}

void PairInterior::describe_members(const Parameters& parameters) {
  constexpr const char* names[] = {"left", "right"};
  for (int m : {0, 1}) {
    const BarProperties& bar = parameters.bars[m];
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
  for (std::vector<double>* values : {&seen_.u, &seen_.v, &seen_.a, &seen_.f}) values->resize(2);
}

std::size_t PairInterior::coordinates() const {
  const std::size_t n = state_.u.size();
  return state_.v.size() == n && state_.a.size() == n ? n : 0;
}

Grid PairInterior::grid() {
  Grid grid;
  for (int m : {0, 1}) add_bar(pair_.bar(m).data(), grid);
  return grid;
}

std::vector<FieldValues> PairInterior::fields() {
  std::vector<double> stress;
  for (int m : {0, 1}) {
    for (std::size_t e = pair_.first(m); e < pair_.last(m); ++e)
      stress.push_back(pair_.stress(m, e, state_.u));
  }
  return bar_field_values(state_.u, state_.v, stress);
}

std::optional<Failed> PairInterior::step(const Window& window, int i, bool) {
  if (integrator_->substep(state_, window.grid.length(i))) return std::nullopt;
  return Failed{Failed::Cause::inverted_element, window.grid.time(i),
                fmt::format("an element of body '{}' has no length left; assembled on current "
                            "lengths it cannot go on",
                            description_.name)};
}

const PortValues& PairInterior::see(const Window&, double, bool) {
  for (std::size_t m : {0u, 1u}) {
    const std::size_t tip = pair_.tip(static_cast<int>(m));
    seen_.u[m] = state_.u[tip];
    seen_.v[m] = state_.v[tip];
    seen_.a[m] = state_.a[tip];
    seen_.f[m] = m == 0 ? -state_.force : state_.force;
  }
  return seen_;
}

std::optional<Failed> PairInterior::record(BodyRecord& r) {
  r.momentum.assign(1, 0.0);
  r.energy = {};
  r.energy.stored = integrator_->contact_energy(state_);
  r.members.resize(2);
  for (int m : {0, 1}) {
    MemberRecord& member = r.members[m];
    member.energy = {};
    member.energy.kinetic = integrator_->kinetic(state_, m);
    member.energy.stored = pair_.stored(m, state_.u);
    member.momentum.assign(1, pair_.momentum(m, state_.v));
    r.energy.kinetic += member.energy.kinetic;
    r.energy.stored += member.energy.stored;
    r.momentum[0] += member.momentum[0];
  }
  if (!std::isfinite(r.energy.total() + r.momentum[0])) return std::nullopt;
  const std::span<const double> u = state_.u;
  std::optional<Failed> failed = compressed_to_nothing(
      u.first(pair_.tip(0) + 1), pair_.bar(0).spacing(), r.time, description_.members[0].name);
  return failed ? failed
                : compressed_to_nothing(u.subspan(pair_.tip(1)), pair_.bar(1).spacing(), r.time,
                                        description_.members[1].name);
}

}  // namespace abut
