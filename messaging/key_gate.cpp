#include "messaging/key_gate.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"

namespace abut {

namespace {

constexpr const char* meeting_point = "inproc://zeromq.zap.01";  // where libzmq asks
constexpr std::size_t parts_of_a_request = 7;  // version, id, domain, address, id of the peer,
                                               // mechanism, key
constexpr std::size_t key_bytes = 32;
constexpr int most_lines = 8;  // of a log, about those who are turned away

void send(zmq::socket_t& socket, std::string_view part, bool last = false) {
  socket.send(zmq::buffer(part), last ? zmq::send_flags::none : zmq::send_flags::sndmore);
}

}  // namespace

KeyGate::KeyGate(zmq::context_t& context, std::map<std::string, std::string> names)
    : names_(std::move(names)),
      requests_(context, zmq::socket_type::rep),
      stop_(eventfd(0, EFD_CLOEXEC)) {
  if (stop_ < 0)
    throw RunError("cannot look at keys", "messaging",
                   "look at the limits of open files of this machine");
  requests_.set(zmq::sockopt::linger, 0);
  requests_.bind(meeting_point);
  thread_ = std::thread([this] { run(); });
}

KeyGate::~KeyGate() {
  const std::uint64_t one = 1;
  (void)!write(stop_, &one, sizeof one);
  thread_.join();
  close(stop_);
}

void KeyGate::run() {
  std::array<zmq_pollitem_t, 2> items{
      {{requests_.handle(), 0, ZMQ_POLLIN, 0}, {nullptr, stop_, ZMQ_POLLIN, 0}}};
  for (;;) {
    if (zmq_poll(items.data(), static_cast<int>(items.size()), -1) < 0 && errno != EINTR) return;
    if (items[1].revents != 0) return;
    if (items[0].revents != 0) answer();
  }
}

void KeyGate::answer() {
  std::vector<zmq::message_t> parts;
  do {
    parts.emplace_back();
    if (!requests_.recv(parts.back())) return;
  } while (parts.back().more());
  const bool sound = parts.size() == parts_of_a_request;
  const std::string name = sound ? judge(parts[5].to_string(), parts[6]) : "";
  if (name.empty()) {
    int count = 0;
    {
      const std::lock_guard lock(mutex_);
      count = ++refused_;
    }
    if (sound && count <= most_lines)
      log_warning(
          fmt::format("somebody at {} was turned away: its key is that of no body that "
                      "this run waits for",
                      printable(parts[3].to_string(), 100)));
  }
  send(requests_, "1.0");
  send(requests_, parts.size() > 1 ? parts[1].to_string_view() : std::string_view());
  send(requests_, name.empty() ? "400" : "200");
  send(requests_, name.empty() ? "No such key" : "OK");
  send(requests_, name);
  send(requests_, "", true);
}

/// The body's name; empty: nobody.
std::string KeyGate::judge(const std::string& mechanism, const zmq::message_t& key) {
  if (mechanism != "CURVE" || key.size() != key_bytes) return {};
  std::array<char, 41> text{};
  if (zmq_z85_encode(text.data(), key.data<std::uint8_t>(), key_bytes) == nullptr) return {};
  const auto found = names_.find(text.data());
  if (found == names_.end()) return {};
  const std::lock_guard lock(mutex_);
  admitted_[found->second] = std::chrono::steady_clock::now();
  return found->second;
}

std::optional<TimePoint> KeyGate::admitted(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = admitted_.find(name);
  if (found == admitted_.end()) return std::nullopt;
  return found->second;
}

int KeyGate::refused() const {
  const std::lock_guard lock(mutex_);
  return refused_;
}

}  // namespace abut
