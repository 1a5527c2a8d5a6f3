#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "contract/subdomain.hpp"

namespace abut::bench {

using Clock = std::chrono::steady_clock;

/// Fills a waveform with numbers that no codec could shorten.
inline Waveform wave(int substeps) {
  Waveform w(1);
  for (int i = 0; i <= substeps; ++i) {
    w.time.push_back(1.0e-7 * i);
    for (std::vector<double>* field : {&w.u, &w.v, &w.a, &w.f}) field->push_back(1.0 / (3.0 + i));
  }
  return w;
}

/// The same on a surface of points in space: one field, a substep.
inline Waveform wave_of_surface(int points, std::vector<double> Waveform::*field) {
  Waveform w(3 * points);
  w.time = {0.0, 1.0e-7};
  for (int i = 0; i < 2 * w.width; ++i) (w.*field).push_back(1.0 / (3.0 + i));
  return w;
}

/// Answers every window with the same response: all that is left of an exchange is its overhead. Of
/// one point it answers forces by motion, of several the motion of an obstacle by the reaction.
class InstantBody : public Subdomain {
 public:
  explicit InstantBody(int points) : points_(points) {
    description_.dim = points > 1 ? 3 : 1;
    description_.mass = 1.0;
    description_.ports.resize(1);
    description_.ports[0].name = "tip";
    PortGeometry& geometry = description_.ports[0].geometry;
    geometry.dim = description_.dim;
    geometry.points.assign(index(points * geometry.dim), 0.0);
    geometry.normals.assign(geometry.points.size(), 0.0);  // points without facets face nothing
    if (points == 1) geometry.normals = {1.0};
    description_.can.obstacle = points > 1;
    description_.can.force = points == 1;
  }
  const Description& describe() const override { return description_; }
  void save() override {}
  void restore() override {}
  void start(const Advance& request) override { request_ = &request; }
  Outcome finish(Response& response) override {
    const Clock::time_point begin = Clock::now();
    if (points_ > 1) {
      answer_obstacle(response);
      response.compute_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
      return Advanced{};
    }
    const int substeps = static_cast<int>(request_->boundary[0].forces[0].size()) - 1;
    if (response.steps != substeps) {
      response.ports.resize(1);
      response.ports[0].trace = wave(substeps);
      response.ports[0].lower = {-1.0};  // holds the wave
      response.ports[0].upper = {1.0};
      response.records.resize(1);
      response.records[0].momentum = {0.0};
      response.records[0].time = request_->window.end;
      response.steps = substeps;
    }
    response.compute_seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    return Advanced{};
  }
  void meet(const Meeting&) override {}
  PortKernel probe(const Probing&) override { return {}; }
  std::vector<std::byte> checkpoint() override { return {}; }
  void resume(std::span<const std::byte>) override {}
  std::uint64_t state_hash() override { return 0; }

 private:
  void answer_obstacle(Response& response) {
    if (response.steps == 1) return;
    response.ports.resize(1);
    PortResponse& port = response.ports[0];
    port.trace = Waveform(3 * points_);
    port.trace.time = {0.0, 1.0e-7};
    port.reactions = {Reaction{wave_of_surface(points_, &Waveform::f)}};
    port.lower = port.upper = {0.0, 0.0, 0.0};
    response.records.resize(1);
    response.records[0].momentum = {0.0, 0.0, 0.0};
    response.records[0].time = request_->window.end;
    response.steps = 1;
  }

  int points_;
  Description description_;
  const Advance* request_ = nullptr;
};

}  // namespace abut::bench
