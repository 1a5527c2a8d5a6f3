#include "subdomain_solver/rigid/rigid_wall.hpp"

#include <algorithm>
#include <limits>

#include "base/assert.hpp"
#include "base/index.hpp"

namespace abut {

RigidWall::RigidWall(std::string name, double position, std::string port, double normal) {
  description_.name = std::move(name);
  description_.model = "rigid wall";
  description_.mass = std::numeric_limits<double>::infinity();
  description_.stable_step = std::numeric_limits<double>::infinity();
  description_.conserves = true;
  description_.can = {.motion = false,
                      .force = true,
                      .obstacle = false,
                      .impulse = true,
                      .kernel = true};
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

Outcome RigidWall::finish(Response& response) {
  ABUT_ASSERT(request_ != nullptr);
  const Advance& request = *request_;
  request_ = nullptr;
  const int parts = std::max(1, request.records);
  const BoundaryData& data = request.boundary[0];
  response.ports.resize(1);
  response.records.resize(index(parts));
  PortResponse& port = response.ports[0];
  Waveform& trace = port.trace;
  trace.clear();
  const Want want = request.want.empty() ? Want{} : request.want[0];
  auto push = [&trace, &data, &want](double time) {
    double force = 0.0;
    for (const Waveform& imposed : data.forces) {
      double part = 0.0;
      if (!imposed.empty()) imposed.force_at(time, {&part, 1});
      force += part;
    }
    trace.time.push_back(time);
    if (want.u) trace.u.push_back(0.0);
    if (want.v) trace.v.push_back(0.0);
    if (want.a) trace.a.push_back(0.0);
    if (want.f) trace.f.push_back(force);
  };
  push(request.window.begin);
  for (int p = 1; p <= parts; ++p) {
    const double time = p == parts ? request.window.end
                                   : request.window.begin + p * (request.window.length() / parts);
    BodyRecord& record = response.records[index(p) - 1];
    record = BodyRecord{time, {}, {0.0}};
    if (time > trace.time.back()) push(time);
  }
  port.reactions.clear();
  port.lower.assign(index(parts), description_.ports[0].geometry.points[0]);
  port.upper = port.lower;
  port.speed_bound = port.acceleration_bound = 0.0;
  port.recoil = Recoil{};  // gives way to nothing
  port.work = 0.0;
  response.steps = request.window.length() > 0.0 ? 1 : 0;
  response.compute_seconds = 0.0;
  return Advanced{};
}

PortKernel RigidWall::probe(int, std::span<const double> patterns, double step, int count) {
  PortKernel kernel;
  kernel.step = step;
  kernel.patterns = static_cast<int>(patterns.size());
  kernel.displacement.assign(index(count) * patterns.size(), 0.0);
  kernel.begin = kernel.displacement;
  return kernel;
}

}  // namespace abut
