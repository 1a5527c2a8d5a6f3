#include "coordinator/conformance/wire_trial.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/printable.hpp"
#include "coordinator/conformance/body_trial.hpp"

namespace abut {

namespace {

constexpr Milliseconds time_to_start{10'000};

std::string private_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "abut-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw RunError(fmt::format("cannot make a folder: {}", std::strerror(errno)), name,
                   "set TMPDIR to a folder that can be written");
  return name;
}

std::string told(const v1::Reply& reply) {
  if (!reply.has_fault()) return fmt::format("a reply of kind {}", int{reply.body_case()});
  return fmt::format("the fault \"{}\"", printable(reply.fault().what(), 200));
}

}  // namespace

WireTrial::WireTrial(const Solver& solver)
    : solver_(solver),
      directory_(private_folder()),
      hub_(std::in_place, Limits{}),
      peer_(hub_->add_peer(solver.body)),
      endpoint_(hub_->bind("ipc://" + directory_ + "/hub")),
      process_(solver.program, {"--connect", endpoint_, "--body", solver.body}) {
  const TimePoint until = std::chrono::steady_clock::now() + time_to_start;
  while (std::chrono::steady_clock::now() < until && !process_.ended(Milliseconds(0))) {
    const std::optional<Bytes> frame = hub_->channel(peer_).receive(Milliseconds(100));
    if (!frame) continue;
    v1::Reply reply;
    const std::optional<Bytes> payload = open_frame(*frame);
    if (!payload || !reply.ParseFromArray(payload->data(), static_cast<int>(payload->size())) ||
        !reply.has_hello())
      throw BrokenClause("its first frame is no sound Hello",
                         "proto/README.md, Sockets and frames");
    hello_ = reply.hello();
    return;
  }
  throw BrokenClause(fmt::format("no Hello came within {} s", time_to_start.count() / 1000),
                     "A solver is started with --connect ENDPOINT --body NAME and says Hello.");
}

WireTrial::~WireTrial() {
  std::error_code ignored;
  std::filesystem::remove_all(directory_, ignored);
}

const Description& WireTrial::configure() {
  v1::Request welcome;
  welcome.set_session(hello_.session());
  welcome.mutable_welcome()->set_protocol(protocol_version);
  welcome.mutable_welcome()->set_build(build_version());
  welcome.mutable_welcome()->set_frame_limit(Limits{}.frame_bytes);
  send(welcome);
  v1::Request request = next();
  encode(solver_.specification, *request.mutable_configure());
  const v1::Reply reply = call(request, "Configure");
  if (!reply.has_configured())
    throw BrokenClause("answers Configure by " + told(reply), "It describes itself.");
  decode(reply.configured().description(), description_);
  return description_;
}

v1::Request WireTrial::next() {
  v1::Request request;
  request.set_number(++number_);
  request.set_session(hello_.session());
  return request;
}

v1::Request WireTrial::advance(const Pushed& pushed) {
  v1::Request request = next();
  v1::Advance& ask = *request.mutable_advance();
  ask.mutable_window()->set_begin(pushed.begin);
  ask.mutable_window()->set_end(pushed.begin + pushed.steps * pushed.step);
  ask.set_records(1);
  ask.set_sampling(v1::SAMPLING_RECORDS);
  for (std::size_t p = 0; p < description_.ports.size(); ++p) {
    v1::BoundaryData& boundary = *ask.add_boundary();
    if (p != index(pushed.port) || pushed.force == 0.0) continue;
    const std::size_t width = description_.ports[p].geometry.points.size();
    v1::Waveform& force = *boundary.add_forces();
    force.set_width(static_cast<int>(width));
    force.set_support(v1::FORCE_SUPPORT_STEP);
    force.add_time(pushed.begin);
    force.add_time(ask.window().end());
    for (std::size_t k = 0; k < 2 * width; ++k) force.add_f(pushed.force);
  }
  return request;
}

std::vector<std::byte> WireTrial::frame_of(const v1::Request& request) {
  Frame frame;
  frame.seal(request);
  return {frame.bytes().begin(), frame.bytes().end()};
}

void WireTrial::send(const v1::Request& request) { send(frame_of(request)); }

void WireTrial::send(const std::vector<std::byte>& frame) { hub_->channel(peer_).send(frame); }

std::optional<v1::Reply> WireTrial::reply(Milliseconds wait) {
  TimePoint until = std::chrono::steady_clock::now() + wait;
  while (std::chrono::steady_clock::now() < until) {
    const std::optional<Bytes> frame = hub_->channel(peer_).receive(Milliseconds(50));
    if (!frame && process_.ended(Milliseconds(0)))
      throw BrokenClause(fmt::format("its process {}", process_.ending()),
                         "Whatever comes, a solver answers or goes on waiting.");
    if (!frame) continue;
    v1::Reply reply;
    const std::optional<Bytes> payload = open_frame(*frame);
    if (!payload || !reply.ParseFromArray(payload->data(), static_cast<int>(payload->size())))
      throw BrokenClause("sends a frame that is damaged", "proto/README.md, Sockets and frames");
    if (reply.has_progress()) {
      ++signs_;
      until = std::chrono::steady_clock::now() + wait;
    }
    if (reply.has_hello() || reply.has_progress()) continue;
    payload_.assign(payload->begin(), payload->end());
    return reply;
  }
  return std::nullopt;
}

v1::Reply WireTrial::call(const v1::Request& request, const std::string& what) {
  send(request);
  const std::optional<v1::Reply> got = reply(solver_.deadline);
  if (!got)
    throw BrokenClause(fmt::format("gives no answer to {} within {} s", what,
                                   static_cast<double>(solver_.deadline.count()) / 1000.0),
                       "Every sound request has an answer: a reply, Failed or a Fault.");
  if (got->number() != request.number() || got->session() != request.session())
    throw BrokenClause(
        fmt::format("answers {}, request {} of session {}, by a reply of request "
                    "{} of session {}",
                    what, request.number(), request.session(), got->number(), got->session()),
        "A reply carries the number and session of its request.");
  return *got;
}

}  // namespace abut
