#include "coordinator/launched_process.hpp"

#include <fmt/format.h>

#include <cstddef>

namespace abut {

namespace {

constexpr std::size_t most_listed = 20;                      // of bodies that share a process
constexpr int code_of_ssh = 255, code_of_no_program = 127;  // of ssh itself, and of a shell there

/// What to do about a solver of another machine that has ended at once.
std::string remedy_over_ssh(const SshLaunch& launch, const ChildProcess& ssh) {
  const std::string to = launch.destination();
  if (ssh.exited_with(code_of_ssh))
    return fmt::format(
        "look at the words of ssh above; `ssh -o BatchMode=yes {} true` must work "
        "without a question, and its sshd must let sockets through "
        "(AllowStreamLocalForwarding)",
        to);
  if (ssh.exited_with(code_of_no_program))
    return fmt::format(
        "install abut there: `ssh {} {} --version` must work; or give "
        "launch.ssh.program",
        to, launch.remote_program());
  return "look at the solver's own messages above";
}

}  // namespace

void LaunchedProcess::start(const std::string& socket) {
  std::vector<std::string> arguments;
  const int memory = linked ? linked->descriptor() : -1;
  if (memory >= 0) arguments.insert(arguments.end(), {"--memory", std::to_string(memory)});
  if (!routing_id.empty()) arguments.insert(arguments.end(), {"--process", routing_id});
  for (const std::string& body : bodies) arguments.insert(arguments.end(), {"--body", body});
  if (ssh) {
    const SshCommand command = ssh_command(*ssh, socket, far_socket(), arguments);
    try {
      child = std::make_unique<ChildProcess>(command.program, command.arguments, memory);
    } catch (const RunError& error) {
      throw RunError(error.what_is_wrong, error.where,
                     "install ssh (openssh-client), or name its program in ABUT_SSH");
    }
    child->is_ssh_to(ssh->destination());
    return;
  }
  arguments.insert(arguments.begin(), {"--connect", "ipc://" + socket});
  child = std::make_unique<ChildProcess>(program, arguments, memory);
  if (linked) linked->handed_over();
}

std::string LaunchedProcess::others_than(const std::string& body) const {
  std::string names;
  std::size_t count = 0;
  for (const std::string& other : bodies) {
    if (other == body || count++ >= most_listed) continue;
    names += (names.empty() ? "" : ", ") + other;
  }
  if (count > most_listed) names += fmt::format(" and {} more bodies", count - most_listed);
  return names;
}

RunError LaunchedProcess::ended_early(const std::string& body) const {
  const std::string others = others_than(body);
  return RunError(fmt::format("the solver of body '{}'{} {} before it had connected", body,
                              others.empty() ? "" : " and of " + others, child->ending()),
                  "",
                  ssh ? remedy_over_ssh(*ssh, *child) : "look at the solver's own messages above");
}

}  // namespace abut
