#include "coordinator/coupling/surface_watch.hpp"

#include <algorithm>

#include "coordinator/coupling/changed_places.hpp"
#include "coordinator/coupling/closing_speed.hpp"
#include "coordinator/coupling/nearness.hpp"

namespace abut {

namespace {

constexpr double force_floor = 1.0e-9;  // of the largest contact force: less is no compression
// Ways that surfaces can come in a window: those nearer than this may meet in it and are iterated,
// those farther than that are free again.
constexpr double near_ways = 1.5, far_ways = 4.0;

}  // namespace

Approach SurfaceWatch::approach(const Joint& joint, const Bodies& bodies) {
  if (!bodies.taken_back()) approach_ = approach_of(joint, margin_, bodies);
  if (joint.fit > 0.0) approach_.apart = 0.0;  // overlap grows there, whatever moves
  return approach_;
}

std::optional<Engagement> SurfaceWatch::begin(Joint& joint, const TimeWindow& window,
                                              const Bodies& bodies, ContactChanges&) {
  if (joint.pressing()) return std::nullopt;
  const auto [apart, bound] = approach(joint, bodies);
  const double way = bound * window.length();
  if (!joint.closed() && apart <= near_ways * way)
    return Engagement{.speed = bound, .end = window.end};
  if (joint.closed() && apart > far_ways * way) joint.disengage();
  return std::nullopt;
}

bool SurfaceWatch::stayed_apart(const Joint& joint, const Bodies& bodies, double length) const {
  return kept_apart(joint, approach_, margin_, bodies, length);
}

std::optional<Engagement> SurfaceWatch::touch(const Joint& joint, const TimeWindow& window,
                                              const Bodies& bodies, double) const {
  if (stayed_apart(joint, bodies, window.length())) return std::nullopt;
  return Engagement{.speed = approach_.speed, .end = window.end};  // again, as a whole
}

double SurfaceWatch::peak_force(const Joint& joint, const Bodies& bodies) const {
  const Waveform& force = bodies.reaction(joint.kinematic_side());
  const int dim = bodies.port(joint.sides[0]).geometry.dim;
  double peak = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) peak = std::max(peak, resultant(force, i, dim));
  return peak;
}

Shown SurfaceWatch::show(const Joint& joint, const Bodies& bodies) const {
  return {joint.closed() && peak_force(joint, bodies) > 0.0};
}

/// Pushes that begin and end: substeps decide about every point for themselves.
void SurfaceWatch::settle(Joint& joint, const TimeWindow&, double, ContactRun&, Bodies& bodies,
                          ContactChanges& changes) {
  if (!joint.closed()) return;
  const Waveform& force = bodies.reaction(joint.kinematic_side());
  const int dim = bodies.port(joint.sides[0]).geometry.dim;
  joint.contact.force_scale = std::max(joint.contact.force_scale, peak_force(joint, bodies));
  for (std::size_t i = 1; i < force.size(); ++i) {
    const bool presses = resultant(force, i, dim) > force_floor * joint.contact.force_scale;
    if (presses && !joint.pressing()) {
      joint.press();
      changes.push_back({true, force.time[i], closing_speed_before(joint, rubs_, bodies, i)});
    } else if (!presses && joint.pressing()) {
      joint.release();
      changes.push_back({false, force.time[i - 1], 0.0});
    }
  }
}

void SurfaceWatch::see_passing(const Joint& joint, const Bodies& bodies) {
  near_ = near_ || !swept_apart(joint, margin_, bodies);
}

bool SurfaceWatch::passed(const Joint& joint, const Bodies& bodies) const {
  return near_ && joint.fit == 0.0 && changed_places(joint, bodies);  // it is pressed apart
}

void SurfaceWatch::state(Archive& archive) {
  archive.field("apart", approach_.apart);
  archive.field("approach_speed", approach_.speed);
  archive.field("near", near_);
}

}  // namespace abut
