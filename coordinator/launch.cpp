#include "coordinator/launch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "coordinator/launched_process.hpp"
#include "coordinator/solver_processes.hpp"
#include "messaging/codec.hpp"
#include "messaging/descriptors.hpp"
#include "messaging/key_files.hpp"
#include "messaging/liveness.hpp"
#include "messaging/remote_subdomain.hpp"
#include "messaging/zmq_channel.hpp"

namespace abut {

namespace {

constexpr Milliseconds time_to_finish{2'000};     // from Finish to the end of the process
constexpr Milliseconds time_to_die{500};          // from SIGTERM to SIGKILL
constexpr std::size_t longest_socket_path = 100;  // the kernel allows 107 bytes
constexpr int most_logins = 8;               // at one host at once; sshd allows ten (MaxStartups)
constexpr const char* socket_name = "/hub";  // in the private folder
// Measured: the hub opens 9 and a process 2; pipes of a start and files of a run come on top.
constexpr int descriptors_of_a_run = 32;
constexpr int descriptors_of_a_process = 4;

Milliseconds milliseconds(double seconds) {
  return Milliseconds(static_cast<Milliseconds::rep>(seconds * 1000.0));
}

/// Not below zero.
Milliseconds time_left(TimePoint until) {
  return std::max(Milliseconds(0),
                  std::chrono::ceil<Milliseconds>(until - std::chrono::steady_clock::now()));
}

/// How long whoever waits for a frame may look for it before it sleeps. To wake another core takes
/// some 25 us; where processes have no core each, looking keeps others from theirs.
std::chrono::microseconds spin_of(std::size_t processes) {
  constexpr std::chrono::microseconds usual{50};
  cpu_set_t cores;
  CPU_ZERO(&cores);
  const bool known = sched_getaffinity(0, sizeof cores, &cores) == 0;
  return known && processes <= static_cast<std::size_t>(CPU_COUNT(&cores))
             ? usual
             : std::chrono::microseconds(0);
}

Frame refusal(std::uint64_t session, const std::string& reason) {
  v1::Request request;
  request.set_session(session);
  request.mutable_refuse()->set_reason(reason);
  Frame out;
  out.seal(request);
  return out;
}

std::string make_private_directory() {
  std::error_code ignored;
  std::string parent = std::filesystem::temp_directory_path(ignored).string();
  // ssh takes whole paths without colons.
  const bool fits = parent.starts_with('/') && parent.find(':') == parent.npos;
  if (ignored || !fits || parent.size() > longest_socket_path - 24) parent = "/tmp";
  std::string name = parent + "/abut-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) {  // readable by this user alone
    throw RunError(fmt::format("cannot make a directory in {}: {}", parent, std::strerror(errno)),
                   "launch", "set TMPDIR to a directory that can be written");
  }
  return name;
}

/// A folder that a scene names counts from the scene's own.
std::string keys_of(const Scene& scene, const std::string& document) {
  if (scene.network.keys.empty()) return {};
  return (std::filesystem::path(document).parent_path() / scene.network.keys).string();
}

/// What somebody types to start a process that is waited for.
std::string command_for(std::string endpoint, const LaunchedProcess& process, bool external,
                        bool keys) {
  const std::size_t wildcard = endpoint.find("//0.0.0.0:");
  if (wildcard != std::string::npos) endpoint.replace(wildcard + 2, 7, "HOST");  // this machine
  const std::string of_several =
      process.routing_id.empty() ? "" : fmt::format(" --process {}", process.routing_id);
  return fmt::format("{} --connect {}{} --body {}{}", external ? "ITS_PROGRAM" : "abut-solver",
                     endpoint, of_several, fmt::join(process.bodies, " --body "),
                     keys ? " --keys DIR" : "");
}

}  // namespace

std::string solver_beside_this_program() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::string("abut-solver") : (self.parent_path() / "abut-solver").string();
}

/// One body, its process, and the way to talk to it.
struct Launch::Member {
  std::string name;
  LaunchedProcess* process = nullptr;
  bool external = false;  // no abut-solver can be this body
  BodyContext context;
  Milliseconds patience{0};
  int peer = 0;
  Channel* way = nullptr;  // of all but its Hello
  std::unique_ptr<Liveness> liveness;
  std::unique_ptr<Caller> caller;
  std::unique_ptr<RemoteSubdomain> body;  // until it is handed out
  bool welcome = false;
  bool described = false;  // or has told what is wrong with it
  InputErrors errors;
};

Launch::Launch(const Scene& scene, const Specification& scene_text, const LaunchOptions& options)
    : options_(options) {
  options_.deadlines.request = milliseconds(scene.network.request_deadline);
  if (options_.solver.empty()) options_.solver = solver_beside_this_program();
  const int processes = static_cast<int>(all_processes(scene).size());
  require_descriptors(descriptors_of_a_run + descriptors_of_a_process * processes);
  hub_ = std::make_unique<ZmqHub>(options_.limits);
  try {
    add_members(scene);
    listen(scene, scene_text.document);
    spawn_all(scene.network.transport);
    greet_all(scene_text);
  } catch (...) {
    end_processes();
    remove_directory();
    throw;
  }
  // Whoever was awaited is here; a socket file that is gone cannot be left behind.
  remove_directory();
}

Launch::~Launch() { end_processes(); }

void Launch::add_processes(const Scene& scene, std::vector<LaunchedProcess*>& process_of) {
  for (const SolverProcess& plan : all_processes(scene)) {
    std::unique_ptr<LaunchedProcess> process = std::make_unique<LaunchedProcess>();
    process->awaited = options_.awaited.has_value() || plan.connects;
    process->ssh = plan.ssh;
    process->ours = plan.program.empty() && !plan.ssh && !process->awaited;
    process->program = process->ours ? options_.solver : plan.program;
    // No body can be called so: names have no blanks.
    if (plan.bodies.size() > 1) {
      process->routing_id = process->awaited ? name_of_process(scene, plan)
                                             : fmt::format("process {}", processes_.size());
    }
    for (const std::size_t body : plan.bodies) {
      process->bodies.push_back(scene.bodies[body].first);
      process_of[body] = process.get();
    }
    processes_.push_back(std::move(process));
  }
}

void Launch::add_members(const Scene& scene) {
  std::vector<LaunchedProcess*> process_of(scene.bodies.size(), nullptr);
  add_processes(scene, process_of);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const auto& [name, entry] = scene.bodies[b];
    std::unique_ptr<Member> member = std::make_unique<Member>();
    member->name = name;
    member->process = process_of[b];
    member->external = entry.external;
    member->context = entry.context;
    const ConnectLaunch* connect = std::get_if<ConnectLaunch>(&entry.launch);
    member->patience =
        milliseconds(connect != nullptr ? connect->patience : scene.network.startup_deadline);
    if (options_.awaited) member->patience = milliseconds(options_.awaited->patience);
    const std::string& shared = member->process->routing_id;
    member->peer = shared.empty() ? hub_->add_peer(name) : hub_->add_peer(name, shared);
    members_.push_back(std::move(member));
  }
}

void Launch::listen(const Scene& scene, const std::string& document) {
  std::vector<std::string> awaited;
  for (const std::unique_ptr<LaunchedProcess>& process : processes_)
    if (process->awaited)
      awaited.push_back(process->routing_id.empty() ? process->bodies.front()
                                                    : process->routing_id);
  if (awaited.size() < processes_.size()) {
    directory_ = make_private_directory();
    ipc_endpoint_ = hub_->bind("ipc://" + directory_ + socket_name);
  }
  if (awaited.empty()) return;
  const std::string keys = options_.awaited ? options_.awaited->keys : keys_of(scene, document);
  const std::string& endpoint =
      options_.awaited ? options_.awaited->endpoint : scene.network.endpoint;
  keyed_ = !keys.empty();
  tcp_endpoint_ =
      keyed_ ? hub_->bind(endpoint, read_coordinator_keys(keys, awaited)) : hub_->bind(endpoint);
  for (const std::unique_ptr<Member>& member : members_) {
    const LaunchedProcess& process = *member->process;
    if (!process.awaited || process.bodies.front() != member->name) continue;
    log_info(fmt::format("waiting for {} '{}': {}", process.bodies.size() > 1 ? "bodies" : "body",
                         fmt::join(process.bodies, "', '"),
                         command_for(tcp_endpoint_, process, member->external, keyed_)));
  }
}

/// With our own solvers alone: others need not know what to do with it.
void Launch::share_memory(LaunchedProcess& process) {
  std::vector<Member*> its;
  std::vector<Channel*> sockets;
  for (const std::unique_ptr<Member>& member : members_) {
    if (member->process != &process) continue;
    its.push_back(member.get());
    sockets.push_back(member->way);
  }
  const auto here = std::ranges::count_if(
      processes_, [](const auto& each) { return !each->ssh && !each->awaited; });
  process.linked =
      LinkedBodies::make(sockets, options_.limits, spin_of(static_cast<std::size_t>(here)));
  if (!process.linked) {
    log_warning("no memory to share with a solver's process: its frames pass through sockets");
    return;
  }
  for (std::size_t number = 0; number < its.size(); ++number)
    its[number]->way = &process.linked->channel(number);
}

void Launch::spawn_all(Transport transport) {
  for (const std::unique_ptr<Member>& member : members_) member->way = &hub_->channel(member->peer);
  for (const std::unique_ptr<LaunchedProcess>& process : processes_)
    if (transport == Transport::automatic && process->ours) share_memory(*process);
  for (const std::unique_ptr<LaunchedProcess>& process : processes_)
    if (!process->ssh || process->awaited) start(*process);
  start_over_ssh();
}

/// A process, and the ways to talk to its bodies.
void Launch::start(LaunchedProcess& process) {
  if (!process.awaited) process.start(directory_ + socket_name);
  process.started = std::chrono::steady_clock::now();
  for (const std::unique_ptr<Member>& member : members_) {
    if (member->process != &process) continue;
    member->liveness = std::make_unique<BodyLiveness>(
        *hub_, member->peer, process.child.get(), process.others_than(member->name),
        options_.limits, options_.deadlines, process.linked.get());
    member->caller = std::make_unique<Caller>(
        member->name, CallContext{*member->way, *member->liveness, options_.interrupted,
                                  options_.limits, options_.deadlines});
    member->body = std::make_unique<RemoteSubdomain>(*member->caller);
  }
}

/// Those whose turn has come: sshd turns connections away while many have not logged in yet.
void Launch::start_over_ssh() {
  const auto on_its_way = [this](const LaunchedProcess& process) {
    return process.started && std::ranges::none_of(members_, [&process](const auto& member) {
             return member->process == &process && member->welcome;
           });
  };
  for (const std::unique_ptr<LaunchedProcess>& process : processes_) {
    if (!process->ssh || process->started) continue;
    const auto logging_in = std::ranges::count_if(processes_, [&](const auto& other) {
      return other->ssh && other->ssh->host == process->ssh->host && on_its_way(*other);
    });
    if (logging_in < most_logins) start(*process);
  }
}

void Launch::greet_all(const Specification& scene_text) {
  TimePoint looked = std::chrono::steady_clock::now();
  const auto is_missing = [this](const std::unique_ptr<Member>& member) {
    return !member->welcome && (!member->process->awaited || !refused_);
  };
  while (std::ranges::any_of(members_, is_missing)) {
    hub_->pump(options_.deadlines.slice);
    refuse_strangers();
    start_over_ssh();
    const bool look = std::chrono::steady_clock::now() - looked >= options_.deadlines.slice;
    if (look) looked = std::chrono::steady_clock::now();
    for (const std::unique_ptr<Member>& member : members_) {
      if (!member->process->started) continue;
      if (member->welcome) {
        if (!member->described && member->caller->has_reply()) see(*member);
      } else if (hub_->has_frame(member->peer) && greet(*member)) {
        configure(*member, scene_text);
      } else if (look) {
        check_startup(*member);
      }
    }
  }
  InputErrors errors;
  for (const std::unique_ptr<Member>& member : members_) {
    if (member->welcome && !member->described) see(*member);
    errors.gather([&member] { member->errors.raise(); });
  }
  errors.raise();
}

/// What the body is, or what is wrong with it: then those that somebody else starts are not waited
/// for.
void Launch::see(Member& member) {
  member.described = true;
  member.errors.gather([&member] { member.body->finish_configure(); });
  refused_ = refused_ || member.errors.count() > 0;
}

/// It builds itself while the others are still on their way. A process has the scene's text once.
void Launch::configure(Member& member, const Specification& scene_text) {
  Specification specification;
  if (!member.process->has_scene) specification = scene_text;
  member.process->has_scene = true;
  // Over ssh another folder is the current one.
  if (member.process->ssh && !specification.document.empty())
    specification.document = std::filesystem::absolute(specification.document).string();
  specification.path = "bodies." + member.name;
  specification.context = member.context;
  member.body->start_configure(specification);
}

/// The last Hello that has come: an earlier one may be of a solver that has been restarted since.
bool Launch::greet(Member& member) {
  v1::Reply reply;
  Bytes bulk;
  bool came = false;
  while (const std::optional<Bytes> frame = hub_->channel(member.peer).receive(Milliseconds(0))) {
    came = true;
    const std::optional<Bytes> payload = open_frame(*frame);
    const bool sound = frame->size() <= options_.limits.frame_bytes && payload &&
                       parse_into(reply, *payload, bulk);
    if (sound && reply.has_hello()) continue;
    throw RunError(
        fmt::format("body '{}' did not say hello: its first frame, of {} bytes (limit {}), "
                    "is {}",
                    member.name, frame->size(), options_.limits.frame_bytes,
                    sound ? "of another kind" : "corrupt or of another program"),
        "", "connect an abut-solver of this version");
  }
  return came && welcome(member, reply.hello());
}

bool Launch::welcome(Member& member, const v1::Hello& hello) {
  if (hello.protocol() != protocol_version) {
    const std::string versions = fmt::format(
        "the solver of body '{}' (build {}) speaks protocol {}, this coordinator (build {}) "
        "speaks protocol {}",
        member.name, printable(hello.build(), 100), hello.protocol(), build_version(),
        protocol_version);
    refuse(member, hello.session(), versions);
    throw RunError(versions, "", "install the same version at both ends");
  }
  if (hello.last_request() > 0) {
    refuse(member, hello.session(), "it has taken part in another run");
    return false;  // a fresh one may still come
  }
  if (hello.session() == 0) {
    const std::string reason = "its Hello has no session";
    refuse(member, 0, reason);
    throw RunError(fmt::format("the solver of body '{}' is no sound one: {}", member.name, reason),
                   "", "let the solver draw a number above 0 when it starts (proto/README.md)");
  }
  v1::Request welcome;
  welcome.set_session(hello.session());
  welcome.mutable_welcome()->set_protocol(protocol_version);
  welcome.mutable_welcome()->set_build(build_version());
  welcome.mutable_welcome()->set_frame_limit(options_.limits.frame_bytes);
  Frame out;
  out.seal(welcome);
  member.way->send(out.bytes());
  member.caller->accept_session(hello.session());
  member.welcome = true;
  return true;
}

void Launch::refuse(const Member& member, std::uint64_t session, const std::string& reason) {
  member.way->send(refusal(session, reason).bytes());
}

void Launch::refuse_strangers() {
  while (const auto stranger = hub_->take_stranger()) {
    std::string names;
    for (const std::unique_ptr<Member>& member : members_) {
      names += (names.empty() ? "" : ", ") + member->name;
    }
    // Where its session cannot be read, the refusal has none.
    v1::Reply hello;
    Bytes bulk;
    const std::optional<Bytes> payload = open_frame(stranger->second);
    if (!payload || !parse_into(hello, *payload, bulk)) hello.Clear();
    const std::string reason = "the scene has no body of this name, only " + names;
    hub_->send_to(stranger->first, refusal(hello.hello().session(), reason).bytes());
  }
}

void Launch::check_startup(Member& member) {
  const LaunchedProcess& process = *member.process;
  const std::string& endpoint = process.awaited ? tcp_endpoint_ : ipc_endpoint_;
  if (options_.interrupted != nullptr && options_.interrupted->load()) {
    throw RunError(fmt::format("interrupted before body '{}' had connected", member.name), "",
                   "start the run again");
  }
  if (process.child && process.child->ended(Milliseconds(0)))
    throw process.ended_early(member.name);
  if (std::chrono::steady_clock::now() - *process.started < member.patience) return;
  const double seconds = static_cast<double>(member.patience.count()) / 1000.0;
  std::string what = fmt::format(
      "body '{}' did not connect to {} within {} s", member.name,
      process.ssh ? "this machine from " + process.ssh->destination() : endpoint, seconds);
  if (hub_->refused() > 0)
    what += fmt::format(", and {} that did were turned away for their keys", hub_->refused());
  if (!process.awaited)
    throw RunError(what, "", "raise network.startup_deadline on a slow machine");
  throw RunError(
      what, "", fmt::format("start `{}`", command_for(endpoint, process, member.external, keyed_)));
}

std::vector<std::unique_ptr<Subdomain>> Launch::take_bodies() {
  std::vector<std::unique_ptr<Subdomain>> bodies;
  for (const std::unique_ptr<Member>& member : members_) {
    ABUT_ASSERT(member->body != nullptr);
    bodies.push_back(std::move(member->body));
  }
  return bodies;
}

void Launch::finish() {
  for (const std::unique_ptr<Member>& member : members_) {
    ABUT_ASSERT(!member->caller->under_way());
    member->caller->request().mutable_finish();
    member->caller->post("finish");
  }
  const TimePoint until = std::chrono::steady_clock::now() + time_to_finish;
  for (const std::unique_ptr<Member>& member : members_) {
    const Milliseconds left = std::max(Milliseconds(1), time_left(until));
    member->caller->await_at_most(left);
  }
  for (const std::unique_ptr<LaunchedProcess>& process : processes_)
    if (process->child) process->child->ended(time_left(until));
  finished_ = true;
  end_processes();
}

std::vector<std::int64_t> Launch::process_ids() const {
  std::vector<std::int64_t> ids;
  for (const std::unique_ptr<LaunchedProcess>& process : processes_)
    if (process->child) ids.push_back(process->child->pid());
  return ids;
}

void Launch::remove_directory() {
  if (directory_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
  directory_.clear();
}

void Launch::end_processes() {
  for (const std::unique_ptr<Member>& member : members_) {
    // Somebody else's solver is told; ours is ended.
    if (!finished_ && member->process->awaited && member->welcome)
      refuse(*member, member->caller->session(), "the run has ended early");
  }
  for (const std::unique_ptr<LaunchedProcess>& process : processes_) {
    if (process->child && !process->child->ended(Milliseconds(0)))
      process->child->send_signal(SIGTERM);
  }
  const TimePoint until = std::chrono::steady_clock::now() + time_to_die;
  for (const std::unique_ptr<LaunchedProcess>& process : processes_) {
    if (!process->child) continue;
    process->child->ended(time_left(until));
    process->child.reset();  // kills what is still there
  }
}

}  // namespace abut
