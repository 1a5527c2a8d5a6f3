#pragma once

#include <span>

#include <Eigen/Core>

#include "contract/port.hpp"

namespace abut {

/// The rotation of a port as a whole: that which brings its points nearest to where displacements
/// [m] (n, dim) have taken them, apart from their centres. (dim, dim); of one point none.
Eigen::MatrixXd turn_of(const PortGeometry& port, std::span<const double> displacement);

}  // namespace abut
