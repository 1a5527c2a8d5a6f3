#include "coordinator/everything.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/input_errors.hpp"
#include "coordinator/coupling/parts_of_ports.hpp"

namespace abut {

namespace {

/// A facet of two ports would touch twice, but for ports that are parts of other ones.
void require_single_facets(const Description& body, const Document& document) {
  if (body.ports.size() < 2) return;
  std::map<std::vector<double>, std::string> ports;  // by a facet of theirs
  const std::vector<bool> parts = parts_of_others(body);
  for (std::size_t p = 0; p < body.ports.size(); ++p) {
    const Port& port = body.ports[p];
    if (parts[p]) continue;
    for (std::size_t f = 0; f + 1 < port.geometry.offsets.size(); ++f) {
      const auto [entry, fresh] = ports.emplace(places_of_facet(port.geometry, f), port.name);
      if (fresh) continue;
      throw InputError(
          fmt::format("has the ports {} and {}, which share a facet: everything would touch it "
                      "twice",
                      entry->second, port.name),
          document.where(fmt::format("bodies.{}.ports", body.name)),
          "Leave one of them out, or write interfaces in place of contact.everything.");
    }
  }
}

void validate_body(const Description& body, const Document& document) {
  const std::string where = document.where("bodies." + body.name);
  if (body.dim == 1)
    throw InputError("is a bar, and contact.everything is of surfaces", where,
                     "Write the interfaces of bars one by one under interfaces.");
  const bool touches = std::ranges::any_of(
      body.ports, [](const Port& port) { return !port.geometry.facets.empty(); });
  if (!touches)
    throw InputError("has no port with a surface, so nothing could touch it", where,
                     "Give it one under ports, or write interfaces in place of "
                     "contact.everything.");
  for (const Port& port : body.ports)
    if (port.tied)
      throw InputError(fmt::format("has the port {} for tied interfaces", port.name), where,
                       "Take tied off the port.");
  require_single_facets(body, document);
}

/// One of two that touch has to find out where, or both have passive forms.
void require_finders(std::span<const Description* const> bodies, const Document& document) {
  const Description *moved = nullptr, *other = nullptr;
  for (const Description* body : bodies) {
    if (body == nullptr || body->can.obstacle || body->can.passive) continue;
    const Description*& place = moved == nullptr && std::isfinite(body->mass) ? moved : other;
    place = body;
  }
  if (moved == nullptr || other == nullptr) return;
  throw InputError(
      fmt::format("lets {} ({}) meet {} ({}), of which neither can find contact on its surface",
                  moved->name, moved->model, other->name, other->model),
      document.where(std::string(everything_path)),
      "Model one of them as fe, integrated in time, or write interfaces one by one.");
}

void require_friction(const ContactSpec& law, std::span<const Description* const> bodies,
                      const Document& document) {
  if (!law.friction.rubs()) return;
  for (const Description* body : bodies) {
    if (body == nullptr || !body->can.obstacle || body->can.friction) continue;
    throw InputError(
        fmt::format("has friction, but {} ({}) finds contact without", body->name, body->model),
        document.where(std::string(everything_path)),
        "Leave friction out, or write interfaces one by one.");
  }
}

void require_rigid(const ContactSpec& law, std::span<const Description* const> bodies,
                   const Document& document) {
  if (!law.restitution) return;
  int rigid = 0;
  for (const Description* body : bodies) {
    if (body == nullptr) return;
    const bool stiff = std::ranges::any_of(body->ports, [](const Port& port) {
      return port.geometry.dim > 1 && !(port.geometry.transit > 0.0);
    });
    if (stiff) ++rigid;
  }
  if (rigid > 1) return;
  throw InputError("has no effect: no two bodies are rigid, and what deforms bounces by itself",
                   document.where(std::string(everything_path) + ".restitution"), "Leave it out.");
}

/// Surfaces of one kind: flat ones beside rings only where nothing moves them.
void require_one_kind(std::span<const Description* const> bodies, const Document& document) {
  const Description* first = nullptr;
  for (const Description* body : bodies) {
    if (body == nullptr || body->ports.empty()) continue;
    const auto kind = [](const Description& of) {
      return std::pair(of.dim, of.ports.front().geometry.round);
    };
    if (first == nullptr && std::isfinite(body->mass)) first = body;
    if (first == nullptr || kind(*first) == kind(*body)) continue;
    if (first->dim == body->dim && std::isinf(body->mass)) continue;
    throw InputError(fmt::format("has surfaces of another kind than those of {}: {}D{} and {}D{}",
                                 first->name, body->dim, kind(*body).second ? " round an axis" : "",
                                 first->dim, kind(*first).second ? " round an axis" : ""),
                     document.where("bodies." + body->name),
                     "Give all bodies one dimension and one plane.");
  }
}

bool any_folds(std::span<const Description* const> bodies) {
  return std::ranges::any_of(bodies, [](const Description* body) {
    return body != nullptr && body->dim > 1 && !body->linear && body->can.passive &&
           std::ranges::any_of(body->ports,
                               [](const Port& port) { return !port.geometry.facets.empty(); });
  });
}

/// Whether the law is that of a body with itself, as of one that folds.
bool meets_itself(const Scene& scene, std::span<const Description* const> bodies) {
  return scene.own_friction() && any_folds(bodies);
}

/// Contact of bodies with themselves alone: said, and of a body that can come upon itself.
void validate_self(const Scene& scene, std::span<const Description* const> bodies,
                   const Document& document) {
  if (!document.has("contact.self") && !document.has("contact.self_friction"))
    throw InputError("is missing", document.where(std::string(everything_path)),
                     "Write contact: {everything: {}}, contact: {self: true}, or leave contact "
                     "out: bodies touch themselves by default.");
  const bool all_known =
      std::ranges::none_of(bodies, [](const Description* body) { return body == nullptr; });
  if (!scene.contact->self || !all_known || any_folds(bodies)) return;
  throw InputError("has no effect: no body that strains finitely has a port with facets",
                   document.where("contact.self"),
                   "Give a body another law than linear_elastic and a port on its surface, as "
                   "ports: {skin: boundary}, or leave it out.");
}

/// Nodes are moved onto partners that a body's specification knows: those of interfaces.
void refuse_adjusted(const Scene& scene, const Document& document) {
  for (const auto& [name, body] : scene.bodies) {
    const auto names_it = [&name](const auto& interface) {
      return !interface.second.tied && std::ranges::any_of(interface.second.sides, [&](auto& side) {
        return split_port(side).body == name;
      });
    };
    if (!body.adjusts || std::ranges::any_of(scene.interfaces, names_it)) continue;
    throw InputError(
        "has no effect: nodes are moved out of surfaces that interfaces name, and "
        "contact.everything names none",
        document.where("bodies." + name + ".initial.adjust"),
        "Write the pair under interfaces, too.");
  }
}

}  // namespace

void validate_everything(const Scene& scene, std::span<const Description* const> bodies,
                         const Document& document) {
  if (scene.contact && scene.everything() == nullptr) validate_self(scene, bodies, document);
  if (scene.everything() == nullptr) return;
  InputErrors errors;
  const std::string where = document.where(std::string(everything_path));
  if (bodies.size() < 2 && !meets_itself(scene, bodies))
    errors.add({"has no effect: the scene has one body", where, "Leave it out."});
  for (const auto& [name, interface] : scene.interfaces)
    if (name == everything_name)
      errors.add({"has the name of contact.everything in what a run tells",
                  document.where("interfaces." + name), "Give it another name."});
  for (const Description* body : bodies)
    if (body != nullptr) errors.gather([&] { validate_body(*body, document); });
  errors.gather([&] { require_finders(bodies, document); });
  errors.gather([&] { refuse_adjusted(scene, document); });
  errors.gather([&] { require_friction(*scene.everything(), bodies, document); });
  errors.gather([&] { require_rigid(*scene.everything(), bodies, document); });
  errors.gather([&] { require_one_kind(bodies, document); });
  errors.raise();
}

}  // namespace abut
