#include "messaging/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <thread>

#include "base/error.hpp"

namespace abut {

namespace {

/// In the child, between fork and exec: only calls that are safe after a fork among threads.
[[noreturn]] void become(const char* program, char* const* arguments, pid_t parent, int report,
                         int inherited) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() == parent) {  // else the parent died before the request to die with it
    setpgid(0, 0);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
    // Lines for a terminal that nobody reads, and files at their limit, are errors and no death.
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    const int null = open("/dev/null", O_RDONLY);
    if (null >= 0) dup2(null, STDIN_FILENO);
    if (inherited >= 0) fcntl(inherited, F_SETFD, 0);  // open beyond exec
    execvp(program, arguments);  // a name without a slash is looked up on PATH
  }
  const int error = errno;
  (void)!write(report, &error, sizeof error);
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const std::string& program, const std::vector<std::string>& arguments,
                           int inherited) {
  const std::string remedy = "build abut-solver beside abut, or name the program in launch.spawn";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  std::array<int, 2> report{};
  if (pipe2(report.data(), O_CLOEXEC) != 0) {
    throw RunError(fmt::format("no pipe for a new process: {}", std::strerror(errno)), program,
                   "raise the limit of open files");
  }
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(program.c_str(), argv.data(), parent, report[1], inherited);
  const int fork_error = errno;
  close(report[1]);
  int error = pid_ < 0 ? fork_error : 0;
  // The pipe closes by itself at exec; bytes in it are the reason why there was none.
  if (pid_ > 0 && ::read(report[0], &error, sizeof error) <= 0) error = 0;
  close(report[0]);
  if (error == 0) {
    descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
    return;
  }
  if (pid_ > 0) waitpid(pid_, nullptr, 0);
  throw RunError(fmt::format("cannot start {}: {}", program, std::strerror(error)), program,
                 remedy);
}

ChildProcess::~ChildProcess() {
  if (!ended(Milliseconds(0))) {
    send_signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  if (descriptor_ >= 0) close(descriptor_);
}

bool ChildProcess::reap() {
  siginfo_t info{};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG) == 0 &&
      info.si_pid == pid_) {
    ended_ = true;
    code_ = info.si_code;
    status_ = info.si_status;
  }
  return ended_;
}

bool ChildProcess::ended(Milliseconds wait) {
  if (ended_ || reap()) return true;
  const TimePoint until = std::chrono::steady_clock::now() + wait;
  for (;;) {
    const Milliseconds left =
        std::chrono::ceil<Milliseconds>(until - std::chrono::steady_clock::now());
    if (left.count() <= 0) return reap();
    if (descriptor_ >= 0) {
      pollfd watched{descriptor_, POLLIN, 0};
      poll(&watched, 1, static_cast<int>(left.count()));
    } else {
      std::this_thread::sleep_for(std::min(left, Milliseconds(2)));
    }
    if (reap()) return true;
  }
}

void ChildProcess::send_signal(int signal) {
  if (!ended_) kill(pid_, signal);
}

std::string ChildProcess::ending() const {
  if (!ended_) return "is running";
  if (!ssh_to_.empty()) return ending_elsewhere();
  if (code_ == CLD_EXITED) return fmt::format("exited with code {}", status_);
  return fmt::format("was killed by signal {} ({})", status_, strsignal(status_));
}

/// ssh ends with 255 where it fails itself, and a shell with 128 + signal.
std::string ChildProcess::ending_elsewhere() const {
  constexpr int code_of_ssh = 255, first_signal = 128;
  if (code_ != CLD_EXITED)
    return fmt::format("lost its ssh to {}, which was killed by signal {} ({})", ssh_to_, status_,
                       strsignal(status_));
  if (status_ == code_of_ssh)
    return fmt::format("lost its ssh to {} (code {})", ssh_to_, code_of_ssh);
  if (status_ > first_signal)
    return fmt::format("was killed by signal {} ({}) at {}", status_ - first_signal,
                       strsignal(status_ - first_signal), ssh_to_);
  return fmt::format("exited with code {} at {}", status_, ssh_to_);
}

bool ChildProcess::exited_with(int code) const {
  return ended_ && code_ == CLD_EXITED && status_ == code;
}

}  // namespace abut
