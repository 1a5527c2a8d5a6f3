#include "coordinator/record/port_reader.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>

namespace abut {

std::array<double, 3> PortReader::gathered(double scale) const {
  std::array<double, 3> sum{};
  const std::size_t dim = index(port_->geometry.dim);
  for (std::size_t i = 0; i < values_.size(); i += dim)
    for (std::size_t d = 0; d < dim; ++d) sum[d] += values_[i + d];
  for (double& value : sum) value *= scale;
  return sum;
}

PortMeans PortReader::at(const Waveform& trace, double time) {
  const double when = std::clamp(time, trace.time.front(), trace.time.back());
  const double share = 1.0 / std::max(1, port_->geometry.count());
  values_.resize(index(trace.width));
  PortMeans out;
  if (!trace.u.empty()) {
    trace.interpolate(trace.u, when, values_);
    out.u = gathered(share);
  }
  if (!trace.v.empty()) {
    trace.interpolate(trace.v, when, values_);
    out.v = gathered(share);
  }
  if (!trace.f.empty()) {
    trace.force_at(when, values_);
    out.f = gathered(1.0);
  }
  return out;
}

PortMeans PortReader::since(const Waveform& trace, double from, double to) {
  PortMeans out = at(trace, to);
  if (trace.f.empty() || trace.support != ForceSupport::step || !(from < to)) return out;
  trace.impulse(from, to, values_);
  out.f = gathered(1.0 / (to - from));
  return out;
}

double PortReader::compression(const Waveform& trace, std::size_t i) const {
  const std::size_t width = index(trace.width), dim = index(port_->geometry.dim);
  if (dim > 1) {
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < width; ++k) sum[k % dim] += trace.f[i * width + k];
    return std::hypot(sum[0], sum[1], sum[2]);
  }
  double force = 0.0;
  for (std::size_t k = 0; k < width; ++k)
    force -= trace.f[i * width + k] * port_->geometry.normals[k];
  return force;
}

double PortReader::along_x(const Waveform& trace, const std::vector<double>& field,
                           std::size_t i) const {
  if (field.empty()) return 0.0;
  const std::size_t width = index(trace.width);
  const std::size_t dim = index(port_->geometry.dim);
  double sum = 0.0;
  for (std::size_t k = 0; k < width; k += dim) sum += field[i * width + k];
  return sum * static_cast<double>(dim) / static_cast<double>(width);
}

double gap_of(const InterfaceInfo& interface, const RunStart& start, double u0, double u1) {
  double gap = interface.initial_gap;
  const double u[2] = {u0, u1};
  for (const int side : {0, 1}) {
    const Description& body = *start.bodies[interface.body[side]];
    gap -= body.ports[interface.port[side]].geometry.normals[0] * u[side];
  }
  return gap;
}

const char* axis_ending(int dim, int axis) {
  static constexpr const char* endings[] = {"_x", "_y", "_z"};
  return dim == 1 ? "" : endings[axis];
}

}  // namespace abut
