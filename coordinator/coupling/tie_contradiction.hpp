#pragma once

#include <string>

#include <Eigen/Dense>

#include "coordinator/coupling/tie_layout.hpp"

namespace abut {

/// Ties that ask for what cannot be: of jumps [m] in blocks, `rest` is what no force answers. Where
/// the other part is within the tolerance and the rest is not, motions are given to both sides that
/// differ, and no sweep makes them one: words that tell the
/// interfaces, their bodies, where, how far, and the remedy. Else none.
std::string find_contradiction(const TieLayout& layout, const Eigen::VectorXd& jump,
                               const Eigen::VectorXd& rest, double tolerance, double time,
                               const Bodies& bodies);

}  // namespace abut
