#pragma once

#include <limits>

#include "surface/facet_overlap.hpp"

namespace abut {

struct MortarOptions {
  // [m] pairs whose gap at the overlap's middle is larger, of either sign, are not joined
  double reach = std::numeric_limits<double>::infinity();
  // facets are joined when their mean normals have n_K.n_N <= -facing; above 0
  double facing = 0.5;
  // rows with less than this share of their node's full weight are merged; 0: none is
  double merge = 0.25;
  // ... with neighbours whose gap differs by less than this share of the node's size
  double level = 0.02;
  // overlaps below this share of the facet of K use its shape functions instead of a dual basis
  double dual_from = 1.0e-4;
  PieceQuadrature quadrature = PieceQuadrature::seven_points;
};

}  // namespace abut
