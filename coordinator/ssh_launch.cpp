#include "coordinator/ssh_launch.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <random>

#include "base/shell_word.hpp"

namespace abut {

namespace {

constexpr std::string_view letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789";
constexpr std::size_t longest_host = 253;  // of the domain name system

/// Letters, digits and some marks, which do not begin it: options begin with one.
bool is_plain(std::string_view text, const std::string& marks) {
  return !text.empty() && letters.find(text.front()) != text.npos &&
         text.find_first_not_of(std::string(letters) + marks) == text.npos;
}

bool is_path(std::string_view text) {
  return text.starts_with('/') &&
         text.find_first_not_of(std::string(letters).append("/._+-")) == text.npos;
}

}  // namespace

void SshLaunch::fields(Fields& f) {
  f.required("host", host, "",
             "name of the machine, as ssh knows it: port, key and whatever else ssh needs stand in "
             "its own configuration; launch: {ssh: HOST} is short for launch: {ssh: {host: HOST}}");
  f.optional("user", user, "", "user there; empty: as ssh's configuration says");
  f.optional("program", program, "",
             "path of the solver program there; empty: abut-solver, on the PATH that commands of "
             "ssh have there");
  f.optional("group", group, "",
             "bodies of the same host and group share one process; empty: a process of its own");
  f.check(host.size() <= longest_host && is_plain(host, "._-"), "host",
          fmt::format("can be no machine's name: {}", host),
          "Give letters, digits, '.', '_' and '-' alone, a letter or digit first. What needs more "
          "has a Host entry in ~/.ssh/config.");
  f.check(user.empty() || is_plain(user, "._-"), "user",
          fmt::format("can be no user's name: {}", user),
          "Give letters, digits, '.', '_' and '-' alone, a letter or digit first.");
  f.check(program.empty() || is_path(program), "program",
          fmt::format("is no whole path: {}", program),
          "Write it from / on, of letters, digits and '._+-' alone.");
}

std::string SshLaunch::destination() const { return user.empty() ? host : user + '@' + host; }

std::string SshLaunch::remote_program() const { return program.empty() ? "abut-solver" : program; }

SshCommand ssh_command(const SshLaunch& launch, const std::string& here, const std::string& there,
                       const std::vector<std::string>& arguments) {
  const char* named = std::getenv("ABUT_SSH");
  SshCommand command{named != nullptr && *named != '\0' ? named : "ssh", {}};
  // Asks nothing, has a connection of its own, and lends nothing of this machine but one socket.
  command.arguments = {"-T", "-a", "-x"};
  for (const char* option :
       {"BatchMode=yes", "ControlPath=none", "PermitLocalCommand=no", "ExitOnForwardFailure=yes"})
    command.arguments.insert(command.arguments.end(), {"-o", option});
  command.arguments.insert(command.arguments.end(), {"-R", there + ':' + here});
  if (!launch.user.empty()) command.arguments.insert(command.arguments.end(), {"-l", launch.user});
  // ssh leaves its socket there; the shell that waits for the solver removes it.
  std::string line = fmt::format(
      "exec sh -c {} {} {} --connect {}", quoted_word("trap \"rm -f $0\" EXIT; \"$@\""),
      quoted_word(there), quoted_word(launch.remote_program()), quoted_word("ipc://" + there));
  for (const std::string& argument : arguments) line += ' ' + quoted_word(argument);
  command.arguments.insert(command.arguments.end(), {"--", launch.host, line});
  return command;
}

std::string far_socket() {
  std::random_device device;  // the kernel's; decides nothing that is computed
  std::string name = "/tmp/abut-";
  for (int i = 0; i < 4; ++i) name += fmt::format("{:08x}", device());
  return name;
}

}  // namespace abut
