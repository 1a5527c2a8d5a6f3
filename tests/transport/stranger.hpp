#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "messaging/soundness.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut::stranger {

// A body of somebody else, and what it tells: sound, to be spoilt.

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two squares side by side in the plane z = 0, the body below.
inline PortGeometry two_squares() {
  PortGeometry surface;
  surface.dim = 3;
  surface.points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0};
  for (int p = 0; p < 6; ++p) surface.normals.insert(surface.normals.end(), {0, 0, 1});
  surface.facets = {0, 1, 2, 3, 1, 4, 5, 2};
  surface.offsets = {0, 4, 8};
  surface.spacing = 1.0;
  return surface;
}

inline Description body() {
  Description body;
  body.name = "stranger";
  body.model = "a block, by hand";
  body.dim = 3;
  body.mass = 2.0;
  body.step = 0.1;
  body.stable_step = infinity;
  body.ports = {{"top", two_squares()}};
  body.can.force = body.can.kernel = true;
  body.columns = {"temperature [K]"};
  return body;
}

inline Advance asked() {
  Advance advance;
  advance.window = {3, 1.0, 1.2};
  advance.records = 2;
  advance.boundary.resize(1);
  return advance;
}

/// Rises at 1 m/s from where it is described.
inline Response reply() {
  Response reply;
  PortResponse& port = reply.ports.emplace_back();
  port.trace.width = 18;
  port.trace.time = {1.0, 1.1, 1.2};
  for (int t = 0; t < 3; ++t)
    for (int k = 0; k < 18; ++k) {
      port.trace.u.push_back(k % 3 == 2 ? 0.1 * t : 0.0);
      port.trace.v.push_back(k % 3 == 2 ? 1.0 : 0.0);
      port.trace.a.push_back(0.0);
      port.trace.f.push_back(0.0);
    }
  port.lower = {0, 0, 0, 0, 0, 0.1};
  port.upper = {2, 1, 0.1, 2, 1, 0.2};
  port.speed_bound = 1.0;
  for (const double time : {1.1, 1.2})
    reply.records.push_back({time, Energy{1.0, 0.0, 0.0, 0.0}, {0, 0, 2}, {}, {}, {293.0}});
  reply.steps = 2;
  return reply;
}

inline Probing probing() { return {0, std::vector<double>(18, 1.0), 0.1, 2, {}}; }

inline PortKernel kernel() {
  PortKernel kernel;
  kernel.step = 0.1;
  kernel.width = 18;
  kernel.displacement.assign(36, 0.01);
  kernel.begin.assign(36, 0.005);
  return kernel;
}

template <class Judge>
std::string refusal(const Judge& judge) {
  try {
    judge();
  } catch (const CodecError& error) {
    return error.what();
  }
  return "accepted";
}

inline std::string told(const std::function<void(Description&)>& spoil) {
  Description spoilt = body();
  spoil(spoilt);
  return refusal([&] { require_sound(spoilt); });
}

inline std::string answered(const std::function<void(Response&)>& spoil,
                            const Advance& to = asked()) {
  Response spoilt = reply();
  spoil(spoilt);
  return refusal([&] { require_sound(spoilt, body(), to); });
}

}  // namespace abut::stranger
