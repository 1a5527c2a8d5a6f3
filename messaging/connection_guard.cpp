#include "messaging/connection_guard.hpp"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>

#include "base/error.hpp"

namespace abut {

namespace {

constexpr std::size_t most_ended = 4096;  // that nobody has asked for yet
// By which a report may come after the first frame; a frame that was read after its connection had
// ended says nothing of the next one with this descriptor.
constexpr std::chrono::seconds report_delay{2};

/// [B] that have come over a connection; nothing: it is none over TCP.
std::optional<std::uint64_t> bytes_received(int descriptor) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return std::nullopt;
  return info.tcpi_bytes_received;
}

/// What the system has kept of it is forgotten at once, other than by shutdown(): libzmq finds the
/// connection ended and closes it.
void abort_connection(int descriptor) {
  sockaddr none{};
  none.sa_family = AF_UNSPEC;
  (void)connect(descriptor, &none, sizeof none);
}

void watch(int poll, int descriptor, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  event.data.fd = descriptor;
  (void)epoll_ctl(poll, EPOLL_CTL_ADD, descriptor, &event);
}

}  // namespace

ConnectionGuard::ConnectionGuard(zmq::context_t& context, zmq::socket_t& watched,
                                 std::size_t most_bytes)
    : most_bytes_(most_bytes),
      monitor_(context, watched),
      poll_(epoll_create1(EPOLL_CLOEXEC)),
      stop_(eventfd(0, EFD_CLOEXEC)) {
  if (poll_ < 0 || stop_ < 0) {
    throw RunError("cannot watch connections", "messaging",
                   "look at the limits of open files of this machine");
  }
  watch(poll_, stop_, EPOLLIN);
  watch(poll_, monitor_.descriptor(), EPOLLIN);
  thread_ = std::thread([this] { run(); });
}

ConnectionGuard::~ConnectionGuard() {
  const std::uint64_t one = 1;
  (void)!write(stop_, &one, sizeof one);
  thread_.join();
  close(stop_);
  close(poll_);
}

void ConnectionGuard::run() {
  std::array<epoll_event, 64> ready;
  for (int count = 0;;) {
    const auto end = ready.begin() + std::max(count, 0);
    if (std::any_of(ready.begin(), end,
                    [this](const epoll_event& e) { return e.data.fd == stop_; }))
      return;
    {  // before the first wait, too: libzmq wakes nobody who has not found its queue empty
      const std::lock_guard lock(mutex_);
      while (const std::optional<ZmqMonitor::Event> event = monitor_.next()) see(*event);
      for (auto e = ready.begin(); e != end; ++e) judge(e->data.fd);
      count_unknown();
    }
    count = epoll_wait(poll_, ready.data(), static_cast<int>(ready.size()), -1);
    if (count < 0 && errno != EINTR) return;
  }
}

void ConnectionGuard::see(const ZmqMonitor::Event& event) {
  if (event.kind == ZmqMonitor::Kind::accepted) accept(event.descriptor);
  if (event.kind == ZmqMonitor::Kind::ended) end(event.descriptor);
}

void ConnectionGuard::accept(int descriptor) {
  Connection& connection = open_[descriptor];
  connection = {};
  if (const auto known = early_.find(descriptor); known != early_.end()) {
    const auto age = std::chrono::steady_clock::now() - known->second.when;
    if (age < report_delay) connection.peer = known->second.peer;
    early_.erase(known);
  }
  connection.watched = !connection.peer && bytes_received(descriptor).has_value();
  // What is there already is told as well.
  if (connection.watched) watch(poll_, descriptor, EPOLLIN | EPOLLET);
}

void ConnectionGuard::end(int descriptor) {
  early_.erase(descriptor);
  const auto found = open_.find(descriptor);
  if (found != open_.end()) {
    const std::optional<int> peer = found->second.peer;
    open_.erase(found);  // who closes a descriptor ends its watch
    const auto same = [peer](const auto& entry) { return entry.second.peer == peer; };
    if (peer && std::none_of(open_.begin(), open_.end(), same)) lost_.insert(*peer);
  }
  if (!lost_.empty() && ended_.size() < most_ended) ended_.push_back(descriptor);
}

void ConnectionGuard::judge(int descriptor) {
  const auto found = open_.find(descriptor);
  if (found == open_.end() || !found->second.watched) return;
  if (bytes_received(descriptor).value_or(0) <= most_bytes_) return;
  if (!may_be_back(found->second)) abort_connection(descriptor);
}

/// A peer whose connection was lost may come back with a long frame: so many are let through.
bool ConnectionGuard::may_be_back(Connection& connection) {
  const auto granted =
      std::count_if(open_.begin(), open_.end(), [](const auto& c) { return c.second.granted; });
  const auto most = std::ssize(lost_);
  if (!connection.granted && granted < most) return connection.granted = true;
  return connection.granted && granted <= most;
}

void ConnectionGuard::count_unknown() {
  unknown_.store(static_cast<int>(std::count_if(open_.begin(), open_.end(),
                                                [](const auto& c) { return !c.second.peer; })),
                 std::memory_order_relaxed);
}

void ConnectionGuard::know(int descriptor, int peer) {
  const std::lock_guard lock(mutex_);
  lost_.erase(peer);
  const auto found = open_.find(descriptor);
  if (found == open_.end()) {
    early_[descriptor] = {peer, std::chrono::steady_clock::now()};
    return;
  }
  if (found->second.watched) (void)epoll_ctl(poll_, EPOLL_CTL_DEL, descriptor, nullptr);
  found->second = {peer, false, false};
  count_unknown();
}

std::optional<int> ConnectionGuard::next_ended() {
  const std::lock_guard lock(mutex_);
  if (ended_.empty()) return std::nullopt;
  const int descriptor = ended_.front();
  ended_.pop_front();
  return descriptor;
}

}  // namespace abut
