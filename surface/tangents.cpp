#include "surface/tangents.hpp"

#include <Eigen/Geometry>

namespace abut {

void tangents(int dim, const double* normal, std::span<double> out) {
  if (dim == 2) {
    out[0] = -normal[1];
    out[1] = normal[0];
    return;
  }
  const Eigen::Map<const Eigen::Vector3d> n(normal);
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Eigen::Map<Eigen::Vector3d> first(out.data()), second(out.data() + 3);
  first = (Eigen::Vector3d::Unit(least) - n[least] * n).normalized();
  second = n.cross(first);
}

}  // namespace abut
