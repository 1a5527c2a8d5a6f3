#include "coordinator/touching_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/parts_of_ports.hpp"
#include "coordinator/coupling/tie.hpp"
#include "coordinator/coupling/tied_wholes.hpp"
#include "coordinator/coupling/watch.hpp"

namespace abut {

bool only_passive(const Joint& joint, const Bodies& bodies) {
  // Ends of bars that keep their mass know no kernel: they meet in the published form.
  const bool surfaces = bodies.port(joint.sides[0]).geometry.dim > 1;
  return std::ranges::all_of(joint.sides, [&bodies, surfaces](const Side& side) {
    const Capabilities& can = bodies.describe(side.body).can;
    return can.passive && !can.obstacle && !bodies.port(side).tied && (surfaces || can.kernel);
  });
}

void require_spacing(const Joint& joint, const Bodies& bodies, const std::string& where) {
  const auto told = [&bodies](const Side& side) {
    return bodies.port(side).geometry.spacing > 0.0;
  };
  if (std::ranges::any_of(joint.sides, told)) return;
  throw InputError(
      "joins points that meet passively, of which neither tells the spacing of what "
      "is behind it",
      where, "Let the program of one of them tell one, as the length of its body.");
}

namespace {

/// Surfaces of all bodies, where everything may touch everything.
void add_everything(const ContactSpec& law, std::span<const Joint> joints, const Bodies& bodies,
                    std::vector<TouchingPair>& pairs) {
  const std::vector<int> wholes = tied_wholes(joints, bodies.count());
  std::vector<Side> sides;
  for (int b = 0; b < bodies.count(); ++b) {
    const std::vector<bool> parts = parts_of_others(bodies.describe(b));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Port& port = bodies.describe(b).ports[p];
      if (!port.tied && !port.geometry.facets.empty() && !parts[p])
        sides.push_back({b, static_cast<int>(p)});
    }
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      const Side &one = sides[i], &other = sides[j];
      const bool stand = std::isinf(bodies.describe(one.body).mass) &&
                         std::isinf(bodies.describe(other.body).mass);
      const bool written = std::ranges::any_of(pairs, [&](const TouchingPair& pair) {
        const auto is = [](const Side& a, const Side& b) {
          return a.body == b.body && a.port == b.port;
        };
        return (is(pair.sides[0], one) && is(pair.sides[1], other)) ||
               (is(pair.sides[1], one) && is(pair.sides[0], other));
      });
      if (wholes[index(one.body)] != wholes[index(other.body)] && !stand && !written)
        pairs.push_back({{one, other}, sliding(law), law.restitution.value_or(0.0), holding(law)});
    }
  }
}

/// Ports of a body whose strains are finite: others bend too little to come upon themselves.
std::vector<Side> folding_ports(int body, const Bodies& bodies) {
  const Description& of = bodies.describe(body);
  std::vector<Side> sides;
  if (of.dim == 1 || of.linear || !of.can.passive || std::isinf(of.mass)) return sides;
  for (std::size_t p = 0; p < of.ports.size(); ++p) {
    const PortGeometry& geometry = of.ports[p].geometry;
    if (!geometry.facets.empty() && geometry.transit > 0.0)
      sides.push_back({body, static_cast<int>(p)});
  }
  return sides;
}

/// Whether two ports of a body have a node in common: features there would touch from the start.
bool share_a_node(const PortGeometry& one, const PortGeometry& other) {
  const auto nodes = [](const PortGeometry& of) {
    std::vector<std::array<double, 3>> all(index(of.count()));
    for (std::size_t v = 0; v < of.points.size(); ++v)
      all[v / index(of.dim)][v % index(of.dim)] = of.points[v];
    std::ranges::sort(all);
    return all;
  };
  const std::vector<std::array<double, 3>> a = nodes(one), b = nodes(other);
  return std::ranges::any_of(a, [&b](const auto& x) { return std::ranges::binary_search(b, x); });
}

/// Surfaces of bodies that may touch themselves.
void add_own(double friction, const Bodies& bodies, std::vector<TouchingPair>& pairs) {
  int dim = pairs.empty() ? 0 : bodies.port(pairs.front().sides[0]).geometry.dim;
  for (int b = 0; b < bodies.count(); ++b) {
    const std::vector<Side> sides = folding_ports(b, bodies);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const PortGeometry& one = bodies.port(sides[i]).geometry;
      if (dim == 0) dim = one.dim;
      if (one.dim != dim) continue;
      for (std::size_t j = i; j < sides.size(); ++j)
        if (i == j || !share_a_node(one, bodies.port(sides[j]).geometry))
          pairs.push_back({{sides[i], sides[j]}, friction});
    }
  }
}

}  // namespace

std::vector<TouchingPair> touching_pairs(const Scene& scene, std::span<const Joint> joints,
                                         const Bodies& bodies) {
  std::vector<TouchingPair> pairs;
  const bool published = std::ranges::any_of(
      joints, [](const Joint& joint) { return joint.watch->decision() == Decision::window_begin; });
  if (published) return pairs;  // what was published knows no other way
  for (const Joint& joint : joints) {
    if (joint.exchange == nullptr || joint.tied()) continue;
    const InterfaceSpec& spec = scene.interfaces[index(joint.interface)].second;
    const ContactSpec law = spec.contact.value_or(ContactSpec());
    pairs.push_back({joint.sides, sliding(law), law.restitution.value_or(0.0), holding(law)});
  }
  if (scene.everything() != nullptr) add_everything(*scene.everything(), joints, bodies, pairs);
  if (const std::optional<double> friction = scene.own_friction())
    add_own(*friction, bodies, pairs);
  return pairs;
}

std::optional<std::vector<PassiveTie>> passive_ties(const Scene& scene,
                                                    std::span<const Joint> joints,
                                                    const Bodies& bodies) {
  std::vector<PassiveTie> ties;
  const std::vector<bool> share = share_nodes(joints);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Joint& joint = joints[j];
    if (!joint.tied()) continue;
    const InterfaceSpec& spec = scene.interfaces[index(joint.interface)].second;
    if (share[j] && is_unilateral(spec.transmission)) {
      ties.push_back({.sides = joint.sides,
                      .node = make_tie_rows(bodies.port(joint.sides[0]).geometry,
                                            bodies.port(joint.sides[1]).geometry, 0),
                      .kinematic = joint.role.kinematic});
      continue;
    }
    KnownExchanges known;
    joint.exchange->enter(joint, j, known);
    const bool plain = known.ties.size() == 1 && spec.tied && !spec.tied->overlap &&
                       !is_dashpot(spec.transmission);
    if (!plain) return std::nullopt;
    ties.push_back({.sides = joint.sides,
                    .tie = known.ties.front().exchange,
                    .node = {},
                    .kinematic = joint.role.kinematic});
  }
  return ties;
}

}  // namespace abut
