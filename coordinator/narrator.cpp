#include "coordinator/narrator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/archive_lists.hpp"
#include "base/index.hpp"
#include "base/unit_words.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/coupling/tied_wholes.hpp"
#include "coordinator/interface_spec.hpp"
#include "coordinator/record/given_up_words.hpp"
#include "surface/sharp_nodes.hpp"

namespace abut {

void Narrator::start(double begin, double end, std::span<const Joint> joints, bool everything) {
  RunStart start{begin, end, {}, {}};
  for (int b = 0; b < bodies_.count(); ++b) start.bodies.push_back(&bodies_.describe(b));
  for (const Joint& j : joints) {
    start.interfaces.push_back({j.name,
                                {j.sides[0].body, j.sides[1].body},
                                {j.sides[0].port, j.sides[1].port},
                                j.line.reference_gap,
                                j.tied(),
                                {j.sides[0].partner, j.sides[1].partner},
                                false});
  }
  if (everything) {
    InterfaceInfo& all = start.interfaces.emplace_back();
    all.name = everything_name;
    all.many = true;
  }
  for (const InterfaceInfo& info : start.interfaces) interfaces_.push_back(info.name);
  for (Observer* observer : observers_) observer->on_start(start);
}

void Narrator::state(Archive& archive) { whole(archive, "told_passive", told_passive_); }

void Narrator::window(const WindowReport& report) {
  const SpanScope span(bodies_.spans(), "records");
  for (Observer* observer : observers_) observer->on_window(report);
}

void Narrator::end(const RunEnd& end) {
  for (Observer* observer : observers_) observer->on_end(end);
}

void Narrator::end_after_error(const RunEnd& end) {
  for (Observer* observer : observers_) {
    try {
      observer->on_end(end);
    } catch (const std::exception&) {  // a full disk again: the first error is the one to tell
    }
  }
}

void Narrator::closed(const Joint& joint, double time, double speed) {
  tell({RunEvent::Kind::contact_closed,
        time,
        interface_of(joint),
        fmt::format("contact '{}' closes at {:.6g} m/s; kinematic side: {}", joint.name, speed,
                    bodies_.describe(joint.kinematic_side().body).name),
        {{"closing_speed", speed}}});
}

void Narrator::opened(const Joint& joint, double time) {
  tell({RunEvent::Kind::contact_opened,
        time,
        interface_of(joint),
        fmt::format("contact '{}' opens", joint.name),
        {{"release_impulse", joint.contact.impulse}}});
}

void Narrator::inside(const Joint& joint, const ContactChange& change) {
  if (!change.closes)
    return tell({RunEvent::Kind::contact_opened, change.time, joint.name, "contact opens", {}});
  tell({RunEvent::Kind::contact_closed,
        change.time,
        joint.name,
        fmt::format("contact closes at {:.6g} m/s inside body {}", change.speed,
                    bodies_.describe(joint.sides[0].body).name),
        {{"closing_speed", change.speed}}});
}

void Narrator::found(const Joint& joint, double time) {
  if (shorter_steps(joint, bodies_).value_or(joint.role.kinematic) == joint.role.kinematic) return;
  const Description& finder = bodies_.describe(joint.kinematic_side().body);
  const Description& other = bodies_.describe(joint.neumann_side().body);
  tell({RunEvent::Kind::warning,
        time,
        joint.name,
        fmt::format("'{}' finds the contact '{}' in steps {:.4g} times as long as those of '{}': "
                    "where it begins and ends is known to these, which may make or take a part of "
                    "the energy; give the finder steps as short, or let the other side find it "
                    "(transmission.unilateral.kinematic)",
                    finder.name, joint.name, finder.step / other.step, other.name),
        {{"ratio", finder.step / other.step}}});
}

void Narrator::pressed_in(const Joint& joint, double time) {
  const auto moves = [this](const Side& side) {
    const Description& body = bodies_.describe(side.body);
    return !body.quasi_static && !std::isinf(body.mass);
  };
  if (joint.fit == 0.0 || joint.role.fitted >= 0 || std::ranges::any_of(joint.sides, moves)) return;
  tell({RunEvent::Kind::warning,
        time,
        joint.name,
        fmt::format("interference of {:.3g} m is pressed in at the contact '{}': its sides overlap "
                    "by it at the start, and neither has inertia. What presses it in is told as "
                    "work where it grows: initial: {{interference: {{over: TIME}}}}",
                    joint.fit, joint.name),
        {{"interference", joint.fit}}});
}

void Narrator::lowered_step(const Joint& joint, double time, double limit) {
  tell({RunEvent::Kind::warning,
        time,
        joint.name,
        fmt::format("the contact spring of '{}' lowers the stable step of body '{}' to {:.4g} s: "
                    "give it a smaller step, or its partner a softer contact_layer",
                    joint.name, bodies_.describe(joint.neumann_side().body).name, limit),
        {{"stable_step", limit}}});
}

void Narrator::overlap(const Overlap& overlap, std::span<const Joint> joints, bool all_touch) {
  const auto [a, b] = overlap.body;
  const auto joint = std::ranges::find_if(joints, [&overlap](const Joint& j) {
    const auto [one, other] = overlap.body;
    return std::minmax(j.sides[0].body, j.sides[1].body) ==
           std::pair<const int&, const int&>(one, other);
  });
  std::string advice =
      all_touch ? "none of their ports met: give them ports that hold the sides that meet, such as "
                  "side: boundary"
                : "no interface joins them: give one, or contact: {everything: {}}";
  const std::vector<int> wholes = tied_wholes(joints, bodies_.count());
  if (wholes[index(a)] == wholes[index(b)])
    advice =
        "they hang together by ties, and parts of one whole do not touch each other: give an "
        "interface between them, or finer meshes of what is between them and gives way";
  if (joint != joints.end()) {
    advice = fmt::format(
        "contact '{}' has {}", joint->name,
        joint->contact.force_scale > 0.0
            ? "not kept them apart: give smaller windows and steps, or finer "
              "meshes where they meet"
            : "never closed: look whether its ports are the sides that meet, and "
              "whether their facets look outwards, or whether an edge is too sharp for it");
  }
  const std::size_t dim = index(bodies_.describe(a).dim);
  const std::span<const double> place = std::span(overlap.place).first(dim);
  tell({RunEvent::Kind::warning,
        overlap.time,
        joint == joints.end() ? "" : interface_of(*joint),
        fmt::format("bodies '{}' and '{}' overlap by {:.3g} m at ({:.6g}) m; {}",
                    bodies_.describe(a).name, bodies_.describe(b).name, overlap.depth,
                    fmt::join(place, ", "), advice),
        {{"depth", overlap.depth}}});
}

void Narrator::never_met(const std::string& name, double time) {
  warning(time, name,
          fmt::format("contact '{}' has never closed, though its sides have gone past each other: "
                      "look whether its ports are the sides that meet, and whether their facets "
                      "look outwards",
                      name));
}

namespace {

/// [rad] Facets that meet at more are those of an edge, at less those of a round surface.
constexpr double edge_angle = 0.9, flat_angle = 1.0e-6;

/// Facets of a mesh that stand for something round: they move by corners, METHOD [M.103].
bool stands_for_round(const PortGeometry& geometry) {
  if (geometry.dim == 1) return false;
  const PosedSurface surface = posed(geometry);
  return sharp_edges(surface, flat_angle).size() > sharp_edges(surface, edge_angle).size();
}

}  // namespace

/// What is not so already and can help: nothing of surfaces to bars, nothing round to flat ones.
std::string Narrator::remedies(std::span<const Joint> joints) const {
  bool round = false, kicks = false, published = false;
  for (const Joint& joint : joints) {
    if (joint.tied() || !(joint.closed() || joint.contact.force_scale > 0.0)) continue;
    published = published || joint.watch->decision() == Decision::window_begin;
    for (const Side& side : joint.sides) {
      const PortGeometry& port = bodies_.port(side).geometry;
      round = round || stands_for_round(port);
      kicks = kicks || (port.dim == 1 && trace_of(bodies_, side).support == ForceSupport::step);
    }
  }
  return fmt::format("give smaller steps{}{}{}", round ? ", a finer mesh of round surfaces" : "",
                     kicks ? ", or contact_layer: massless" : "",
                     published ? ", or transmission: unilateral with contact_layer: massless" : "");
}

std::string Narrator::words_of(const EnergyGuard& guard, std::span<const Joint> joints) const {
  const double growth = guard.growth();
  const std::string whose =
      guard.culprit() < 0 ? ""
                          : fmt::format(" of body '{}'", bodies_.describe(guard.culprit()).name);
  return fmt::format("energy{} has {} by {:.2g} % of the most there was in motion, and {}; {}",
                     whose, growth < 0.0 ? "fallen" : "grown", 100.0 * std::abs(growth),
                     growth < 0.0 ? "nothing in this scene takes any" : "contact makes none",
                     remedies(joints));
}

void Narrator::passive(double time, const std::string& reason, bool statics) {
  constexpr int most_told = 3;
  if (++told_passive_ > most_told) return;
  tell({RunEvent::Kind::warning,
        time,
        blamed(reason),
        fmt::format("the accurate method has no answer ({}): bodies go on passively, which {}{}",
                    reason,
                    statics ? "is right to some hundredths where they come to rest and faces "
                              "press, less where edges press on few cells"
                            : "loses energy",
                    told_passive_ == most_told ? "; later times are counted only" : ""),
        {}});
}

void Narrator::accurate(double time, bool statics) {
  if (told_passive_ == 0 || told_passive_ > 3) return;
  tell({RunEvent::Kind::warning,
        time,
        "",
        statics ? "the accurate method is tried again"
                : "bodies are apart: the accurate method goes on",
        {}});
}

void Narrator::given_up(const RunEnd& end) {
  std::vector<const Description*> bodies;
  for (int b = 0; b < bodies_.count(); ++b) bodies.push_back(&bodies_.describe(b));
  const std::string text = given_up_words(end.given_up, end.windows, bodies);
  if (text.empty()) return;
  tell({RunEvent::Kind::warning, end.time, "", text, {{"given_up", end.given_up.joules()}}});
}

void Narrator::swap(const Swap& swap) {
  const Energy &before = swap.before.energy, &after = swap.after.energy;
  std::map<std::string, double> values = {
      {"mass_before", swap.mass[0]},      {"mass_after", swap.mass[1]},
      {"kinetic_before", before.kinetic}, {"kinetic_after", after.kinetic},
      {"stored_before", before.stored},   {"stored_after", after.stored},
      {"given_up", swap.given_up()}};
  const auto add = [&values](const char* name, const std::vector<double>& one,
                             const std::vector<double>& other) {
    for (std::size_t i = 0; i < one.size(); ++i) {
      values[fmt::format("{}_{}_before", name, i)] = one[i];
      if (i < other.size()) values[fmt::format("{}_{}_after", name, i)] = other[i];
    }
  };
  add("momentum", swap.before.momentum, swap.after.momentum);
  add("angular_momentum", swap.before.angular_momentum, swap.after.angular_momentum);
  const double given_up = swap.given_up();
  tell({RunEvent::Kind::swap, swap.time, swap.body,
        fmt::format("body '{}' goes on as {}, was {}; kinetic energy {:.6g} J to {:.6g} J, stored "
                    "{:.6g} J to {:.6g} J: {:.3g} J {}",
                    swap.body, swap.to, swap.from, before.kinetic, after.kinetic, before.stored,
                    after.stored, std::abs(given_up), given_up >= 0.0 ? "given up" : "added"),
        std::move(values)});
  for (Observer* observer : observers_) observer->on_swap(swap);
}

void Narrator::not_come(const std::string& event, double time) {
  tell({RunEvent::Kind::warning, time, "", event + " has not come: time.end ends the stage", {}});
}

void Narrator::energy(const EnergyGuard& guard, std::span<const Joint> joints, double time) {
  tell({RunEvent::Kind::warning, time, "", words_of(guard, joints), {{"growth", guard.growth()}}});
}

void Narrator::warning(double time, const std::string& subject, const std::string& text) {
  tell({RunEvent::Kind::warning, time, subject, text, {}});
}

void Narrator::failure(double time, const std::string& text) {
  tell({RunEvent::Kind::failure, time, blamed(text), text, {}});
}

void Narrator::thrown(double time, const std::string& text) {
  tell({RunEvent::Kind::failure, time, blamed(text), text, {}, true});
}

void Narrator::tell(RunEvent event) {
  event.text = in_units(event.text);
  for (Observer* observer : observers_) observer->on_event(event);
}

std::string Narrator::in_units(const std::string& text) const {
  return quantities_in(units_, text);
}

std::string Narrator::blamed(const std::string& text) const {
  for (int b = 0; b < bodies_.count(); ++b) {
    const std::string& name = bodies_.describe(b).name;
    if (text.find("body '" + name + "'") != std::string::npos) return name;
  }
  return "";
}

}  // namespace abut
