#include <algorithm>
#include <limits>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "subdomain_solver/body.hpp"

namespace abut {

namespace {

const Want everything;

const Want& want_of(const Advance& request, std::size_t port) {
  return request.want.empty() ? everything : request.want[port];
}

/// Of a port's values, those of the points that are listed; all, where none is.
void append_values(std::span<const double> port, const std::vector<std::int32_t>& points,
                   std::size_t dim, std::vector<double>& to) {
  if (points.empty()) to.insert(to.end(), port.begin(), port.end());
  for (const std::int32_t point : points) {
    const std::span<const double> one = port.subspan(index(point) * dim, dim);
    to.insert(to.end(), one.begin(), one.end());
  }
}

/// A force on some points as one on more of them; empty: on all, which are `width` values.
void list(Waveform& force, const std::vector<std::int32_t>& points, int width, int dim) {
  const Waveform before = force;
  force.points = points;
  force.width = points.empty() ? width : static_cast<int>(points.size()) * dim;
  force.f.assign(force.time.size() * index(force.width), 0.0);
  for (std::size_t k = 0; k < before.f.size(); ++k) {
    const std::size_t w = index(before.width), n = index(dim), value = k % w;
    const std::int32_t point = before.points[value / n];
    const auto now =
        points.empty() ? point : std::ranges::lower_bound(points, point) - points.begin();
    force.f[k / w * index(force.width) + index(now) * n + value % n] = before.f[k];
  }
}

/// Lists those points alone that a force acts on, one at least; empty: it acts on all of the
/// partner's, which are `all`.
void list_pressed(Waveform& force, std::size_t dim, std::size_t all,
                  std::vector<std::int32_t>& pressed) {
  const std::size_t width = index(force.width);
  pressed.clear();
  for (std::size_t point = 0; point < width / dim; ++point) {
    bool acts = false;
    for (std::size_t v = point * dim; v < force.f.size() && !acts; v += width)
      for (std::size_t i = 0; i < dim; ++i) acts = acts || force.f[v + i] != 0.0;
    if (acts) pressed.push_back(static_cast<std::int32_t>(point));
  }
  if (pressed.empty()) pressed.push_back(0);
  std::size_t to = 0;
  for (std::size_t first = 0; first < force.f.size(); first += width)
    for (const std::int32_t point : pressed)
      for (std::size_t i = 0; i < dim; ++i) force.f[to++] = force.f[first + index(point) * dim + i];
  force.f.resize(to);
  force.width = static_cast<int>(pressed.size() * dim);
  if (!force.points.empty())
    for (std::int32_t& point : pressed) point = force.points[point];
  force.points.assign(pressed.begin(), pressed.end());
  if (pressed.size() == all) force.points.clear();
}

}  // namespace

void Body::begin_replies(const Advance& request, Response& response) {
  ABUT_ASSERT(request.boundary.size() == ports_.size());
  response.records.resize(index(std::max(1, request.records)));
  response.ports.resize(ports_.size());
  response.unbalanced.clear();
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    const PortGeometry& geometry = *ports_[p].geometry;
    const std::vector<Obstacle>& obstacles = request.boundary[p].obstacles;
    PortResponse& port = response.ports[p];
    ports_[p].want = &want_of(request, p);
    ports_[p].obstacles = &obstacles;
    ports_[p].reply = &port;
    port.trace.clear();
    port.trace.support = interior_->support(p);
    port.trace.points = want_of(request, p).points;
    const int points =
        port.trace.points.empty() ? geometry.count() : static_cast<int>(port.trace.points.size());
    port.trace.width = points * geometry.dim;
    port.reactions.resize(obstacles.size());
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      Waveform& force = port.reactions[k].force;
      force.clear();
      force.support = interior_->reaction_support(p);
      force.width = obstacles[k].motion.width;
      force.points = obstacles[k].motion.points;
      port.reactions[k].dissipated = 0.0;
      port.reactions[k].slid.clear();
    }
    port.ahead.clear();
    port.ahead.width = 1;
    port.lower.clear();
    port.upper.clear();
    port.slowest.clear();
    port.fastest.clear();
    port.speed_bound = std::numeric_limits<double>::infinity();
    port.acceleration_bound = port.work = 0.0;
    port.recoil.reset();
  }
}

void Body::push_trace(const Watched& port, double time) const {
  const Want& want = *port.want;
  Waveform& trace = port.reply->trace;
  const std::size_t first = port.first;
  trace.time.push_back(time);
  if (port.width == 1 && want.points.empty()) {  // the end of a bar, whose substeps are short
    if (want.u) trace.u.push_back(seen_->u[first]);
    if (want.v) trace.v.push_back(seen_->v[first]);
    if (want.a) trace.a.push_back(seen_->a[first]);
    if (want.f) trace.f.push_back(seen_->f[first]);
    return;
  }
  const auto push = [&](bool wanted, const std::vector<double>& from, std::vector<double>& to) {
    const std::span<const double> own = std::span(from).subspan(first, port.width);
    if (wanted) append_values(own, want.points, index(port.geometry->dim), to);
  };
  push(want.u, seen_->u, trace.u);
  push(want.v, seen_->v, trace.v);
  push(want.a, seen_->a, trace.a);
  push(want.f, seen_->f, trace.f);
}

void Body::push_reactions(std::size_t p, double time) const {
  const Watched& port = ports_[p];
  const Obstructed* obstructed = interior_->able().obstructed;
  for (std::size_t k = 0; k < port.reply->reactions.size(); ++k) {
    if (obstructed == nullptr || (*port.obstacles)[k].empty()) continue;
    Waveform& force = port.reply->reactions[k].force;
    const std::vector<std::int32_t>* points = obstructed->reacting(p, k);
    if (points != nullptr && (force.time.empty() || force.points != *points))
      list(force, *points, (*port.obstacles)[k].motion.width, port.geometry->dim);
    force.time.push_back(time);
    obstructed->react(p, k, force.f);
  }
}

/// Contact looks at more points than are pressed, and at which depends on where it looked before:
/// no part of a reply.
void Body::list_reactions(std::size_t p) {
  const Watched& port = ports_[p];
  const Obstructed* obstructed = interior_->able().obstructed;
  const std::size_t dim = index(port.geometry->dim);
  for (std::size_t k = 0; obstructed != nullptr && k < port.reply->reactions.size(); ++k) {
    const Waveform& obstacle = (*port.obstacles)[k].motion;
    Waveform& force = port.reply->reactions[k].force;
    if (obstructed->reacting(p, k) == nullptr || force.empty() || !obstacle.points.empty())
      continue;
    list_pressed(force, dim, index(obstacle.width) / dim, pressed_);
  }
}

void Body::begin_sweep() {
  for (Watched& port : ports_) {
    const std::size_t dim = index(port.geometry->dim);
    port.lower.assign(dim, std::numeric_limits<double>::infinity());
    port.upper.assign(dim, -std::numeric_limits<double>::infinity());
  }
  widen_sweep();
}

void Body::widen_sweep() {
  for (Watched& port : ports_) {
    const double* u = seen_->u.data() + port.first;
    const double* place = port.geometry->points.data();
    double* lower = port.lower.data();
    double* upper = port.upper.data();
    if (port.width == 1) {
      const double at = *place + *u;
      *lower = std::min(*lower, at);
      *upper = std::max(*upper, at);
      continue;
    }
    const int dim = port.geometry->dim;
    for (const double* end = place + port.width; place < end; place += dim) {
      for (int i = 0; i < dim; ++i) {
        const double at = place[i] + *u++;
        lower[i] = std::min(lower[i], at);
        upper[i] = std::max(upper[i], at);
      }
    }
  }
}

/// Of surfaces: what they meet between two looks at them is judged by these velocities, and the
/// ways between substeps are straight to all who look. `length`: [s] of the substep; 0: the begin.
void Body::widen_velocities(double length) {
  for (Watched& port : ports_) {
    const std::size_t dim = index(port.geometry->dim);
    if (dim == 1 || port.width == 0) continue;
    const double* u = seen_->u.data() + port.first;
    std::vector<double>& slowest = port.reply->slowest;
    std::vector<double>& fastest = port.reply->fastest;
    for (std::size_t i = 0; length > 0.0 && i < dim; ++i) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t k = i; k < port.width; k += dim) {
        least = std::min(least, u[k] - port.before[k]);
        most = std::max(most, u[k] - port.before[k]);
      }
      if (slowest.size() <= i) {
        slowest.push_back(least / length);
        fastest.push_back(most / length);
      } else {
        slowest[i] = std::min(slowest[i], least / length);
        fastest[i] = std::max(fastest[i], most / length);
      }
    }
    port.before.assign(u, u + port.width);
  }
}

}  // namespace abut
