#include "subdomain_solver/port_statics.hpp"

#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

bool PortStatics::give(std::span<const double> force, const Vector& place,
                       std::vector<double>& moved, Vector& left) {
  force_.assign(force.begin(), force.end());
  lifted_.setZero(static_cast<Eigen::Index>(motion_.q.size()));
  map_.lift(motion_.q, force_, lifted_);
  if (!statics_.give(motion_, time_, lifted_, place, moved_, left)) return false;
  moved.resize(map_.values());
  map_.velocity(motion_.q, span_of(moved_), moved);
  return true;
}

}  // namespace abut
