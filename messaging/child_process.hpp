#pragma once

#include <sys/types.h>

#include <string>
#include <utility>
#include <vector>

#include "messaging/channel.hpp"

namespace abut {

/// A process that this one has started and that does not outlive it: the kernel kills it when the
/// thread that started it ends. It has a process group of its own, so that Ctrl-C reaches the
/// parent alone.
class ChildProcess {
 public:
  /// Of the descriptors of this process that are closed elsewhere it keeps `inherited`, where that
  /// is none below 0. Throws RunError when the program cannot be started.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
               int inherited = -1);
  /// Kills what is still running and waits for it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  /// It runs ssh, whose exit code is that of a program at this place.
  void is_ssh_to(std::string destination) { ssh_to_ = std::move(destination); }
  /// Waits at most so long for the process to end; true when it has ended.
  bool ended(Milliseconds wait);
  void send_signal(int signal);
  /// How it ended: "exited with code 3", "was killed by signal 9 (Killed)", "lost its
  /// ssh to node7 (code 255)".
  std::string ending() const;
  /// True when it ended by itself with this code.
  bool exited_with(int code) const;

 private:
  bool reap();

  std::string ending_elsewhere() const;

  pid_t pid_ = -1;
  std::string ssh_to_;   // empty: it runs no ssh
  int descriptor_ = -1;  // pidfd; -1 where the kernel has none
  bool ended_ = false;
  int code_ = 0;    // as waitid tells: CLD_EXITED, CLD_KILLED, CLD_DUMPED
  int status_ = 0;  // exit code or signal
};

}  // namespace abut
