#include "coordinator/passive/passive_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace abut {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Ports of all bodies, one after the other.
template <class Visit>
void each_port(Bodies& bodies, const Visit& visit) {
  std::size_t k = 0;
  for (int b = 0; b < bodies.count(); ++b)
    for (std::size_t p = 0; p < bodies.describe(b).ports.size(); ++p) visit(b, p, k++);
}

}  // namespace

void PassiveRecord::begin(double time, const CommonStep& state, std::vector<Told> told) {
  told_ = std::move(told);
  std::size_t ports = 0;
  each_port(bodies_, [&](int b, std::size_t p, std::size_t) {
    PortResponse& reply = bodies_.response(b).ports[p];
    const double acceleration = reply.acceleration_bound;
    const PortGeometry& geometry = bodies_.describe(b).ports[p].geometry;
    reply = PortResponse{};
    reply.acceleration_bound = acceleration;
    reply.trace.width = static_cast<int>(geometry.points.size());
    reply.trace.support = ForceSupport::step;
    reply.slowest.assign(index(geometry.dim), infinity);
    reply.fastest.assign(index(geometry.dim), -infinity);
    ++ports;
  });
  lower_.assign(ports, {});
  upper_.assign(ports, {});
  for (const Told& pair : told_) {
    std::vector<Reaction>& reactions =
        bodies_.response(pair.kinematic.body).ports[index(pair.kinematic.port)].reactions;
    if (reactions.size() <= index(pair.kinematic.partner))
      reactions.resize(index(pair.kinematic.partner) + 1);
    Waveform& force = reactions[index(pair.kinematic.partner)].force;
    force.width = static_cast<int>(bodies_.port(pair.partner).geometry.points.size());
    force.support = ForceSupport::step;
  }
  for (int b = 0; b < bodies_.count(); ++b) {
    bodies_.response(b).records.clear();
    bodies_.response(b).steps = 0;
  }
  append(time, state);
  state.ties().begin_window(time);
  each_port(bodies_, [&](int b, std::size_t p, std::size_t) {
    std::vector<double>& f = bodies_.response(b).ports[p].trace.f;
    f.assign(bodies_.describe(b).ports[p].geometry.points.size(), 0.0);
  });
  for (const Told& pair : told_) {
    Waveform& force = force_of(pair);
    force.time.push_back(time);
    force.f.assign(index(force.width), 0.0);
  }
}

Waveform& PassiveRecord::force_of(const Told& pair) {
  return bodies_.response(pair.kinematic.body)
      .ports[index(pair.kinematic.port)]
      .reactions[index(pair.kinematic.partner)]
      .force;
}

void PassiveRecord::append(double time, const CommonStep& state) {
  each_port(bodies_, [&](int b, std::size_t p, std::size_t) {
    Waveform& trace = bodies_.response(b).ports[p].trace;
    const std::vector<double>& u = state.displacement(b, static_cast<int>(p));
    const std::vector<double>& v = state.velocity(b, static_cast<int>(p));
    trace.time.push_back(time);
    trace.u.insert(trace.u.end(), u.begin(), u.end());
    trace.v.insert(trace.v.end(), v.begin(), v.end());
  });
  widen(state);
}

/// Boxes of places since the last record.
void PassiveRecord::widen(const CommonStep& state) {
  each_port(bodies_, [&](int b, std::size_t p, std::size_t k) {
    const PortGeometry& geometry = bodies_.describe(b).ports[p].geometry;
    const std::size_t dim = index(geometry.dim);
    const std::vector<double>& u = state.displacement(b, static_cast<int>(p));
    if (lower_[k].empty()) {
      lower_[k].assign(dim, infinity);
      upper_[k].assign(dim, -infinity);
    }
    for (std::size_t v = 0; v < u.size(); ++v) {
      const double place = geometry.points[v] + u[v];
      lower_[k][v % dim] = std::min(lower_[k][v % dim], place);
      upper_[k][v % dim] = std::max(upper_[k][v % dim], place);
    }
  });
}

void PassiveRecord::add(const CommonStep& step, double begin, double end) {
  const double length = end - begin;
  append(end, step);
  each_port(bodies_, [&](int b, std::size_t p, std::size_t) {
    PortResponse& reply = bodies_.response(b).ports[p];
    const std::size_t width = index(reply.trace.width), dim = reply.slowest.size();
    const std::size_t last = reply.trace.u.size() - width;
    for (std::size_t v = 0; v < width; ++v) {
      const double speed = (reply.trace.u[last + v] - reply.trace.u[last - width + v]) / length;
      reply.slowest[v % dim] = std::min(reply.slowest[v % dim], speed);
      reply.fastest[v % dim] = std::max(reply.fastest[v % dim], speed);
    }
    reply.trace.f.resize(reply.trace.u.size(), 0.0);
    reply.work += step.work(b, static_cast<int>(p));
  });
  for (const Told& pair : told_) {
    Waveform& force = force_of(pair);
    force.time.push_back(end);
    force.f.resize(force.f.size() + index(force.width), 0.0);
  }
  add_forces(step, length);
  add_ties(step, length);
  step.ties().tell(end);
  for (int b = 0; b < bodies_.count(); ++b) ++bodies_.response(b).steps;
}

void PassiveRecord::add_forces(const CommonStep& step, double length) {
  const std::size_t dim = index(surfaces_.skin().dim);
  for (const DistanceRow& row : step.rows()) {
    const auto put = [&](std::vector<double>& f, std::size_t width, std::size_t i) {
      const TouchingSurfaces::Point& at = surfaces_[row.features.points[i]];
      const Eigen::Vector3d force = row.impulse_on(i) / length;
      for (std::size_t k = 0; k < dim; ++k)
        f[f.size() - width + index(at.point) * dim + k] += force(static_cast<Eigen::Index>(k));
    };
    for (std::size_t i = 0; i < 4; ++i) {
      if (!row.counts(i)) continue;
      const TouchingSurfaces::Point& at = surfaces_[row.features.points[i]];
      Waveform& trace = bodies_.response(at.body).ports[index(at.port)].trace;
      put(trace.f, index(trace.width), i);
      for (const Told& pair : told_) {
        if (at.body != pair.partner.body || at.port != pair.partner.port) continue;
        const int other = i < index(row.features.first_side()) ? 1 : 0;
        const TouchingSurfaces::Point& from = surfaces_[row.first_point(other)];
        if (from.body != pair.kinematic.body || from.port != pair.kinematic.port) continue;
        Waveform& reaction = force_of(pair);
        put(reaction.f, index(reaction.width), i);
      }
    }
  }
}

void PassiveRecord::add_ties(const CommonStep& step, double length) {
  std::vector<std::vector<double>> impulses;
  for (int b = 0; b < bodies_.count() && step.ties().any(); ++b) {
    impulses.assign(bodies_.describe(b).ports.size(), {});
    step.ties().add_impulses(b, impulses);
    for (std::size_t p = 0; p < impulses.size(); ++p) {
      std::vector<double>& f = bodies_.response(b).ports[p].trace.f;
      const std::size_t last = f.size() - impulses[p].size();
      for (std::size_t v = 0; v < impulses[p].size(); ++v) f[last + v] += impulses[p][v] / length;
    }
  }
}

void PassiveRecord::record(const CommonStep& state) {
  for (int b = 0; b < bodies_.count(); ++b) bodies_.response(b).records.push_back(state.record(b));
  each_port(bodies_, [&](int b, std::size_t p, std::size_t k) {
    PortResponse& reply = bodies_.response(b).ports[p];
    reply.lower.insert(reply.lower.end(), lower_[k].begin(), lower_[k].end());
    reply.upper.insert(reply.upper.end(), upper_[k].begin(), upper_[k].end());
    lower_[k].clear();
    upper_[k].clear();
  });
  widen(state);
}

void PassiveRecord::finish() {
  each_port(bodies_, [&](int b, std::size_t p, std::size_t) {
    PortResponse& reply = bodies_.response(b).ports[p];
    const std::size_t width = index(reply.trace.width), dim = reply.slowest.size();
    double most = 0.0;
    for (std::size_t v = reply.trace.v.size() - width; v < reply.trace.v.size(); v += dim) {
      double square = 0.0;
      for (std::size_t i = 0; i < dim; ++i) square += reply.trace.v[v + i] * reply.trace.v[v + i];
      most = std::max(most, square);
    }
    reply.speed_bound = std::sqrt(most);
  });
  bodies_.see_anew();
}

}  // namespace abut
