#include "coordinator/couple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "coordinator/coupling/compare/alternating_net.hpp"
#include "coordinator/coupling/compare/parallel_force.hpp"
#include "coordinator/coupling/compare/robin.hpp"
#include "coordinator/coupling/compliant_obstacle.hpp"
#include "coordinator/coupling/dirichlet_neumann.hpp"
#include "coordinator/coupling/line_watch.hpp"
#include "coordinator/coupling/loose_motions.hpp"
#include "coordinator/coupling/roles.hpp"
#include "coordinator/coupling/row_margin.hpp"
#include "coordinator/coupling/support_distance.hpp"
#include "coordinator/coupling/surface_watch.hpp"
#include "coordinator/coupling/unilateral.hpp"
#include "coordinator/surface_start.hpp"
#include "coordinator/surfaces_alone.hpp"
#include "coordinator/tied_outside.hpp"
#include "coordinator/tied_surfaces.hpp"
#include "coordinator/touching_pairs.hpp"
#include "coordinator/wanted_fit.hpp"

namespace abut {

namespace {

Side find_side(const std::string& text, const Bodies& bodies, const std::string& where) {
  const std::size_t dot = text.find('.');
  for (int b = 0; b < bodies.count() && dot != std::string::npos; ++b) {
    const Description& body = bodies.describe(b);
    if (body.name != text.substr(0, dot)) continue;
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      if (body.ports[p].name == text.substr(dot + 1)) return {b, static_cast<int>(p)};
    }
  }
  throw InputError(fmt::format("'{}' is no port of any body", text), where, "Give body.port.");
}

int index_of(const InterfaceSpec& spec, const std::string& side, const std::string& where) {
  for (int s : {0, 1}) {
    if (spec.sides[s] == side) return s;
  }
  throw InputError(fmt::format("'{}' is not a side of this interface", side), where,
                   fmt::format("Give {} or {}.", spec.sides[0], spec.sides[1]));
}

void require(bool able, const Description& body, const std::string& where, const std::string& what,
             const std::string& remedy) {
  if (!able) {
    throw InputError(fmt::format("body '{}' ({}) {}", body.name, body.model, what), where, remedy);
  }
}

/// A node whose mass both sides share has one motion only where both step alike: at other steps
/// roundings of the partner's path become accelerations that grow.
void check_shared_node(const InterfaceSpec& spec, const Bodies& bodies, const Joint& joint) {
  const Description& a = bodies.describe(joint.sides[0].body);
  const Description& b = bodies.describe(joint.sides[1].body);
  const bool shared[] = {bodies.port(joint.sides[0]).tied, bodies.port(joint.sides[1]).tied};
  if (!shared[0] && !shared[1]) return;
  const bool held = std::isinf(a.mass) || std::isinf(b.mass);
  const bool alike = a.step == b.step && std::isinf(a.stable_step) == std::isinf(b.stable_step);
  if (held || (shared[0] && shared[1] && alike)) return;
  if (shared[0] && shared[1]) {  // of our own bodies the scene has told: they are tied by a force
    throw InputError(
        fmt::format("shares a node between '{}' ({}) and '{}' ({}), which step apart", a.name,
                    a.model, b.name, b.model),
        "interfaces." + spec.name + ".sides",
        "Give both bodies one step and one kind of scheme, or take tied off both ports and give "
        "contact_layer: {massless: {stiffness_factor: 1}}.");
  }
  throw InputError(
      "joins a port with tied: true to one of another kind of node",
      "interfaces." + spec.name + ".sides",
      "Make both ports tied: true, or take tied off both and give contact_layer: {massless: "
      "{stiffness_factor: 1}}.");
}

/// Sides of a tied interface are one as they stand: the rounding of their places is no gap.
void tie(const InterfaceSpec& spec, const Bodies& bodies, Joint& joint) {
  if (spec.tied->finer) {
    throw InputError("is of surfaces: ends of bars choose by themselves",
                     "interfaces." + spec.name + ".tied.steps", "Leave steps out.");
  }
  if (spec.tied->overlap) {
    throw InputError("is of bodies in two and three dimensions",
                     "interfaces." + spec.name + ".tied.overlap",
                     "Leave overlap out, and let the ends of the bars meet.");
  }
  joint.watch = std::make_unique<SharedNodeWatch>();
  const double spacing = std::max(bodies.port(joint.sides[0]).geometry.spacing,
                                  bodies.port(joint.sides[1]).geometry.spacing);
  if (joint.line.reference_gap > coincidence * spacing) {
    throw InputError(fmt::format("its sides are {:g} m apart", joint.line.reference_gap),
                     "interfaces." + spec.name + ".tied",
                     "Move a body with initial.position until they coincide.");
  }
  joint.line.reference_gap = 0.0;
  check_shared_node(spec, bodies, joint);
}

void refuse_tied_ports(const InterfaceSpec& spec, const Bodies& bodies, const Joint& joint) {
  for (const Side& side : joint.sides) {
    const Port& port = bodies.port(side);
    if (!port.tied) continue;
    throw InputError(fmt::format("port '{}' of body '{}' is for tied interfaces", port.name,
                                 bodies.describe(side.body).name),
                     "interfaces." + spec.name + ".contact",
                     "Give the interface tied: {}, or take tied off the port.");
  }
}

void set_unilateral(const InterfaceSpec& spec, const UnilateralTransmission& how,
                    const SchwarzSpec& schwarz, const Bodies& bodies, Joint& joint) {
  const std::string where = "interfaces." + spec.name;
  if (how.kernel_memory) {
    throw InputError("is of surfaces: the kernel of the end of a bar is a few numbers",
                     where + ".transmission.unilateral.kernel_memory", "Leave it out.");
  }
  for (const Side& side : joint.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.can.force && (body.can.kernel || !body.can.motion), body, where,
            "cannot stand on a unilateral interface: its contact layer is massive",
            "Give the body contact_layer massless or kick, or the interface the transmission "
            "dirichlet_neumann.");
    require(body.can.kernel, body, where, "does not answer for its port kernel",
            "Use a body that offers the kernel.");
  }
  const Description& one = bodies.describe(joint.sides[0].body);
  const Description& other = bodies.describe(joint.sides[1].body);
  const bool moves = std::isfinite(one.mass) || std::isfinite(other.mass);
  const bool passive = moves && only_passive(joint, bodies);
  if (passive) require_spacing(joint, bodies, where);
  if (!one.can.obstacle && !other.can.obstacle && !passive) {
    throw InputError(
        fmt::format(
            "joins '{}' ({}) and '{}' ({}), of which neither can follow the other's surface "
            "yet",
            one.name, one.model, other.name, other.model),
        where, "Make one side a bar of model fe whose ports are not tied.");
  }
  joint.role.fixed = how.kinematic != "auto";
  if (joint.role.fixed) {
    joint.role.kinematic =
        index_of(spec, how.kinematic, where + ".transmission.unilateral.kinematic");
    const Description& body = bodies.describe(joint.kinematic_side().body);
    require(body.can.obstacle, body, where + ".transmission.unilateral.kinematic",
            "takes forces only and cannot be the kinematic side", "Name the other side, or auto.");
  }
  // Trials need kernels: who chooses another accelerator wants to see what that does.
  const bool kernels = std::holds_alternative<KernelAcceleration>(schwarz.accelerator);
  constexpr double never = std::numeric_limits<double>::infinity();
  if (schwarz.parallel) {
    joint.exchange = std::make_unique<ParallelForce>(kernels);
  } else {
    joint.exchange = std::make_unique<Unilateral>(kernels ? schwarz.tolerance : never);
  }
}

/// Forces on rings are of all around; only what does not move of itself has no thickness.
void refuse_flat_beside_round(const Joint& joint, const Bodies& bodies, const std::string& where) {
  for (const int s : {0, 1}) {
    const Side &round = joint.sides[s], &flat = joint.sides[1 - s];
    if (!bodies.port(round).geometry.round || bodies.port(flat).geometry.round) continue;
    const Description& other = bodies.describe(flat.body);
    require(std::isinf(other.mass), other, where,
            fmt::format("is plane, but '{}' is axisymmetric", bodies.describe(round.body).name),
            "Give both bodies plane: axisymmetric, or use a rigid_tool.");
  }
}

/// Bodies that are surfaces to each other.
void set_surfaces(const InterfaceSpec& spec, const std::string& where, const Scene& scene,
                  const Bodies& bodies, Joint& joint) {
  const auto* how = std::get_if<UnilateralTransmission>(&spec.transmission);
  if (how == nullptr) {
    throw InputError("is of ends of bars only: surfaces know the transmission unilateral",
                     where + ".transmission", "Leave transmission out.");
  }
  for (const Side& side : joint.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.can.force, body, where, "takes no forces", "Use a body that does.");
  }
  const Description& one = bodies.describe(joint.sides[0].body);
  const Description& other = bodies.describe(joint.sides[1].body);
  const bool moves = std::isfinite(one.mass) || std::isfinite(other.mass);
  const bool passive = moves && one.can.passive && other.can.passive;
  if (!one.can.obstacle && !other.can.obstacle && !passive) {
    throw InputError(fmt::format("joins '{}' ({}) and '{}' ({}), of which neither can find contact "
                                 "on its surface",
                                 one.name, one.model, other.name, other.model),
                     where,
                     "Make one of them a body of model fe, in the plane or in space, integrated in "
                     "time.");
  }
  refuse_flat_beside_round(joint, bodies, where);
  joint.role.fixed = how->kinematic != "auto";
  if (joint.role.fixed) {
    joint.role.kinematic =
        index_of(spec, how->kinematic, where + ".transmission.unilateral.kinematic");
    const Description& body = bodies.describe(joint.kinematic_side().body);
    require(body.can.obstacle, body, where + ".transmission.unilateral.kinematic",
            "takes forces only and cannot be the kinematic side", "Name the other side, or auto.");
  }
  const int finder = contact_finder(joint, bodies);
  const ContactLaw law{.points = spec.contact->points, .friction = spec.contact->friction};
  if (law.points && scene.bodies[joint.sides[finder].body].second.external) {
    throw InputError(
        fmt::format("is point_to_surface, but {} finds the contact, and has rows of its "
                    "own program",
                    spec.sides[finder]),
        where + ".contact.rows", "Leave rows out.");
  }
  if (law.friction.rubs() && !only_passive(joint, bodies)) {
    const Description& body = bodies.describe(joint.sides[finder].body);
    require(body.can.friction, body, where + ".contact.friction",
            "finds the contact and takes no friction",
            "Leave friction out, or let the other side find contact by "
            "transmission.unilateral.kinematic.");
  }
  const double margin = row_margin(joint.sides, bodies);
  joint.watch = std::make_unique<SurfaceWatch>(margin, law.friction.rubs());
  joint.exchange = std::make_unique<CompliantObstacle>(
      how->kernel_memory.value_or(usual_kernel_memory) * 1048576.0, margin, law);
}

/// What no contact can start from. Averages that overlap begin with a blow, in windows that bodies
/// with passive forms pass passively.
void check_start(const InterfaceSpec& spec, const std::string& where, const Joint& joint,
                 const Scene& scene, const Bodies& bodies) {
  const bool meant = joint.fit > 0.0;
  const bool averages = !meant && (scene.schwarz.on_nonconvergence != OnNonconvergence::passive ||
                                   std::ranges::any_of(joint.sides, [&bodies](const Side& side) {
                                     return !bodies.describe(side.body).can.passive;
                                   }));
  std::array<std::optional<PortGeometry>, 2> outsides;
  for (const std::size_t s : {0u, 1u}) outsides[s] = tied_outside(scene, joint.sides[s], bodies);
  const auto side = [&](int s) {
    const Side& of = joint.sides[index(s)];
    NamedSurface named = named_surface(spec.sides[index(s)], bodies.describe(of.body), of.port);
    if (outsides[index(s)]) named.outside = &*outsides[index(s)];
    return named;
  };
  const int finder = contact_finder(joint, bodies);
  if (only_passive(joint, bodies)) {
    check_apart(side(0), side(1), meant, where + ".sides");
  } else if (spec.contact->points) {
    check_points(side(finder), side(1 - finder), meant, where);
  } else {
    check_surfaces(side(finder), side(1 - finder), averages, meant, where + ".sides");
  }
}

void set_published(const InterfaceSpec& spec, const DirichletNeumannTransmission& how,
                   const SchwarzSpec& schwarz, const Bodies& bodies, Joint& joint) {
  const std::string where = "interfaces." + spec.name + ".transmission.dirichlet_neumann";
  joint.role.kinematic = index_of(spec, how.dirichlet, where + ".dirichlet");
  for (int s : {0, 1}) {
    if (s != joint.role.kinematic && !how.swap_every_window) continue;
    const Description& body = bodies.describe(joint.sides[s].body);
    require(body.can.motion, body, where, "does not take prescribed motion",
            "Give the body contact_layer: {massive: {}}.");
  }
  if (schwarz.parallel || std::holds_alternative<KernelAcceleration>(schwarz.accelerator)) {
    throw InputError(
        "the published form knows neither the parallel form nor port kernels", "schwarz",
        "Give form: alternating and an accelerator of none, relaxation, aitken or anderson.");
  }
  joint.exchange = std::make_unique<DirichletNeumann>(how.swap_every_window);
  joint.role.fixed = true;
  if (joint.tied()) {
    joint.watch = std::make_unique<SharedNodeWatch>(how.swap_every_window);
  } else {
    joint.watch = std::make_unique<PublishedWatch>(how.swap_every_window, how.impact_projection);
  }
}

/// Ports of a body that solves its contact itself show it and take nothing.
void refuse_members(const Joint& joint, const Bodies& bodies, const std::string& where) {
  for (const Side& side : joint.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.members.empty(), body, where, "solves its contact itself and takes nothing",
            "Join its two ports with transmission: {internal: {}}, or use single bars.");
  }
}

void set_robin(const InterfaceSpec& spec, const RobinTransmission& how, const SchwarzSpec& schwarz,
               const Bodies& bodies, Joint& joint) {
  const std::string where = "interfaces." + spec.name + ".transmission.robin";
  for (const Side& side : joint.sides) {
    const Description& body = bodies.describe(side.body);
    require(body.can.impedance && body.can.kernel, body, where, "does not take an impedance",
            "Give a bar contact_layer massless or kick, or the interface the transmission "
            "unilateral.");
  }
  if (std::holds_alternative<KernelAcceleration>(schwarz.accelerator)) {
    throw InputError("Robin conditions do not use port kernels as Jacobian", "schwarz.accelerator",
                     "Give an accelerator of none, relaxation, aitken or anderson.");
  }
  joint.role.kinematic = coarser_side(joint, bodies);
  joint.role.fixed = true;
  const Robin::Rule rule = how.impedance == "matched"  ? Robin::Rule::matched
                           : how.impedance == "kernel" ? Robin::Rule::kernel
                                                       : Robin::Rule::given;
  joint.exchange = std::make_unique<Robin>(rule, how.number, schwarz.parallel);
}

void see_starts(const Scene& scene, Joint& joint) {
  for (const int s : {0, 1})
    if (scene.bodies[joint.sides[index(s)].body].second.adjusts) joint.role.adjusted = s;
  for (const int s : {0, 1})
    if (scene.bodies[joint.sides[index(s)].body].second.fits) joint.role.fitted = s;
}

/// A pair of a scene where everything may touch everything, as if the scene wrote it.
InterfaceSpec spec_of(const Scene& scene, const PortPair& pair, const Bodies& bodies) {
  InterfaceSpec spec;
  for (const std::size_t s : {0u, 1u})
    spec.sides[s] = bodies.describe(pair[s].body).name + "." + bodies.port(pair[s]).name;
  spec.name = spec.sides[0] + "-" + spec.sides[1];
  spec.contact = *scene.everything();
  return spec;
}

/// Bodies that would share a node but do not step alike are joined by a force, as they were told.
bool step_apart(const Scene& scene, const std::array<Side, 2>& sides, const Bodies& bodies) {
  return std::ranges::all_of(sides, [&](const Side& side) {
    const Port& port = bodies.port(side);
    return port.tied && !scene.bodies[index(side.body)].second.context.role(port.name).alike;
  });
}

}  // namespace

std::vector<Joint> make_joints(const Scene& scene, Bodies& bodies) {
  turn_surfaces_alone(scene, bodies);
  std::vector<Joint> joints;
  std::vector<Neighbours> pairs;
  for (const auto& [name, spec] : scene.interfaces) {
    const std::string where = "interfaces." + name + ".sides";
    pairs.push_back(
        {{find_side(spec.sides[0], bodies, where), find_side(spec.sides[1], bodies, where)},
         spec.tied.has_value()});
  }
  // What presses when a stage of motion begins goes on with the side that found it, which must be
  // able to in that stage as well.
  if (scene.stages.empty()) bodies.tell_supports(support_distances(pairs, bodies));
  for (const auto& [name, spec] : scene.interfaces) {
    const std::array<Side, 2>& sides = pairs[joints.size()].sides;
    const bool surfaces = bodies.port(sides[0]).geometry.dim > 1 && spec.contact;
    const int number = static_cast<int>(joints.size());
    if (spec.tied && (bodies.port(sides[0]).geometry.dim > 1 || step_apart(scene, sides, bodies))) {
      joints.push_back(make_tied_joint(spec, sides, bodies));
      joints.back().interface = number;
      continue;
    }
    Joint& joint = joints.emplace_back(surfaces ? make_surface_joint(name, sides, bodies)
                                                : make_joint(name, sides, bodies));
    joint.interface = number;
    see_starts(scene, joint);
    if (is_inside(spec.transmission)) {
      joint.watch = std::make_unique<InsideWatch>();
      continue;
    }
    refuse_members(joint, bodies, "interfaces." + name);
    if (spec.tied) {
      tie(spec, bodies, joint);
    } else {
      refuse_tied_ports(spec, bodies, joint);
    }
    if (surfaces) {
      set_surfaces(spec, "interfaces." + name, scene, bodies, joint);
      find_fit(spec.sides, "interfaces." + name, scene, bodies, joint);
      check_start(spec, "interfaces." + name, joint, scene, bodies);
    } else if (const auto* unilateral = std::get_if<UnilateralTransmission>(&spec.transmission)) {
      set_unilateral(spec, *unilateral, scene.schwarz, bodies, joint);
    } else if (const auto* robin = std::get_if<RobinTransmission>(&spec.transmission)) {
      set_robin(spec, *robin, scene.schwarz, bodies, joint);
    } else {
      set_published(spec, std::get<DirichletNeumannTransmission>(spec.transmission), scene.schwarz,
                    bodies, joint);
    }
  }
  check_fits(scene, joints);
  check_supports(joints, bodies);
  check_still_contact(joints, scene.everything() != nullptr, bodies);
  share_out_loose_motions(joints, bodies);
  if (scene.schwarz.ties && known_exchanges(joints).ties.empty()) {
    throw InputError("has no effect: no surfaces are tied", std::string(TieKernelSpec::path),
                     "Leave it out.");
  }
  return joints;
}

Joint make_pair(const Scene& scene, const PortPair& pair, const Bodies& bodies) {
  const InterfaceSpec spec = spec_of(scene, pair, bodies);
  Joint joint = make_surface_joint(spec.name, pair, bodies);
  joint.interface = static_cast<int>(scene.interfaces.size());
  see_starts(scene, joint);
  const std::string where(everything_path);
  refuse_members(joint, bodies, where);
  refuse_tied_ports(spec, bodies, joint);
  set_surfaces(spec, where, scene, bodies, joint);
  find_fit(spec.sides, where, scene, bodies, joint);
  return joint;
}

BroadPhase make_broad_phase(const Scene& scene, std::span<const Joint> joints,
                            const Bodies& bodies) {
  if (scene.everything() == nullptr) return {};
  BroadPhase all(bodies, joints);
  constexpr std::size_t most_told = 5;
  std::vector<InputError> wrong;
  for (const PortPair& pair : all.near_at_start(bodies)) {
    if (wrong.size() == most_told) break;
    try {
      check_start(spec_of(scene, pair, bodies), "", make_pair(scene, pair, bodies), scene, bodies);
    } catch (const InputError& error) {
      wrong.push_back(error);
    }
  }
  if (wrong.empty()) return all;
  std::string text = wrong.front().what_is_wrong;
  for (std::size_t i = 1; i < wrong.size(); ++i) text += "; " + wrong[i].what_is_wrong;
  throw InputError(text, std::string(everything_path), wrong.front().remedy);
}

TieKernelOptions tie_kernel_options(const SchwarzSpec& spec) {
  TieKernelOptions options;
  options.used = std::holds_alternative<KernelAcceleration>(spec.accelerator);
  if (!spec.ties) return options;
  options.memory = spec.ties->memory * 1048576.0;
  options.banded = spec.ties->band != "auto";
  options.rows = spec.ties->rows;
  return options;
}

/// Interfaces have the first joints, one each.
std::vector<int> alternating_joints(const Scene& scene) {
  std::vector<int> joints;
  for (std::size_t j = 0; j < scene.interfaces.size(); ++j) {
    const std::optional<TiedSpec>& tied = scene.interfaces[j].second.tied;
    if (tied && tied->overlap && tied->overlap->alternating) joints.push_back(static_cast<int>(j));
  }
  return joints;
}

Schwarz make_schwarz(const SchwarzSpec& spec, std::vector<int> alternating) {
  struct Maker {
    static Preconditioner by(const RelaxationFactor& factor) {
      return factor.probed() ? Preconditioner::relaxed() : Preconditioner::number(factor.value);
    }
    std::unique_ptr<Accelerator> operator()(const NoAcceleration&) const {
      return std::make_unique<Relaxation>(Preconditioner::number(1.0));
    }
    std::unique_ptr<Accelerator> operator()(const FixedRelaxation& s) const {
      return std::make_unique<Relaxation>(by(s.factor));
    }
    std::unique_ptr<Accelerator> operator()(const AitkenAcceleration& s) const {
      if (s.initial.probed()) return std::make_unique<Aitken>(Preconditioner::relaxed());
      return std::make_unique<Aitken>(Preconditioner::number(1.0), s.initial.value);
    }
    std::unique_ptr<Accelerator> operator()(const AndersonAcceleration& s) const {
      return std::make_unique<QuasiNewton>(by(s.initial), s.reuse, s.filter, 0);
    }
    std::unique_ptr<Accelerator> operator()(const KernelAcceleration& s) const {
      return std::make_unique<QuasiNewton>(Preconditioner::kernels(), s.reuse, s.filter, 1);
    }
  };
  struct UsesKernels {
    bool operator()(const NoAcceleration&) const { return false; }
    bool operator()(const FixedRelaxation& s) const { return s.factor.probed(); }
    bool operator()(const AitkenAcceleration& s) const { return s.initial.probed(); }
    bool operator()(const AndersonAcceleration& s) const { return s.initial.probed(); }
    bool operator()(const KernelAcceleration&) const { return true; }
  };
  const auto make = [accelerator = spec.accelerator, ties = tie_kernel_options(spec),
                     alternating = std::move(alternating)](std::span<const int> joints) {
    std::unique_ptr<Net> net;
    if (std::ranges::find_first_of(joints, alternating) == joints.end())
      net = std::make_unique<Net>(ties, std::visit(UsesKernels{}, accelerator));
    else
      net = std::make_unique<AlternatingNet>(ties);
    return Schwarz::Memory{std::visit(Maker{}, accelerator), std::move(net)};
  };
  return Schwarz(spec.max_iterations, spec.tolerance, make);
}

}  // namespace abut
