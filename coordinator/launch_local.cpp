#include "coordinator/launch_local.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/external_body.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "subdomain_solver/make/body_facts.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/make/read_body.hpp"

namespace abut {
namespace {

std::string path_of(const std::string& body) { return "bodies." + body; }

RowBar wall_of(const BodySpec& spec) {
  RowBar wall;
  wall.wall = true;
  wall.position = spec.initial.position[0];
  return wall;
}

RowBar bar_of(const BarProperties& bar) {
  RowBar data;
  data.youngs_modulus = bar.youngs_modulus;
  data.density = bar.density;
  data.area = bar.area;
  data.length = bar.length;
  data.position = bar.position;
  data.velocity = bar.velocity;
  data.fixed = bar.fixed;
  data.body_force = bar.body_force;
  return data;
}

/// All bodies of a scene as a row of bars, and where the sides of its interfaces lie on them.
struct Row {
  std::vector<RowBar> bars;         // as tables show bodies
  std::vector<std::string> bodies;  // their names
  std::vector<std::array<BarEnd, 2>> interfaces;
};

void add_bars(const BodySpec& spec, Row& row) {
  if (std::holds_alternative<BarPairSpec>(spec.model)) {
    for (const BarProperties& bar : pair_properties(spec)) row.bars.push_back(bar_of(bar));
  } else if (spec.is_uniform_bar()) {
    row.bars.push_back(bar_of(fe_bar_properties(spec)));
  } else {
    row.bars.push_back(wall_of(spec));
  }
}

BarEnd end_of(const Scene& scene, const std::vector<const Description*>& bodies,
              const PortName& name) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (scene.bodies[b].first != name.body) continue;
    for (std::size_t p = 0; p < bodies[b]->ports.size(); ++p) {
      const Port& port = bodies[b]->ports[p];
      if (port.name == name.port)
        return {recorded_body_of(bodies, static_cast<int>(b), static_cast<int>(p)),
                port.geometry.normals.at(0) > 0.0 ? 1 : 0};
    }
  }
  throw InputError("names a port that " + name.body + " does not have", "interfaces",
                   "Name one of the body's ports.");
}

Row row_of(const Scene& scene, const std::vector<const Description*>& bodies,
           const Document& document) {
  Row row;
  for (const auto& [name, entry] : scene.bodies) {
    const BodySpec spec = read_body(document, path_of(name), entry.context);
    if (spec.shape() != nullptr && !spec.is_uniform_bar()) {
      throw InputError(fmt::format("describes bars and walls without loads, initial fields, points "
                                   "and constraints, but the body {} is neither",
                                   name),
                       document.where("meta.closed_form"),
                       "Leave out meta.closed_form and the expectations that need it.");
    }
    add_bars(spec, row);
  }
  for (const RecordedBody& body : recorded_bodies(bodies)) row.bodies.push_back(body.name);
  ABUT_ASSERT(row.bodies.size() == row.bars.size());
  for (std::size_t b = 0; b < row.bars.size(); ++b) row.bars[b].name = row.bodies[b];
  for (const auto& [name, interface] : scene.interfaces)
    row.interfaces.push_back({end_of(scene, bodies, split_port(interface.sides[0])),
                              end_of(scene, bodies, split_port(interface.sides[1]))});
  return row;
}

/// Exact solutions are of bodies that push each other and never pull.
void require_contact(const Scene& scene, const Document& document) {
  for (const auto& [name, interface] : scene.interfaces)
    if (interface.tied)
      throw InputError(
          fmt::format("describes contact, but the interface {} is tied", name),
          document.where("meta.closed_form"),
          "Leave out meta.closed_form (and expectations that need it), or make one bar of the tied "
          "ones.");
}

/// The two bodies of one interface alone.
ClosedForm impact_of(const Scene& scene, const Row& row, const std::string& interface) {
  std::size_t number = 0;
  while (scene.interfaces[number].first != interface) ++number;
  const std::array<BarEnd, 2>& ends = row.interfaces[number];
  const std::size_t first = index(ends[0].bar);
  const std::size_t second = index(ends[1].bar);
  return {std::string(BarImpactForm::name),
          bar_impact({row.bars[first], row.bars[second]},
                     {BarEnd{0, ends[0].side}, BarEnd{1, ends[1].side}}, scene.time.begin,
                     scene.time.end),
          {interface},
          {row.bodies[first], row.bodies[second]}};
}

/// What meets at an interface: a bar with the side at which it is met, or anything else.
struct ImpactSide {
  std::optional<BarProperties> bar;
  double outward = 0.0;   // along x
  double velocity = 0.0;  // [m/s]
  bool known = false;     // a bar or a wall
};

ImpactSide meeting_of(const Scene& scene, const Document& document, const PortName& name) {
  const auto named = [&name](const auto& body) { return body.first == name.body; };
  const BodyEntry& entry = std::ranges::find_if(scene.bodies, named)->second;
  if (entry.external) return {};
  const BodySpec spec = read_body(document, path_of(name.body), entry.context);
  if (std::holds_alternative<BarPairSpec>(spec.model)) {
    const std::size_t member = name.port == "left_tip" ? 0 : 1;
    const BarProperties bar = pair_properties(spec)[member];
    return {bar, member == 0 ? 1.0 : -1.0, bar.velocity, true};
  }
  double outward = 0.0;
  for (const auto& [port, data] : spec.ports)
    if (port == name.port) outward = data.side == "left" ? -1.0 : 1.0;
  if (std::holds_alternative<RigidWallSpec>(spec.model)) return {{}, outward, 0.0, true};
  if (!spec.is_uniform_bar()) return {};
  const BarProperties bar = fe_bar_properties(spec);
  return {bar, outward, bar.velocity, true};
}

/// Impedance of a bar [kg/s]; of a wall none is higher.
double impedance_of(const ImpactSide& side) {
  if (!side.bar) return std::numeric_limits<double>::infinity();
  return side.bar->density * side.bar->wave_speed() * side.bar->area;
}

/// The strain with which a front leaves the contact, as d'Alembert has it.
void check_strain(const ImpactSide& one, const ImpactSide& other, const std::string& body,
                  const Document& document) {
  const double closing = one.outward * (one.velocity - other.velocity);
  const double mine = impedance_of(one), its = impedance_of(other);
  const double share = std::isinf(its) ? 1.0 : its / (mine + its);
  const double strain = closing * share / one.bar->wave_speed();
  if (strain <= 1.0 + 1.0e-9) return;
  throw InputError(
      fmt::format(
          "is compressed to nothing: it is met at {:g} m/s, and {:g} m/s give it the strain "
          "-1; its wave speed is {:g} m/s",
          closing, one.bar->wave_speed() / share, one.bar->wave_speed()),
      document.where(path_of(body)), "Give the bodies less speed, or the bar a higher modulus.");
}

}  // namespace

void check_speeds(const Scene& scene, const Document& document) {
  InputErrors errors;
  for (const auto& [name, interface] : scene.interfaces) {
    if (interface.tied) continue;
    const std::array<PortName, 2> names = {split_port(interface.sides[0]),
                                           split_port(interface.sides[1])};
    const std::array<ImpactSide, 2> sides = {meeting_of(scene, document, names[0]),
                                             meeting_of(scene, document, names[1])};
    if (!sides[0].known || !sides[1].known) continue;
    for (const std::size_t s : {0u, 1u})
      if (sides[s].bar)
        errors.gather([&] { check_strain(sides[s], sides[1 - s], names[s].body, document); });
  }
  errors.raise();
}

std::vector<std::unique_ptr<Subdomain>> launch_local(const Scene& scene, const Document& document,
                                                     const std::atomic<bool>* interrupted) {
  std::vector<std::unique_ptr<Subdomain>> bodies;
  InputErrors errors;
  const auto progress = [interrupted] {
    if (interrupted != nullptr && interrupted->load())
      throw RunError("interrupted while a body was advancing", "", "start the run again");
  };
  for (const auto& body : scene.bodies) {
    if (body.second.external) {
      bodies.push_back(nullptr);
    } else {
      errors.gather([&] {
        bodies.push_back(make_body(document, path_of(body.first), body.second.context, progress));
      });
    }
  }
  errors.raise();
  return bodies;
}

std::vector<std::optional<BodyFacts>> local_facts(const Scene& scene, const Document& document) {
  std::vector<std::optional<BodyFacts>> facts;
  for (const auto& [name, entry] : scene.bodies) {
    facts.emplace_back();
    if (!entry.external) facts.back() = body_facts(document, path_of(name), entry.context);
  }
  return facts;
}

void check_body_keys(const Scene& scene, const Document& document) {
  InputErrors errors;
  std::map<std::string, const BodyContext*> contexts;
  for (const auto& [name, entry] : scene.bodies) contexts[name] = &entry.context;
  const BodyContext alone;
  for (const std::string& name : document.keys("bodies"))
    errors.gather([&] {
      if (is_external(document, name)) {
        read<ExternalBody>(document, path_of(name));
      } else {
        const auto known = contexts.find(name);
        read_body(document, path_of(name), known != contexts.end() ? *known->second : alone);
      }
    });
  errors.raise();
}

std::optional<ClosedForm> make_closed_form(const Scene& scene,
                                           const std::vector<const Description*>& bodies,
                                           const Document& document) {
  if (!scene.meta.closed_form) return std::nullopt;
  require_contact(scene, document);
  const Row row = row_of(scene, bodies, document);
  const std::vector<std::string> names = exact_interfaces(scene);
  try {
    if (std::holds_alternative<BarImpactForm>(*scene.meta.closed_form))
      return impact_of(scene, row, names[0]);
    return ClosedForm{std::string(BarsForm::name),
                      BarRow(row.bars, row.interfaces, scene.time.begin, scene.time.end), names,
                      row.bodies};
  } catch (const InputError& error) {
    throw InputError(error.what_is_wrong, document.where("meta.closed_form"), error.remedy);
  }
}

void document_body_keys(Reference& reference) {
  reference.add<BodySpec>("A body", "bodies.<name>");
  reference.add<ExternalBody>("A body of another program", "bodies.<name>");
}

void resolve_body_keys(const Scene& scene, const Document& document, ResolvedYaml& resolved) {
  // The resolved scene lies in another folder than the scene, and means the same files.
  const std::filesystem::path folder = std::filesystem::absolute(document.name()).parent_path();
  for (const auto& [name, entry] : scene.bodies) {
    if (entry.external) {
      resolved.copy(path_of(name) + ".model", document);
      continue;
    }
    BodySpec spec = read_body(document, path_of(name), entry.context);
    spec.place_files((folder / "").string());
    resolved.add(path_of(name), spec);
  }
}

}  // namespace abut
