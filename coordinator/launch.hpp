#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/awaited.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"
#include "messaging/protocol.hpp"

namespace abut {

class Caller;
class Liveness;
struct LaunchedProcess;
class RemoteSubdomain;
class ZmqHub;
namespace v1 {
class Hello;
}

/// Path of abut-solver.
std::string solver_beside_this_program();

struct LaunchOptions {
  std::string solver;  // program of spawned bodies; empty: abut-solver beside this program
  const std::atomic<bool>* interrupted = nullptr;  // set by a signal handler: every wait ends
  Limits limits;
  Deadlines deadlines;  // `request` is taken from the scene
  std::optional<Awaited> awaited;
};

/// Body entries to Subdomains in other processes: `spawn`, `group` and `ssh` start them, `connect`
/// waits for one. However this object ends, the processes that it has started end with it.
class Launch {
 public:
  /// Starts and greets all bodies and hands each the scene (`scene_text.path` is filled in per
  /// body). Throws InputError when bodies refuse their keys, of all that are there; RunError when
  /// one does not come in time.
  Launch(const Scene& scene, const Specification& scene_text, const LaunchOptions& options);
  ~Launch();
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

  /// The bodies in the scene's order, once. They must not outlive this object.
  std::vector<std::unique_ptr<Subdomain>> take_bodies();
  /// The orderly end: every body is told to finish, and its process is waited for.
  void finish();
  /// Process ids of the spawned solvers, for tests and for the log.
  std::vector<std::int64_t> process_ids() const;

 private:
  struct Member;
  void add_processes(const Scene& scene, std::vector<LaunchedProcess*>& process_of);
  void add_members(const Scene& scene);
  void listen(const Scene& scene, const std::string& document);
  void share_memory(LaunchedProcess& process);
  void spawn_all(Transport transport);
  void start(LaunchedProcess& process);
  void start_over_ssh();
  void greet_all(const Specification& scene_text);
  bool greet(Member& member);
  void configure(Member& member, const Specification& scene_text);
  void see(Member& member);
  bool welcome(Member& member, const v1::Hello& hello);
  void refuse(const Member& member, std::uint64_t session, const std::string& reason);
  void refuse_strangers();
  void check_startup(Member& member);
  void remove_directory();
  void end_processes();

  LaunchOptions options_;
  std::string directory_;  // private, of the ipc socket; empty when there is none
  std::string ipc_endpoint_, tcp_endpoint_;
  std::unique_ptr<ZmqHub> hub_;
  std::vector<std::unique_ptr<LaunchedProcess>> processes_;
  std::vector<std::unique_ptr<Member>> members_;
  bool keyed_ = false;    // bodies that connect have keys
  bool refused_ = false;  // a body has told what is wrong with it
  bool finished_ = false;
};

}  // namespace abut
