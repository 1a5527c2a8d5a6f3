#pragma once

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// A body whose reply is written down beforehand.
class Scripted : public Subdomain {
 public:
  Scripted(double place, double normal, double step, int ports = 1) {
    description_.step = step;
    description_.mass = 1.0;
    for (int p = 0; p < ports; ++p) {
      Port port;
      port.geometry.points = {place + p};
      port.geometry.normals = {p == 0 ? normal : -normal};
      description_.ports.push_back(port);
    }
    reply.ports.resize(index(ports));
  }
  /// u at the times of a window and, if any, forces.
  void trace(std::vector<double> time, std::vector<double> u, std::vector<double> f = {}) {
    Waveform& w = reply.ports[0].trace;
    w.time = std::move(time);
    w.u = std::move(u);
    w.f = std::move(f);
  }
  const Description& describe() const override { return description_; }
  void save() override {}
  void restore() override {}
  void start(const Advance&) override {}
  [[nodiscard]] Outcome finish(Response& response) override {
    response = reply;
    return Advanced{};
  }
  void meet(const Meeting&) override {}
  PortKernel probe(const Probing& asked) override {
    PortKernel kernel;
    kernel.width = static_cast<int>(asked.patterns.size());
    kernel.step = asked.step;
    kernel.displacement.assign(index(asked.count), asked.patterns[0] * compliance);
    return kernel;
  }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

  Response reply;
  double compliance = 0.0;  // [m/N]

  Description description_;
};

/// Two scripted bodies, the left one looking right, 1 m apart.
struct Facing {
  Scripted left, right;
  Bodies bodies;
  Joint joint;

  explicit Facing(double left_step = 1.0, double right_step = 1.0)
      : left(-1.0, 1.0, left_step), right(0.0, -1.0, right_step), bodies({&left, &right}) {
    joint = make_joint("meeting", {Side{0, 0}, Side{1, 0}}, bodies);
  }
  void reply() { EXPECT_FALSE(bodies.advance_all()); }
};

}  // namespace abut
