#pragma once

#include <vector>

#include <Eigen/Core>

namespace abut {

/// The outside of a part in space.
struct Outside {
  int dim = 2;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> facets;
};

/// [m] how far `moving` can go along a direction before it meets `other`; infinity: it passes by.
double way_to(const Outside& moving, const Outside& other, const Eigen::Vector3d& direction);

}  // namespace abut
