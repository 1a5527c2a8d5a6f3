// Rules of a scene that need its bodies.
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/assert.hpp"
#include "base/input_errors.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/everything.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/scene_times.hpp"

namespace abut {

namespace {

const Description* description_of(const Scene& scene, std::span<const Description* const> bodies,
                                  const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].first == name) return bodies[i];
  ABUT_ASSERT(!"validate() has checked that the body exists");
  return nullptr;
}

const Port& require_port(const Description& body, const std::string& side,
                         const std::string& where) {
  const std::string port = split_port(side).port;
  std::vector<std::string> names;
  for (const Port& candidate : body.ports) {
    if (candidate.name == port) return candidate;
    names.push_back(candidate.name);
  }
  const std::string remedy =
      names.empty() ? "Give the body a port under its key ports."
                    : fmt::format("Choose one of its ports: {}.", fmt::join(names, ", "));
  throw InputError(fmt::format("is {}, but {} has no port {}", side, split_port(side).body, port),
                   where, remedy);
}

/// The two ports exist, have one dimension, and in one dimension face each other across a gap.
void validate_geometry(const InterfaceSpec& interface, const Scene& scene,
                       std::span<const Description* const> bodies, const Document& document) {
  const std::string path = fmt::format("interfaces.{}.sides", interface.name);
  std::array<const PortGeometry*, 2> ports{};
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const std::string& side = interface.sides[i];
    const Description* body = description_of(scene, bodies, split_port(side).body);
    if (body == nullptr) continue;
    ports[i] = &require_port(*body, side, document.where(fmt::format("{}[{}]", path, i))).geometry;
  }
  if (ports[0] == nullptr || ports[1] == nullptr) return;
  if (ports[0]->dim != ports[1]->dim)
    throw InputError(fmt::format("join a port in {}D and one in {}D", ports[0]->dim, ports[1]->dim),
                     document.where(path), "Give both bodies the same dimension.");
  if (interface.contact && interface.contact->restitution) {
    const bool line = ports[0]->dim == 1;
    const std::size_t soft = !line && ports[0]->transit > 0.0 ? 0 : 1;
    if (line || ports[soft]->transit > 0.0)
      throw InputError(
          line ? std::string("has no effect: bars and walls on a line bounce by themselves")
               : fmt::format("has no effect: {} deforms, and bounces by itself",
                             split_port(interface.sides[soft]).body),
          document.where(fmt::format("interfaces.{}.contact.restitution", interface.name)),
          "Leave it out; it is for two bodies that are rigid or tools.");
  }
  if (ports[0]->dim != 1) return;
  if (interface.contact && interface.contact->points)  // a resolved scene names the default
    throw InputError("has no effect: ends of bars are points",
                     document.where(fmt::format("interfaces.{}.contact.rows", interface.name)),
                     "Leave it out.");
  if (interface.contact && interface.contact->friction.rubs()) {
    std::string law = fmt::format("interfaces.{}.contact", interface.name);
    for (const std::string& key : document.keys(law)) {
      if (key == "rows") continue;
      law += "." + key;
      break;
    }
    throw InputError("has no effect: ends of bars do not slide", document.where(law),
                     "Leave it out, or model the bodies in two or three dimensions.");
  }
  const double normal = ports[0]->normals.at(0);
  if (normal + ports[1]->normals.at(0) != 0.0)
    throw InputError("look the same way and cannot touch", document.where(path),
                     "Join a right end with a left end.");
  const double gap = normal * (ports[1]->points.at(0) - ports[0]->points.at(0));
  const double place = std::max(std::abs(ports[0]->points.at(0)), std::abs(ports[1]->points.at(0)));
  if (gap < -place_rounding * place)
    throw InputError(fmt::format("overlap by {:.6g} m at the start", -gap), document.where(path),
                     "Move a body with initial.position until the gap is zero or more.");
}

/// A surface may touch several others; the end of a bar meets one partner.
void validate_ends_used_once(const Scene& scene, std::span<const Description* const> bodies,
                             const Document& document) {
  std::map<std::string, std::string> used;  // side to interface
  for (const auto& [name, interface] : scene.interfaces) {
    for (std::size_t i = 0; i < interface.sides.size(); ++i) {
      const std::string& side = interface.sides[i];
      const Description* body = description_of(scene, bodies, split_port(side).body);
      if (body == nullptr || body->dim != 1) continue;
      const auto [entry, fresh] = used.emplace(side, name);
      if (!fresh)
        throw InputError(
            fmt::format("is {}, which the interface {} uses already", side, entry->second),
            document.where(fmt::format("interfaces.{}.sides[{}]", name, i)),
            "Give every interface ports of its own; a body may have several ports.");
    }
  }
}

/// Tables show members as bodies: their names must be new.
void validate_members(const Scene& scene, std::span<const Description* const> bodies,
                      const Document& document) {
  std::map<std::string, std::string> owner;  // name in tables to body
  for (const Description* body : bodies) {
    if (body != nullptr && body->members.empty()) owner.emplace(body->name, body->name);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i] == nullptr) continue;
    for (const Member& member : bodies[i]->members) {
      const auto [entry, fresh] = owner.emplace(member.name, bodies[i]->name);
      if (!fresh)
        throw InputError(fmt::format("holds a bar {}, a name that body {} has as well in tables",
                                     member.name, entry->second),
                         document.where("bodies." + scene.bodies[i].first),
                         "Rename the other body, or run the two in scenes of their own.");
    }
  }
}

}  // namespace

void validate_bodies(const Scene& scene, std::span<const Description* const> bodies,
                     const Document& document) {
  ABUT_ASSERT(bodies.size() == scene.bodies.size());
  InputErrors errors;
  errors.gather([&] { validate_members(scene, bodies, document); });
  errors.gather([&] { check_steps(scene, bodies, document); });
  errors.gather([&] { validate_ends_used_once(scene, bodies, document); });
  errors.gather([&] { validate_everything(scene, bodies, document); });
  for (const auto& entry : scene.interfaces)
    errors.gather([&] { validate_geometry(entry.second, scene, bodies, document); });
  const auto silent = [](const Description* body) {
    return body != nullptr && body->fields.empty();
  };
  if (scene.output.field_output && std::all_of(bodies.begin(), bodies.end(), silent))
    errors.add({"asks for fields, but no body of the scene has any",
                document.where("output.fields"), "Leave out output.fields."});
  errors.raise();
}

}  // namespace abut
