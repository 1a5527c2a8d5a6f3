#pragma once

#include <optional>
#include <span>
#include <string>

#include "contract/outcome.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// Linear elasticity lets an element be compressed through itself without a word. The failure of a
/// bar of which that has happened, where a strain is -1.5 or less: beyond what fronts overshoot.
/// Ask of accepted states: iterates may lie anywhere. `u` [m] are the displacements of the bar's
/// nodes, from left to right, `spacing` [m] the length of its elements.
std::optional<Failed> compressed_to_nothing(std::span<const double> u, double spacing, double time,
                                            const std::string& body);
/// The same of a mesh in one dimension.
std::optional<Failed> compressed_to_nothing(std::span<const double> u, const Mesh& mesh,
                                            double time, const std::string& body);

}  // namespace abut
