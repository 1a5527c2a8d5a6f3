#pragma once

#include "subdomain_solver/model.hpp"

namespace abut {

// Columns in the inner product of a mass matrix, x . y = x^T M y.

/// x - V V^T M x for orthonormal V (n, m), twice: once leaves the round-off of what is removed.
void remove_components(const Eigen::MatrixXd& v, const SparseMatrix& mass, Eigen::MatrixXd& x);

/// Orthonormal columns of the same span as x (n, k), to round-off; the columns of x are of sizes
/// within 1e6 of each other. Directions of a norm of at most `smallest` are dropped, and those that
/// are round-off of others.
Eigen::MatrixXd orthonormal(Eigen::MatrixXd x, const SparseMatrix& mass, double smallest);

}  // namespace abut
