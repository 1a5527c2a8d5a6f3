#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/fields.hpp"

namespace abut {

/// The coordinator starts the process on another machine, over ssh
/// (docs/adr/0039-bodies-over-ssh.md).
struct SshLaunch {
  static constexpr std::string_view name = "ssh";
  static constexpr std::string_view shorthand = "host";
  std::string host;     // as ssh knows it
  std::string user;     // empty: as ssh's configuration says
  std::string program;  // whole path there; empty: abut-solver on its PATH
  std::string group;    // bodies of one host and group share a process; empty: a process alone
  void fields(Fields& f);

  /// "node7", or "me@node7".
  std::string destination() const;
  /// The program that is started there.
  std::string remote_program() const;
};

struct SshCommand {
  std::string program;
  std::vector<std::string> arguments;
};

/// Runs the solver of `launch` with these arguments, at a socket `there` of its machine that leads
/// to the socket `here` of this one. Both are paths of letters, digits and `/._-`. What ssh is to
/// do otherwise, its own configuration says; $ABUT_SSH names another program in its place.
SshCommand ssh_command(const SshLaunch& launch, const std::string& here, const std::string& there,
                       const std::vector<std::string>& arguments);

/// A path for a socket on another machine, that nobody can guess.
std::string far_socket();

}  // namespace abut
