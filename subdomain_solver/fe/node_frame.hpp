#pragma once

#include <cstdint>

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Orthonormal frame of one node (dim x dim, columns are its axes): the node's coordinates q are
/// components along them, which makes an inclined roller a prescribed coordinate.
struct NodeFrame {
  std::int32_t node = 0;
  Matrix3 axes = Matrix3::Identity();
};

}  // namespace abut
