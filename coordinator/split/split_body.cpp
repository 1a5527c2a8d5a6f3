#include "coordinator/split/split_body.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "subdomain_solver/make/constraints.hpp"
#include "subdomain_solver/make/mesh.hpp"
#include "subdomain_solver/make/read_body.hpp"

namespace abut {

namespace {

/// Why a body cannot be divided, of a key of its own, and what to do; empty: it can be.
struct Refusal {
  std::string key, why, remedy;
};

Refusal refusal_of(const BodySpec& spec) {
  const FeModelSpec* fe = std::get_if<FeModelSpec>(&spec.model);
  if (fe == nullptr) {
    const auto name = [](const auto& model) { return std::string(model.name); };
    return {"model", fmt::format("{} has no cells to deal out", std::visit(name, spec.model)),
            "Divide bodies with model fe."};
  }
  if (fe->dimension == 1)
    return {"model.fe.dimension", "is 1: a bar is divided by hand",
            "Write shorter bars, and tie the ends that meet."};
  if (spec.initial.adjust)
    return {"initial.adjust", "moves nodes of the whole body, which its parts could not agree on",
            "Leave it out, and let the mesh meet what it touches."};
  return {};
}

bool can_be_divided(const Document& document, const BodyEntry& entry) {
  return !entry.external &&
         refusal_of(read_body(document, "bodies." + entry.name, entry.context)).why.empty();
}

std::string only_body(const Document& document, const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : scene.bodies)
    if (can_be_divided(document, entry)) names.push_back(name);
  if (names.size() == 1) return names.front();
  if (names.empty())
    throw InputError("has no body that can be divided", document.where("bodies"),
                     "Give one model: {fe: ...} in two or three dimensions.");
  throw InputError(fmt::format("has {} bodies that can be divided", names.size()),
                   document.where("bodies"),
                   fmt::format("Name one by --body: {}.", fmt::join(names, ", ")));
}

std::string chosen(const Document& document, const Scene& scene, const std::string& name) {
  if (name.empty()) return only_body(document, scene);
  std::vector<std::string> names;
  for (const auto& [other, entry] : scene.bodies) {
    names.push_back(other);
    if (other != name) continue;
    if (entry.external)
      throw InputError("is of another program, which alone knows its mesh",
                       document.where("bodies." + name + ".model"), "Divide another body.");
    return name;
  }
  throw InputError(fmt::format("has no body {}", name), document.where("bodies"),
                   fmt::format("Choose one of {}.", fmt::join(names, ", ")));
}

/// Bodies without inertia that touch and are tied at once: what the iteration accepts can be far
/// off (a sleeve in a tube: by 40 % of the pressure).
void refuse_still_contact(const Document& document, const std::string& name,
                          const BodySpec& spec) {
  if (!spec.integrates(SchemeKind::statics)) return;
  for (const auto& [port, side] : spec.ports) {
    if (!spec.context.role(port).touches) continue;
    throw InputError(
        "may touch another body, and bodies without inertia are not divided then: "
        "contact and ties together are not iterated to what is right",
        document.where(fmt::format("bodies.{}.ports.{}", name, port)),
        "Divide a body that touches nothing, or integrate this one in time.");
  }
}

std::string held_set(const std::string& constraint) { return "held_" + constraint; }

}  // namespace

std::string WholeBody::set_called(const std::string& called) const {
  for (const auto& [port, of] : spec.ports)
    if (port == called) return of.side;
  for (const auto& [constraint, of] : spec.constraints)
    if (constraint == called) return of.on;
  return mesh.node_sets.contains(called) ? called : "";
}

WholeBody whole_body(const Document& document, const Scene& scene, const std::string& name) {
  WholeBody whole;
  whole.name = chosen(document, scene, name);
  const std::string path = "bodies." + whole.name;
  const auto named = [&whole](const auto& body) { return body.first == whole.name; };
  const BodyEntry& entry = std::ranges::find_if(scene.bodies, named)->second;
  whole.spec = placed_body(document, path, entry.context);
  const Refusal refusal = refusal_of(whole.spec);
  if (!refusal.why.empty())
    throw InputError(refusal.why, document.where(path + "." + refusal.key), refusal.remedy);
  refuse_still_contact(document, whole.name, whole.spec);
  const Place place{document, path};
  whole.mesh = make_mesh(std::get<FeModelSpec>(whole.spec.model), whole.spec.initial.position,
                         place, "model.fe");
  name_points(whole.spec, place, whole.mesh);
  return whole;
}

std::vector<std::int32_t> touched_nodes(const WholeBody& whole) {
  std::vector<std::int32_t> nodes;
  for (const auto& [name, port] : whole.spec.ports) {
    if (!whole.spec.context.role(name).touches || !whole.mesh.sides.contains(port.side)) continue;
    const std::vector<std::int32_t> more = whole.mesh.nodes_of(port.side);
    nodes.insert(nodes.end(), more.begin(), more.end());
  }
  return nodes;
}

void hold_single_nodes(const Document& document, const WholeBody& whole,
                       std::vector<MeshPart>& parts) {
  for (const auto& [name, spec] : whole.spec.constraints) {
    const std::string set = held_set(name);
    if (whole.mesh.sides.contains(set) || whole.mesh.node_sets.contains(set))
      throw InputError(fmt::format("needs the name {} in the mesh, which has it", set),
                       document.where(fmt::format("bodies.{}.constraints.{}", whole.name, name)),
                       "Give the constraint another name.");
    if (!whole.mesh.sides.contains(spec.on)) continue;
    const std::vector<std::int32_t> all = whole.mesh.nodes_of(spec.on);
    for (MeshPart& part : parts) {
      std::vector<std::int32_t> own;
      std::ranges::set_intersection(all, part.nodes, std::back_inserter(own));
      for (std::int32_t& node : own) node = part.number_of(node);
      const bool faced = part.mesh.sides.contains(spec.on);
      if (own != (faced ? part.mesh.nodes_of(spec.on) : std::vector<std::int32_t>()))
        part.mesh.node_sets[set] = std::move(own);
    }
  }
}

BodySpec part_spec(const WholeBody& whole, const SplitNames& where, std::size_t part,
                   const std::string& file, const std::map<int, std::string>& towards) {
  BodySpec spec = whole.spec;
  FeModelSpec& fe = std::get<FeModelSpec>(spec.model);
  GmshSpec mesh;
  mesh.file = file;
  fe.mesh = std::move(mesh);
  fe.map.clear();
  std::ranges::fill(spec.initial.position, 0.0);  // the mesh is where the body is
  const auto reaches = [&](const std::string& name) { return where.reaches(part, name); };
  std::erase_if(spec.ports, [&](const auto& port) { return !reaches(port.second.side); });
  std::erase_if(spec.points, [&](const auto& point) { return !reaches(point.first); });
  for (auto& [name, held] : spec.constraints) {
    if (!reaches(held_set(name))) continue;
    if (held.symmetry) held = mirrored(whole.mesh, held);
    held.on = held_set(name);
  }
  std::erase_if(spec.constraints, [&](const auto& held) { return !reaches(held.second.on); });
  std::erase_if(spec.loads, [&](const auto& load) {
    return !load.second.on.empty() && !reaches(load.second.on);
  });
  if (spec.ports.empty()) spec.contact_layer = {};
  for (const auto& [other, side] : towards) {
    PortSpec port;
    port.side = side;
    const auto same = [&name = side](const auto& own) { return own.first == name; };
    if (std::ranges::any_of(spec.ports, same))
      throw InputError(fmt::format("has a port {}, as a part would have", side),
                       "bodies." + whole.name + ".ports", "Give the port another name.");
    spec.ports.emplace_back(side, port);
  }
  return spec;
}

}  // namespace abut
