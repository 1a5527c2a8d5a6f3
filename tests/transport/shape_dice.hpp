#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "base/index.hpp"
#include "contract/subdomain.hpp"
#include "messaging/codec.hpp"

namespace abut {

/// Numbers, shapes and choices from one seed.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  int upto(int most) { return static_cast<int>(random_() % index(most + 1)); }
  bool coin() { return upto(1) == 1; }
  ForceSupport any_support() { return static_cast<ForceSupport>(upto(2)); }
  double value() { return static_cast<double>(random_() >> 11) * 0x1.0p-53 - 0.5; }
  std::vector<double> values(std::size_t count) {
    std::vector<double> all(count);
    for (double& one : all) one = value();
    return all;
  }
  /// Some points of a surface, or none: all of them.
  std::vector<std::int32_t> points(int count) {
    std::vector<std::int32_t> some;
    for (int i = 0; i < count; ++i)
      if (coin()) some.push_back(i);
    return some;
  }

  PortGeometry surface(int dim) {
    PortGeometry made;
    made.dim = dim;
    made.points = values(index(1 + upto(5)) * index(dim));
    made.normals = values(made.points.size());
    made.spacing = 0.5 + value();
    made.transit = 0.5 + value();
    made.embedded = upto(made.count());
    if (dim == 1) return made;
    made.offsets = {0};
    for (int facet = upto(4); facet > 0; --facet) {
      for (int node = 0; node <= dim; ++node) made.facets.push_back(upto(made.count() - 1));
      made.offsets.push_back(static_cast<std::int32_t>(made.facets.size()));
    }
    return made;
  }
  Waveform wave(const SurfaceSize& shape, const std::vector<std::int32_t>& listed,
                const TimeWindow& window) {
    Waveform made((listed.empty() ? shape.points : static_cast<int>(listed.size())) * shape.dim);
    made.points = listed;
    made.support = any_support();
    const int steps = 1 + upto(3);
    for (int i = 0; i <= steps; ++i)
      made.time.push_back(i == steps ? window.end : window.begin + window.length() * i / steps);
    const std::size_t count = made.time.size() * index(made.width);
    for (std::vector<double>* field : {&made.u, &made.v, &made.a, &made.f}) *field = values(count);
    return made;
  }
  PortKernel kernel(int patterns, int width, int count) {
    PortKernel made;
    made.step = 0.5 + value();
    made.support = any_support();
    made.patterns = patterns;
    made.width = width;
    made.displacement = values(index(count) * made.per_step());
    if (coin()) made.compliance = values(made.per_step());
    if (coin()) made.begin = values(made.displacement.size());
    return made;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace abut
