#pragma once

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Volume ratios below which a law is stiffened in the passive way, and above which no one looks.
constexpr double crushed = 0.4, nearly_crushed = 0.6;

/// Adds to a law's response c (J0/J - 1)^3, c = 0.2 `p_wave` [Pa], where J = det F is below J0 =
/// 0.4: laws without an answer to compression let cells turn inside out [M.140]. Twice
/// differentiable, and nothing above.
void guard_against_crushing(const Matrix3& f, double p_wave, Need want, PointResponse& out);

}  // namespace abut
