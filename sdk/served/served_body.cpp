#include "sdk/served/served_body.hpp"

#include <algorithm>
#include <utility>

#include "base/index.hpp"
#include "contract/no_answer.hpp"
#include "sdk/served/surfaces.hpp"
#include "sdk/served/window_walk.hpp"

namespace abut {

ServedBody::ServedBody(const abut_body& body, std::unique_ptr<abut_parts> parts,
                       std::function<void()> alive)
    : parts_(std::move(parts)),
      user_(body, *parts_),
      alive_(std::move(alive)),
      grid_(parts_->grid),
      draws_ports_(grid_.points.empty()),
      initial_(user_.snapshot()),
      passive_(user_, initial_, alive_) {
  if (draws_ports_) grid_ = surfaces_of(user_.ports());
  describe_it();
}

void ServedBody::describe_it() {
  const abut_body& told = user_.told();
  description_.model = told.model != nullptr ? told.model : "body of a program of its own";
  description_.dim = told.dim;
  description_.dofs = static_cast<std::int64_t>(user_.values());
  description_.mass = told.mass;
  description_.step = told.substep;
  description_.stable_step = told.stable_step;
  description_.conserves = told.conserves != 0;
  description_.linear = told.linear != 0;
  description_.quasi_static = told.quasi_static != 0;
  description_.can.force = description_.can.kernel = true;
  description_.can.passive = told.quasi_static == 0;
  description_.ports.assign(user_.ports().begin(), user_.ports().end());
  if (draws_ports_)
    for (const char* name : {"displacement", "velocity"})
      description_.fields.push_back({name, FieldPlace::nodes, 3});
  description_.fields.insert(description_.fields.end(), parts_->fields.begin(),
                             parts_->fields.end());
}

Outcome ServedBody::finish(Response& response) {
  return WindowWalk(user_, *request_, alive_).walk(response);
}

PortKernel ServedBody::probe(const Probing& asked) {
  const abut_body& told = user_.told();
  PortKernel kernel;
  kernel.step = asked.step;
  kernel.support = user_.support();
  kernel.patterns = static_cast<int>(asked.patterns.size() / user_.width(index(asked.port)));
  std::vector<int> seen = asked.seen;
  if (seen.empty()) seen.push_back(asked.port);
  kernel.width = 0;
  for (const int port : seen) kernel.width += static_cast<int>(user_.width(index(port)));
  kernel.displacement.assign(index(asked.count) * kernel.per_step(), 0.0);
  const bool own = told.kernel != nullptr && seen == std::vector{asked.port} &&
                   told.kernel(told.self, asked.port, kernel.patterns, asked.patterns.data(),
                               asked.step, asked.count, kernel.displacement.data()) == 0;
  if (!own) find_by_trying(asked, kernel);
  // Without inertia it follows the force of the instant, and remembers none.
  if (told.quasi_static != 0) kernel.begin.assign(kernel.displacement.size(), 0.0);
  return kernel;
}

/// The difference of two ways from one state, with and without the force. Of a linear body that is
/// its kernel, whatever else acts on it.
void ServedBody::find_by_trying(const Probing& asked, PortKernel& kernel) {
  const UserBody::State present = user_.snapshot();
  const bool follows = user_.told().quasi_static != 0;
  const int count = follows ? 1 : asked.count;
  const std::size_t of_pattern = user_.width(index(asked.port)), width = index(kernel.width);
  const auto from_begin = [&](std::span<const double> force) {
    user_.return_to(follows ? present : initial_);
    if (!follows) user_.rest();
    return ways(asked, count, force);
  };
  try {
    const std::vector<double> free = from_begin(std::vector<double>(of_pattern, 0.0));
    for (std::size_t q = 0; q < index(kernel.patterns); ++q) {
      const std::vector<double> moved =
          from_begin(std::span(asked.patterns).subspan(q * of_pattern, of_pattern));
      for (std::size_t k = 0; k < moved.size(); ++k)
        kernel.displacement[k / width * kernel.per_step() + q * width + k % width] =
            moved[k] - free[k];
    }
  } catch (...) {
    user_.return_to(present);
    throw;
  }
  user_.return_to(present);
}

/// [m] (count, values of the ports that are seen) under a force over the first step.
std::vector<double> ServedBody::ways(const Probing& asked, int count,
                                     std::span<const double> force) {
  std::vector<double> all(user_.values(), 0.0), told;
  std::ranges::copy(force,
                    all.begin() + static_cast<std::ptrdiff_t>(user_.first(index(asked.port))));
  for (int k = 0; k < count; ++k) {
    if (const char* const why = user_.step(asked.step, all))
      throw NoAnswer(Failed{Failed::Cause::no_convergence, 0.0, why}, description_.name);
    alive_();
    std::ranges::fill(all, 0.0);
    const auto add = [&](int port) {
      const auto first =
          user_.displacement().begin() + static_cast<std::ptrdiff_t>(user_.first(index(port)));
      told.insert(told.end(), first, first + static_cast<std::ptrdiff_t>(user_.width(index(port))));
    };
    if (asked.seen.empty()) add(asked.port);
    for (const int port : asked.seen) add(port);
  }
  return told;
}

std::vector<std::byte> ServedBody::checkpoint() {
  UserBody::State state = user_.snapshot();
  std::vector<std::byte> bytes;
  Archive archive = Archive::writer(bytes, Archive::Form::named);
  state.state(archive);
  archive.finish();
  return bytes;
}

void ServedBody::resume(std::span<const std::byte> bytes) {
  UserBody::State state = user_.snapshot();
  Archive archive = Archive::reader(bytes, Archive::Form::named);
  state.state(archive);
  archive.finish();
  user_.return_to(state);
}

std::uint64_t ServedBody::state_hash() {
  UserBody::State state = user_.snapshot();
  return hash_state(state);
}

std::vector<FieldValues> ServedBody::fields() {
  std::vector<FieldValues> all;
  if (draws_ports_) {
    all.push_back(in_space(user_.displacement(), description_.dim));
    all.push_back(in_space(user_.velocity(), description_.dim));
  }
  for (std::size_t f = 0; f < parts_->fields.size(); ++f) {
    const FieldInfo& info = parts_->fields[f];
    const std::size_t places = info.place == FieldPlace::nodes ? grid_.nodes() : grid_.cells();
    all.emplace_back(places * index(info.components), 0.0);
    if (user_.told().field != nullptr)
      user_.told().field(user_.told().self, static_cast<int>(f), all.back().data());
  }
  return all;
}

}  // namespace abut
