#pragma once

#include <cstdint>
#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// Nodes of a matrix in groups of neighbours that it couples strongly, each around a node whose
/// strong neighbours were all free (P. Vanek, J. Mandel, M. Brezina, Computing 56, 1996, algorithm
/// 5.1). `matrix` is symmetric, `nodes` (rows) the node of each row, ascending from 0 without gaps.
/// A coupling is strong where |A_kl|^2 > weak^2 |A_kk| |A_ll|, sizes of the nodes' blocks. (nodes)
/// the group of each, from 0 on.
std::vector<std::int32_t> aggregates(const SparseMatrix& matrix,
                                     const std::vector<std::int32_t>& nodes, double weak);

}  // namespace abut
