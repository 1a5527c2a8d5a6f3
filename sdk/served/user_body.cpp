#include "sdk/served/user_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/counted.hpp"
#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

constexpr double not_told = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void UserBody::State::state(Archive& archive) {
  archive.field("state of the body", user);
  archive.field("u", u);
  archive.field("v", v);
  archive.field("a", a);
  archive.field("rate", rate);
  archive.field("force", force);
}

UserBody::UserBody(const abut_body& body, const abut_parts& parts) : body_(body), parts_(parts) {
  if (parts_.wrong) throw InputError(*parts_.wrong);
  first_.push_back(0);
  for (const Port& port : parts_.ports)
    first_.push_back(first_.back() + port.geometry.points.size());
  require_whole();
  for (std::vector<double>* each : {&own_.u, &own_.v, &own_.a, &own_.rate, &own_.force})
    each->assign(values(), 0.0);
  work_.assign(parts_.ports.size(), 0.0);
  look();
}

UserBody::~UserBody() {
  if (body_.release != nullptr) body_.release(body_.self);
}

void UserBody::require_whole() const {
  if (parts_.ports.empty())
    throw InputError("names no port", "body", "Give it a point, or a surface.");
  for (const Port& port : parts_.ports)
    if (port.geometry.dim != body_.dim)
      throw InputError(fmt::format("port {} has {} dimensions, the body {}", port.name,
                                   port.geometry.dim, body_.dim),
                       "surface()", "Set dim of the body before its ports are named.");
  if (!(body_.mass > 0.0) && !(body_.quasi_static != 0 && body_.mass == 0.0))
    throw InputError(fmt::format("mass is {}", body_.mass), "body",
                     "Set mass [kg]; infinity: nothing moves it.");
  if (body_.step == nullptr) throw InputError("has no step", "body", "A body can step().");
  const auto require_state = [this](const char* name, bool other, const char* function) {
    const abut_parts::State* const found = named(name);
    if (!other && (found == nullptr || found->count != values()))
      throw InputError(
          fmt::format("has {}, not {}", counted(found != nullptr ? found->count : 0, "number"),
                      values()),
          fmt::format("state {}", name), fmt::format("Or say {}().", function));
  };
  require_state("u", body_.displacement != nullptr, "displacement");
  require_state("v", body_.velocity != nullptr || body_.quasi_static != 0, "velocity");
}

const abut_parts::State* UserBody::named(const char* name) const {
  const auto found =
      std::ranges::find_if(parts_.states, [name](const auto& state) { return state.name == name; });
  return found == parts_.states.end() ? nullptr : &*found;
}

/// Where the points are and how fast they go, now.
void UserBody::look() {
  own_.u.front() = own_.v.front() = not_told;
  if (body_.displacement != nullptr) body_.displacement(body_.self, own_.u.data());
  if (std::isnan(own_.u.front())) take("u", own_.u);
  if (body_.velocity != nullptr) body_.velocity(body_.self, own_.v.data());
  if (!std::isnan(own_.v.front())) return;
  glides_ = body_.quasi_static != 0;
  if (glides_) {
    own_.v = own_.rate;
  } else {
    take("v", own_.v);
  }
}

void UserBody::take(const char* name, std::vector<double>& to) const {
  if (const abut_parts::State* const state = named(name))
    std::copy_n(state->values, values(), to.begin());
}

const char* UserBody::step(double dt, const std::vector<double>& force) {
  const State before = own_;
  if (const char* const why = body_.step(body_.self, dt, force.data())) return why;
  look();
  for (std::size_t k = 0; k < values(); ++k) own_.rate[k] = (own_.u[k] - before.u[k]) / dt;
  if (glides_) own_.v = own_.rate;
  for (std::size_t k = 0; k < values(); ++k) own_.a[k] = (own_.v[k] - before.v[k]) / dt;
  own_.force = force;
  work_.front() = not_told;
  if (body_.work != nullptr) body_.work(body_.self, work_.data());
  if (std::isnan(work_.front())) work_of_way(before);
  return nullptr;
}

/// Force times way, by port.
void UserBody::work_of_way(const State& before) {
  for (std::size_t p = 0; p < ports().size(); ++p) {
    work_[p] = 0.0;
    for (std::size_t k = first(p); k < first(p + 1); ++k) {
      // Without inertia the force grows with the way.
      const double acting =
          body_.quasi_static != 0 ? (before.force[k] + own_.force[k]) / 2.0 : own_.force[k];
      work_[p] += acting * (own_.u[k] - before.u[k]);
    }
  }
}

/// Whether nothing of it counts as kinetic energy or momentum.
bool UserBody::stands() const { return body_.quasi_static != 0 || std::isinf(body_.mass); }

/// [m/s] (dim) of the first port, all in one piece.
std::vector<double> UserBody::mean_velocity() const {
  std::vector<double> mean(index(body_.dim), 0.0);
  const double points = double(width(0)) / body_.dim;
  for (std::size_t k = 0; k < width(0); ++k) mean[k % mean.size()] += own_.v[k] / points;
  return mean;
}

std::vector<double> UserBody::momentum() const {
  std::vector<double> all(index(body_.dim), not_told);
  if (body_.momentum != nullptr) body_.momentum(body_.self, all.data());
  if (!std::isnan(all.front())) return all;
  std::ranges::fill(all, 0.0);
  if (!stands()) all = mean_velocity();
  for (double& each : all) each *= stands() ? 0.0 : body_.mass;
  return all;
}

Energy UserBody::energy() const {
  abut_energy told{not_told, 0.0, 0.0, 0.0};
  if (body_.energy != nullptr) body_.energy(body_.self, &told);
  if (std::isnan(told.kinetic)) {
    told.kinetic = 0.0;
    if (!stands())
      for (const double v : mean_velocity()) told.kinetic += 0.5 * body_.mass * v * v;
  }
  return {told.kinetic, told.stored, told.dissipated, told.external_work};
}

BodyRecord UserBody::record(double time) const {
  BodyRecord record;
  record.time = time;
  record.energy = energy();
  if (!std::isinf(body_.mass)) record.momentum = momentum();
  return record;
}

double UserBody::speed_bound() const {
  const double told = body_.speed_bound != nullptr ? body_.speed_bound(body_.self) : not_told;
  if (!std::isnan(told)) return told;
  if (!(body_.surface_mass > 0.0) || body_.quasi_static != 0)
    return std::numeric_limits<double>::infinity();
  return std::sqrt(2.0 * std::max(0.0, energy().total()) / body_.surface_mass);
}

double UserBody::acceleration_bound() const {
  return body_.acceleration_bound != nullptr ? body_.acceleration_bound(body_.self) : 0.0;
}

void UserBody::rest() {
  if (body_.rest == nullptr) return;
  body_.rest(body_.self);
  look();
}

UserBody::State UserBody::snapshot() const {
  State all = own_;
  if (body_.save != nullptr) {
    all.user.resize(body_.save(body_.self, nullptr));
    body_.save(body_.self, all.user.data());
    return all;
  }
  for (const abut_parts::State& state : parts_.states)
    all.user.insert(all.user.end(), state.values, state.values + state.count);
  return all;
}

void UserBody::return_to(const State& state) {
  if (body_.restore != nullptr) {
    body_.restore(body_.self, state.user.data(), state.user.size());
  } else {
    const double* from = state.user.data();
    for (const abut_parts::State& to : parts_.states) {
      std::copy_n(from, to.count, to.values);
      from += to.count;
    }
  }
  own_ = state;
  own_.user.clear();
}

}  // namespace abut
