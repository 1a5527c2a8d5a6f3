#include "subdomain_solver/rigid/rigid_wall.hpp"

#include <limits>

namespace abut {

RigidWall::RigidWall(std::string name, double position, std::string port, double normal)
    : seen_{{0.0}, {0.0}, {0.0}, {0.0}} {
  description_.name = std::move(name);
  description_.model = "rigid wall";
  description_.mass = std::numeric_limits<double>::infinity();
  description_.stable_step = std::numeric_limits<double>::infinity();
  description_.conserves = true;
  description_.can = {.motion = false,
                      .force = true,
                      .obstacle = false,
                      .impulse = true,
                      .kernel = true,
                      .passive = true};
  able_.probed = this;
  able_.passive = this;
  Port p;
  p.name = std::move(port);
  p.geometry.points = {position};
  p.geometry.normals = {normal};
  description_.ports.push_back(std::move(p));
  description_.fields = {{"displacement", FieldPlace::nodes, 3},
                         {"velocity", FieldPlace::nodes, 3}};
}

Grid RigidWall::grid() {
  constexpr std::int32_t vtk_vertex = 1;
  return {{description_.ports[0].geometry.points[0], 0.0, 0.0}, {vtk_vertex}, {0}, {0, 1}};
}

std::vector<FieldValues> RigidWall::fields() { return {FieldValues(3, 0.0), FieldValues(3, 0.0)}; }

const PortValues& RigidWall::see(const Window& window, double time, bool) {
  seen_.f[0] = 0.0;
  for (const Waveform& imposed : window.request.boundary[0].forces) {
    double force = 0.0;
    if (!imposed.empty()) imposed.force_at(time, {&force, 1});
    seen_.f[0] += force;
  }
  return seen_;
}

std::optional<Failed> RigidWall::record(BodyRecord& record) {
  record.energy = {};
  record.momentum.assign(1, 0.0);
  return std::nullopt;
}

std::optional<Failed> RigidWall::leave(double, double& lost) {
  lost = 0.0;
  return std::nullopt;
}

std::optional<Failed> RigidWall::pass(const PassiveStep& step, PassiveReply& reply) {
  reply.ports = {{{0.0}, {0.0}}};
  reply.compliance.assign(step.pressed.empty() ? 0 : step.pressed[0].size(), 0.0);
  reply.bulge = reply.held = 0.0;
  return std::nullopt;
}

void RigidWall::finish(std::size_t, PortResponse& reply) const {
  reply.speed_bound = 0.0;
  reply.recoil = Recoil{};  // gives way to nothing
}

}  // namespace abut
