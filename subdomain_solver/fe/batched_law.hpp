#pragma once

#include <optional>

#include "subdomain_solver/fe/batched_kernel.hpp"
#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Of laws that exist for several points at once.
std::optional<BatchedLaw> batched_law_of(const Material& material);

}  // namespace abut
