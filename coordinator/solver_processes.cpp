#include "coordinator/solver_processes.hpp"

#include <fmt/format.h>

#include <map>
#include <optional>
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
  if (const SshLaunch* launch = std::get_if<SshLaunch>(&entry.launch))
    return launch->group.empty()
               ? ""
               : fmt::format("group {} on {}", launch->group, launch->destination());
  if (processes == 0 || !is_dealt(entry)) return {};
  return fmt::format("process {}", dealt++ % static_cast<std::size_t>(processes));
}

std::string program_of(const BodyEntry& entry) {
  if (const GroupLaunch* launch = std::get_if<GroupLaunch>(&entry.launch)) return launch->program;
  if (const SshLaunch* launch = std::get_if<SshLaunch>(&entry.launch)) return launch->program;
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

bool may_run_elsewhere(const BodyEntry& entry) {
  return std::holds_alternative<ConnectLaunch>(entry.launch) ||
         std::holds_alternative<SshLaunch>(entry.launch);
}

bool starts_our_solver(const BodyEntry& entry) {
  return !may_run_elsewhere(entry) && program_of(entry).empty();
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
    const SshLaunch* const ssh = std::get_if<SshLaunch>(&entry.launch);
    processes.push_back(
        {program_of(entry), {b}, ssh != nullptr ? std::optional(*ssh) : std::nullopt, false});
  }
  return processes;
}

std::vector<SolverProcess> all_processes(const Scene& scene) {
  std::vector<SolverProcess> processes = solver_processes(scene);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (std::holds_alternative<ConnectLaunch>(scene.bodies[b].second.launch))
      processes.push_back({"", {b}, std::nullopt, true});
  return processes;
}

std::string name_of_process(const Scene& scene, const SolverProcess& process) {
  if (process.bodies.size() == 1) return scene.bodies[process.bodies.front()].first;
  const std::string name = fmt::format("process-{}", process.bodies.front());
  for (const auto& [body, entry] : scene.bodies)
    if (body == name)
      throw InputError("is the name that a process of several bodies has", "bodies." + body,
                       "Give this body another name.");
  return name;
}

void check_groups(const Scene& scene, const Document& document) {
  std::map<std::string, std::pair<std::string, std::string>> first;  // body and program, by group
  InputErrors errors;
  for (const auto& [name, entry] : scene.bodies) {
    std::size_t none = 0;
    const std::string group = key_of(entry, 0, none);
    if (group.empty()) continue;
    const std::string program = program_of(entry);
    const auto [known, fresh] = first.emplace(group, std::pair(name, program));
    const auto& [body, its_program] = known->second;
    if (fresh || its_program == program) continue;
    const bool far = std::holds_alternative<SshLaunch>(entry.launch);
    errors.add(
        {fmt::format("names the program {}, but {} of the same {} names {}",
                     words_of_program(program), body, group, words_of_program(its_program)),
         document.where(fmt::format("bodies.{}.launch.{}.program", name, far ? "ssh" : "group")),
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
