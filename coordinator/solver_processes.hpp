#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// More than so many processes of one run make a machine slower and no solve faster.
inline constexpr int most_processes = 64;

/// A process that the coordinator starts.
struct SolverProcess {
  std::string program;              // empty: abut-solver beside abut
  std::vector<std::size_t> bodies;  // that live in it, in the scene's order
};

/// Whether network.processes decides where the body lives.
bool is_dealt(const BodyEntry& entry);

/// Whether the coordinator starts abut-solver for the body.
bool starts_our_solver(const BodyEntry& entry);

/// One process for each group, one for each body that is spawned alone, and those that
/// network.processes deals the others to in turns; in the order of their first bodies.
std::vector<SolverProcess> solver_processes(const Scene& scene);

/// Refuses a group of several programs. Throws InputError.
void check_groups(const Scene& scene, const Document& document);
/// Refuses a scene that would start more processes than `most_processes`. Throws InputError.
void check_processes(const Scene& scene, const Document& document);

}  // namespace abut
