#include "subdomain_solver/materials/plane.hpp"

#include <array>

namespace abut {

namespace {

constexpr std::array<int, 5> entries = {0, 1, 3, 4, 8};

}  // namespace

Matrix3 embed(const Eigen::Matrix2d& f, double normal) {
  Matrix3 whole = Matrix3::Zero();
  whole.topLeftCorner<2, 2>() = f;
  whole(2, 2) = normal;
  return whole;
}

PlaneEntries in_plane(const Matrix3& tensor) { return tensor.reshaped()(entries); }

PlaneTangent in_plane(const Tangent& tangent) { return tangent(entries, entries); }

}  // namespace abut
