#include "coordinator/coupling/closing_speed.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "base/index.hpp"
#include "surface/posed_surface.hpp"

namespace abut {

namespace {

using Vector3 = Eigen::Vector3d;

Vector3 at(const std::vector<double>& values, std::size_t k, int dim) {
  const double* x = values.data() + k * index(dim);
  return {x[0], x[1], dim == 3 ? x[2] : 0.0};
}

/// Those points of a side that its reply lists, at one time of it.
class Seen {
 public:
  Seen(const PortGeometry& geometry, const Waveform& trace, double time)
      : geometry_(geometry), points_(geometry.points), load_(geometry.points.size(), 0.0) {
    const std::size_t width = index(trace.width), dim = index(geometry.dim);
    std::vector<double> u(width);
    velocity_.resize(width);
    trace.interpolate(trace.u, time, u);
    trace.interpolate(trace.v, time, velocity_);
    listed_.resize(width / dim);
    place_.assign(geometry.points.size() / dim, -1);
    for (std::size_t k = 0; k < listed_.size(); ++k) {
      listed_[k] = trace.points.empty() ? k : index(trace.points[k]);
      place_[listed_[k]] = static_cast<int>(k);
      for (std::size_t i = 0; i < dim; ++i) points_[listed_[k] * dim + i] += u[k * dim + i];
    }
  }

  Vector3 point(std::size_t node) const { return at(points_, node, geometry_.dim); }
  /// Of a listed point.
  Vector3 velocity(std::size_t node) const {
    return at(velocity_, index(place_[node]), geometry_.dim);
  }
  bool lists(std::size_t node) const { return place_[node] >= 0; }
  std::size_t nearest(const Vector3& x) const {
    std::size_t best = listed_.front();
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t node : listed_) {
      const double apart = (point(node) - x).squaredNorm();
      if (apart >= least) continue;
      least = apart;
      best = node;
    }
    return best;
  }
  void load(std::size_t node, double weight) { load_[node] += weight; }

  /// Outward normal of the facets around loaded points; its length tells how alike theirs are: 1 of
  /// a plane, less of a corner.
  Vector3 normal() const {
    const PosedSurface surface = posed(geometry_, std::span<const double>(points_));
    Vector3 sum = Vector3::Zero();
    double size = 0.0;
    for (int f = 0; f < surface.facet_count(); ++f) {
      double weight = 0.0;
      bool known = true;
      for (const std::int32_t node : surface.nodes(f)) {
        weight += load_[node];
        known = known && lists(index(node));
      }
      if (!known || weight == 0.0) continue;
      const Vector3 area = area_vector(corners(surface, f));
      sum += weight * area;
      size += weight * area.norm();
    }
    return size > 0.0 ? Vector3(sum / size) : Vector3::Zero();
  }

 private:
  const PortGeometry& geometry_;
  std::vector<double> points_, velocity_;  // [m] of all, [m/s] of those that are listed
  std::vector<double> load_;
  std::vector<std::size_t> listed_;
  std::vector<int> place_;  // of a point among those that are listed; -1: it is not
};

}  // namespace

double closing_speed_before(const Joint& joint, bool rubs, const Bodies& bodies,
                            std::size_t substep) {
  const Waveform& force = bodies.reaction(joint.kinematic_side());
  const int dim = bodies.port(joint.sides[0]).geometry.dim;
  const double time = force.time[substep - 1];
  Seen finder(bodies.port(joint.kinematic_side()).geometry,
              trace_of(bodies, joint.kinematic_side()), time);
  Seen other(bodies.port(joint.neumann_side()).geometry, trace_of(bodies, joint.neumann_side()),
             time);
  const std::size_t count = index(force.width) / index(dim), first = substep * count;
  Vector3 push = Vector3::Zero(), closing = Vector3::Zero();
  double all = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t node = force.points.empty() ? k : index(force.points[k]);
    const Vector3 own = at(force.f, first + k, dim);
    const double weight = own.norm();
    if (weight == 0.0 || !other.lists(node)) continue;
    const std::size_t facing = finder.nearest(other.point(node));
    push += own;
    closing += weight * (finder.velocity(facing) - other.velocity(node));
    all += weight;
    other.load(node, weight);
    finder.load(facing, weight);
  }
  if (all == 0.0) return 0.0;
  Vector3 normal = push;
  if (rubs) {  // the force leans; of a corner on a plane, the plane tells
    const Vector3 own = finder.normal(), theirs = other.normal();
    normal = own.norm() >= theirs.norm() ? own : Vector3(-theirs);
  }
  if (normal.norm() == 0.0) return 0.0;
  return std::max(0.0, closing.dot(normal.normalized()) / all);
}

}  // namespace abut
