#include "coordinator/solver_processes.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <utility>
#include <variant>

#include "base/input_errors.hpp"

namespace abut {

namespace {

/// What tells the process of a body from others; empty: nobody shares it.
std::string key_of(const BodyEntry& entry, int processes, std::size_t& dealt) {
  if (const GroupLaunch* launch = std::get_if<GroupLaunch>(&entry.launch))
    return "group " + launch->group;
  if (processes == 0 || !is_dealt(entry)) return {};
  return fmt::format("process {}", dealt++ % static_cast<std::size_t>(processes));
}

std::string program_of(const BodyEntry& entry) {
  if (const GroupLaunch* launch = std::get_if<GroupLaunch>(&entry.launch)) return launch->program;
  return std::get<SpawnLaunch>(entry.launch).program;
}

std::string words_of_program(const std::string& program) {
  return program.empty() ? "none" : program;
}

}  // namespace

bool is_dealt(const BodyEntry& entry) {
  const SpawnLaunch* launch = std::get_if<SpawnLaunch>(&entry.launch);
  return launch != nullptr && launch->program.empty() && !entry.external;
}

bool starts_our_solver(const BodyEntry& entry) {
  return !std::holds_alternative<ConnectLaunch>(entry.launch) && program_of(entry).empty();
}

std::vector<SolverProcess> solver_processes(const Scene& scene) {
  std::vector<SolverProcess> processes;
  std::map<std::string, std::size_t> number;  // of shared ones, by key
  std::size_t dealt = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyEntry& entry = scene.bodies[b].second;
    if (std::holds_alternative<ConnectLaunch>(entry.launch)) continue;
    const std::string key = key_of(entry, scene.network.processes, dealt);
    if (!key.empty()) {
      const auto [known, fresh] = number.emplace(key, processes.size());
      if (!fresh) {
        processes[known->second].bodies.push_back(b);
        continue;
      }
    }
    processes.push_back({program_of(entry), {b}});
  }
  return processes;
}

void check_groups(const Scene& scene, const Document& document) {
  std::map<std::string, std::pair<std::string, std::string>> first;  // body and program, by group
  InputErrors errors;
  for (const auto& [name, entry] : scene.bodies) {
    const GroupLaunch* launch = std::get_if<GroupLaunch>(&entry.launch);
    if (launch == nullptr) continue;
    const auto [known, fresh] = first.emplace(launch->group, std::pair(name, launch->program));
    const auto& [body, program] = known->second;
    if (fresh || program == launch->program) continue;
    errors.add({fmt::format("names the program {}, but {} of the same group {} names {}",
                            words_of_program(launch->program), body, launch->group,
                            words_of_program(program)),
                document.where(fmt::format("bodies.{}.launch.group.program", name)),
                "Name one program in all bodies of a group, or give them groups of their own."});
  }
  errors.raise();
}

void check_processes(const Scene& scene, const Document& document) {
  const std::size_t count = solver_processes(scene).size();
  if (count <= static_cast<std::size_t>(most_processes)) return;
  throw InputError(
      fmt::format("would be {} processes, more than {}", count, most_processes),
      document.where("bodies"),
      "Give network: {processes: 8}, which deals the bodies to so many, or give several bodies "
      "launch: {group: NAME}.");
}

}  // namespace abut
