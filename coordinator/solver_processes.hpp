#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// More than so many processes of one run make a machine slower and no solve faster.
inline constexpr int most_processes = 64;

/// A process of a run.
struct SolverProcess {
  std::string program;              // empty: abut-solver beside abut
  std::vector<std::size_t> bodies;  // that live in it, in the scene's order
  std::optional<SshLaunch> ssh;     // absent: on this machine
  bool connects = false;            // somebody else starts it
};

/// Whether network.processes decides where the body lives.
bool is_dealt(const BodyEntry& entry);

/// Whether the body's process may be on another machine.
bool may_run_elsewhere(const BodyEntry& entry);

/// Whether the coordinator starts abut-solver of this machine for the body.
bool starts_our_solver(const BodyEntry& entry);

/// One process for each group, one for each body that is spawned alone, and those that
/// network.processes deals the others to in turns; in the order of their first bodies.
std::vector<SolverProcess> solver_processes(const Scene& scene);

/// The same, and after them those of bodies with launch: connect.
std::vector<SolverProcess> all_processes(const Scene& scene);
/// By which name a process comes that somebody else starts: its body's; of several bodies
/// "process-K", where the first of them is the scene's body K. Throws InputError where a body has
/// that name.
std::string name_of_process(const Scene& scene, const SolverProcess& process);

/// Refuses a group of several programs. Throws InputError.
void check_groups(const Scene& scene, const Document& document);
/// Refuses a scene that would start more processes than `most_processes`. Throws InputError.
void check_processes(const Scene& scene, const Document& document);

}  // namespace abut
