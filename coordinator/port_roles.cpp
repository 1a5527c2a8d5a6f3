#include "coordinator/port_roles.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/yaml_resolved.hpp"
#include "coordinator/solver_processes.hpp"
#include "subdomain_solver/make/read_body.hpp"

namespace abut {

namespace {

std::string path_of(const std::string& body) { return "bodies." + body; }

/// How a body steps, as far as bodies that share a node need it to be the same.
struct Stepping {
  bool in_kicks = false;  // explicit
  double step = 0.0;      // [s]
  bool own = false;       // it may take a step below the scene's
};

std::optional<Stepping> stepping_of(const BodySpec& spec) {
  if (!spec.integrator) return std::nullopt;
  Stepping out;
  out.step = std::visit([](const auto& scheme) { return scheme.step; }, *spec.integrator);
  out.in_kicks = spec.integrates(SchemeKind::explicit_steps);
  const auto clamps = [](const auto& scheme) {
    if constexpr (requires { scheme.clamp; }) return scheme.clamp;
    return false;
  };
  out.own = std::visit(clamps, *spec.integrator) && !spec.is_bar();
  return out;
}

bool step_alike(const Stepping& a, const Stepping& b) {
  return a.in_kicks == b.in_kicks && a.step == b.step && !a.own && !b.own;
}

using BodyPair = std::array<std::size_t, 2>;

/// All bodies that hang together, by pairs, with a pair that is not alike.
template <class Alike>
std::set<std::size_t> unlike_bodies(std::size_t count, const std::vector<BodyPair>& pairs,
                                    Alike alike) {
  std::vector<std::size_t> towards(count);  // the first known of a body's group
  std::iota(towards.begin(), towards.end(), 0);
  const auto first_of = [&towards](std::size_t body) {
    while (towards[body] != body) body = towards[body];
    return body;
  };
  for (const auto& [a, b] : pairs) towards[first_of(a)] = first_of(b);
  std::set<std::size_t> groups, bodies;
  for (const auto& [a, b] : pairs)
    if (!alike(a, b)) groups.insert(first_of(a));
  for (std::size_t body = 0; body < count; ++body)
    if (groups.contains(first_of(body))) bodies.insert(body);
  return bodies;
}

/// An end of an interface: number of the body and name of its port.
struct End {
  std::size_t body = 0;
  std::string port;
};

class RoleReader {
 public:
  RoleReader(Scene& scene, const Document& document, bool elsewhere)
      : scene_(scene), document_(document), elsewhere_(elsewhere) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) number_[scene.bodies[b].first] = b;
  }
  void assign();

 private:
  std::optional<std::array<End, 2>> ends_of(const InterfaceSpec& interface) const;
  const BodySpec* spec(std::size_t body);
  bool has_tied_node(const End& end);
  bool share_node(const std::array<End, 2>& ends);
  std::string scheme_of(std::size_t body);
  void compare_bodies();
  void add_partner(const InterfaceSpec& interface, const End& own, const End& other, bool first);
  std::uint64_t digest_for(const BodyEntry& reader, std::size_t body);
  PortRole& role(const End& end);

  Scene& scene_;
  const Document& document_;
  bool elsewhere_;  // wherever they live, bodies may read meshes on other machines
  std::map<std::string, std::size_t> number_;             // of bodies by name
  std::map<std::size_t, std::optional<BodySpec>> specs_;  // that were asked for
  std::set<std::size_t> row_apart_, net_unlike_;  // bodies of rows of shared nodes; of nets of ties
  std::set<std::pair<std::size_t, std::string>> sharing_;  // ends that share their nodes
};

/// Nothing: the scene's own rules refuse the interface.
std::optional<std::array<End, 2>> RoleReader::ends_of(const InterfaceSpec& interface) const {
  std::array<End, 2> ends;
  for (const std::size_t s : {0u, 1u}) {
    const PortName name = split_port(interface.sides[s]);
    const auto body = number_.find(name.body);
    if (body == number_.end() || name.port.empty()) return std::nullopt;
    ends[s] = {body->second, name.port};
  }
  return ends;
}

/// Null: of another program, or its keys are wrong.
const BodySpec* RoleReader::spec(std::size_t body) {
  const auto [entry, fresh] = specs_.try_emplace(body);
  if (fresh && !scene_.bodies[body].second.external)
    entry->second = read_keys(document_, path_of(scene_.bodies[body].first));
  return entry->second ? &*entry->second : nullptr;
}

bool RoleReader::has_tied_node(const End& end) {
  const BodySpec* body = spec(end.body);
  if (body == nullptr) return false;
  for (const auto& [name, port] : body->ports)
    if (name == end.port) return port.tied;
  return false;
}

bool RoleReader::share_node(const std::array<End, 2>& ends) {
  return std::ranges::all_of(ends, [this](const End& end) {
    return has_tied_node(end) && stepping_of(*spec(end.body)).has_value();
  });
}

/// In the scene's words, with all its numbers; of bodies that tell none another one than any.
std::string RoleReader::scheme_of(std::size_t body) {
  struct Scheme {
    std::optional<BodySpec::Integrator> integrator;
    void fields(Fields& f) { f.choice("integrator", integrator, "in time"); }
  };
  const BodySpec* own = spec(body);
  return own != nullptr && own->integrator ? to_yaml(Scheme{own->integrator}) : std::string();
}

/// Which bodies hang together by ties, and whether they integrate alike.
void RoleReader::compare_bodies() {
  std::vector<BodyPair> rows, nets;
  for (const auto& [name, interface] : scene_.interfaces) {
    const std::optional<std::array<End, 2>> ends = ends_of(interface);
    if (!interface.tied || !ends) continue;
    nets.push_back({(*ends)[0].body, (*ends)[1].body});
    if (!share_node(*ends)) continue;
    rows.push_back(nets.back());
    for (const End& end : *ends) sharing_.emplace(end.body, end.port);
  }
  const std::size_t count = scene_.bodies.size();
  row_apart_ = unlike_bodies(count, rows, [this](std::size_t a, std::size_t b) {
    return step_alike(*stepping_of(*spec(a)), *stepping_of(*spec(b)));
  });
  net_unlike_ = unlike_bodies(
      count, nets, [this](std::size_t a, std::size_t b) { return scheme_of(a) == scheme_of(b); });
}

/// Of a body's mesh, for one that may read it on another machine, from a file of the same name.
std::uint64_t RoleReader::digest_for(const BodyEntry& reader, std::size_t body) {
  if (!elsewhere_ && !may_run_elsewhere(reader)) return 0;
  const BodySpec* own = spec(body);
  return own != nullptr ? mesh_digest(*own, document_) : 0;
}

PortRole& RoleReader::role(const End& end) {
  std::vector<PortRole>& ports = scene_.bodies[end.body].second.context.ports;
  const auto known = std::ranges::find(ports, end.port, &PortRole::port);
  if (known != ports.end()) return *known;
  return ports.emplace_back(PortRole{.port = end.port, .partners = {}});
}

void RoleReader::add_partner(const InterfaceSpec& interface, const End& own, const End& other,
                             bool first) {
  const BodyEntry& its = scene_.bodies[other.body].second;
  PortPartner partner;
  partner.interface = interface.name;
  partner.body = scene_.bodies[other.body].first;
  partner.port = other.port;
  partner.tied = interface.tied.has_value();
  partner.external = its.external;
  if (interface.contact) {
    partner.points = interface.contact->points;
    const auto* how = std::get_if<UnilateralTransmission>(&interface.transmission);
    partner.finds = how != nullptr && how->kinematic == partner.body + "." + partner.port;
  }
  if (partner.tied && interface.tied->overlap) {
    const OverlapSpec& overlap = *interface.tied->overlap;
    partner.overlap =
        OverlapRole{first, !overlap.doubled && !overlap.motions, overlap.motions, overlap.unstable};
  }
  const bool onto = interface.contact && scene_.bodies[own.body].second.adjusts;
  if (const BodySpec* keys = partner.overlap || onto ? spec(other.body) : nullptr) {
    ResolvedYaml text;
    text.add(path_of(partner.body), *keys);
    partner.keys = text.text();
    partner.mesh_digest = digest_for(scene_.bodies[own.body].second, other.body);
  }
  role(own).partners.push_back(std::move(partner));
}

void RoleReader::assign() {
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    BodyEntry& entry = scene_.bodies[b].second;
    entry.context = {};
    entry.context.others_touch = scene_.everything() != nullptr;
    const std::string initial = path_of(scene_.bodies[b].first) + ".initial.";
    const bool says =
        std::ranges::any_of(std::array{"adjust", "interference", "after_statics"},
                            [&](const char* key) { return document_.has(initial + key); });
    const BodySpec* own = says ? spec(b) : nullptr;
    entry.adjusts = own != nullptr && own->initial.adjust;
    entry.fits = own != nullptr && own->initial.interference;
    entry.stood = own != nullptr && own->initial.after_statics;
    entry.context.mesh_digest = digest_for(entry, b);
  }
  compare_bodies();
  for (const auto& [name, interface] : scene_.interfaces) {
    const std::optional<std::array<End, 2>> ends = ends_of(interface);
    if (!ends) continue;
    for (const std::size_t s : {0u, 1u}) add_partner(interface, (*ends)[s], (*ends)[1 - s], s == 0);
  }
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    for (PortRole& port : scene_.bodies[b].second.context.ports) {
      const auto is_tied = [](const PortPartner& partner) { return partner.tied; };
      port.tied = std::ranges::any_of(port.partners, is_tied);
      port.touches = !std::ranges::all_of(port.partners, is_tied) ||
                     (scene_.everything() != nullptr && !port.tied);
      if (!port.tied) continue;
      if (sharing_.contains({b, port.port})) {
        port.alike = !row_apart_.contains(b);
      } else if (!has_tied_node({b, port.port})) {
        port.alike = !net_unlike_.contains(b);
      }
    }
  }
}

}  // namespace

void assign_roles(Scene& scene, const Document& document, bool elsewhere) {
  RoleReader(scene, document, elsewhere).assign();
}

}  // namespace abut
