#include "messaging/serve.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <random>
#include <utility>

#include "base/denormals.hpp"
#include "base/index.hpp"
#include "base/life_signs.hpp"
#include "base/printable.hpp"
#include "contract/kernel_parts.hpp"
#include "contract/no_answer.hpp"
#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"
#include "messaging/soundness.hpp"

namespace abut {

namespace {

std::uint64_t random_session() {
  std::random_device device;  // tells processes apart; decides nothing that is computed
  return (std::uint64_t{device()} << 32) | device() | 1;  // never 0, which is no session
}

}  // namespace

Server::Server(std::string body, MakeBody make, Channel& channel, Liveness& coordinator,
               const Limits& limits, const Deadlines& deadlines)
    : name_(std::move(body)),
      make_(std::move(make)),
      channel_(channel),
      coordinator_(coordinator),
      limits_(limits),
      deadlines_(deadlines),
      session_(random_session()),
      reply_limit_(limits.frame_bytes) {}

void Server::say_hello() {
  v1::Reply greeting;
  greeting.set_session(session_);
  v1::Hello& hello = *greeting.mutable_hello();
  hello.set_protocol(protocol_version);
  hello.set_build(build_version());
  hello.set_body(name_);
  hello.set_pid(getpid());
  hello.set_session(session_);
  hello.set_last_request(executed_);
  Frame frame;
  frame.seal(greeting);
  channel_.send(frame.bytes());
}

void Server::greet(Milliseconds patience) {
  const TimePoint begin = channel_.now();
  while (!welcome_) {
    greet_when_due(begin, patience);
    if (const std::optional<Bytes> frame = channel_.receive(deadlines_.slice)) handle(*frame);
  }
}

void Server::greet_when_due(TimePoint begin, Milliseconds patience) {
  if (welcome_) return;
  const TimePoint now = channel_.now();
  if (now - begin >= patience) {
    const std::string foreign =
        foreign_ > 0 ? fmt::format("; {} requests of another session came", foreign_) : "";
    throw CoordinatorLost(
        fmt::format("no coordinator has answered body '{}' within {} s{}", name_,
                    static_cast<double>(patience.count()) / 1000.0, foreign),
        "",
        "start `abut run` with the scene that has this body and this endpoint, and keys at "
        "both ends or at none");
  }
  if (now < next_hello_) return;
  say_hello();
  next_hello_ = now + deadlines_.hello;
}

bool Server::step(Milliseconds wait) {
  if (const std::optional<Bytes> frame = channel_.receive(wait)) return handle(*frame);
  check_coordinator();
  return !finished_;
}

void Server::check_coordinator() {
  const std::string loss = coordinator_.loss(channel_.now());
  if (loss.empty()) return;
  throw CoordinatorLost(fmt::format("the coordinator of body '{}' {}", name_, loss), "",
                        "look at the coordinator's own messages");
}

bool Server::handle(Bytes frame) {
  if (frame.size() > limits_.frame_bytes) return true;  // as a damaged one: the coordinator repeats
  const std::optional<Bytes> payload = open_frame(frame);
  if (!payload || !parse_into(request_, *payload, bulk_)) return true;
  if (!is_mine()) {
    ++foreign_;
    return true;
  }
  if (handle_greeting()) return true;
  welcome_ = true;  // a request says as much as a Welcome that was lost
  if (request_.number() < executed_ || request_.number() == 0) return true;  // late: long answered
  if (request_.number() > executed_) execute();
  channel_.send(reply_frame_.bytes(), reply_frame_.owner());
  return !finished_;
}

/// For this process, not for one that had this name before. A refusal may come from a coordinator
/// that could not read the Hello.
bool Server::is_mine() const {
  return request_.session() == session_ || (request_.has_refuse() && request_.session() == 0);
}

bool Server::handle_greeting() {
  if (request_.has_refuse()) {
    throw CoordinatorLost(fmt::format("the coordinator refuses body '{}': {}", name_,
                                      printable(request_.refuse().reason())),
                          "",
                          "look at the coordinator's own messages, then start this solver again");
  }
  if (!request_.has_welcome()) return false;
  welcome_ = true;
  if (request_.welcome().frame_limit() > 0) {
    reply_limit_ = std::min<std::size_t>(limits_.frame_bytes, request_.welcome().frame_limit());
  }
  return true;
}

void Server::execute() {
  const std::uint64_t number = request_.number();
  try {
    if (number != executed_ + 1) {
      fault(v1::FAULT_KIND_RUN,
            fmt::format(
                "request {} follows request {}: this solver has not taken part from the begin",
                number, executed_),
            name_, "start the run again");
    } else {
      dispatch();
    }
  } catch (const CoordinatorLost&) {
    throw;  // nobody is left to answer
  } catch (const InputError& error) {
    fault(v1::FAULT_KIND_INPUT, error.what_is_wrong, error.where, error.remedy);
  } catch (const RunError& error) {
    fault(v1::FAULT_KIND_RUN, error.what_is_wrong, error.where, error.remedy);
  } catch (const CodecError& error) {
    fault(v1::FAULT_KIND_RUN, fmt::format("unsound request: {}", error.what()), name_,
          "this is a fault of the coordinator, not of the scene");
  } catch (const std::bad_alloc&) {
    fault(v1::FAULT_KIND_RUN, fmt::format("body '{}' has used up the memory of its machine", name_),
          "", "make its mesh coarser, or run it on a machine with more memory");
  } catch (const std::exception& error) {
    fault(v1::FAULT_KIND_RUN, error.what(), name_, "this is a fault of the solver");
  }
  executed_ = number;
  reply_.set_number(number);
  reply_.set_session(session_);
  seal_reply();
}

void Server::seal_reply() {
  const bool sealed = reply_.has_advanced() || reply_.has_passive_stepped();
  if (!sealed) reply_frame_.seal(reply_);
  const std::size_t size = reply_frame_.bytes().size();
  if (size <= reply_limit_) return;
  fault(v1::FAULT_KIND_RUN,
        fmt::format("the reply would be a frame of {} bytes, above the limit of {}", size,
                    reply_limit_),
        name_, remedy_of_large_frame(request_));
  reply_frame_.seal(reply_);
}

void Server::fault(v1::FaultKind kind, const std::string& what, const std::string& where,
                   const std::string& remedy) {
  v1::Fault& fault = *reply_.mutable_fault();
  fault.set_kind(kind);
  fault.set_what(what);
  fault.set_where(where);
  fault.set_remedy(remedy);
}

void Server::dispatch() {
  next_progress_ = channel_.now() + deadlines_.progress;
  if (request_.has_finish()) {
    reply_.mutable_finished();
    finished_ = true;
    return;
  }
  if (request_.has_ping()) {
    reply_.mutable_pong();
    return;
  }
  if (request_.has_configure()) {
    configure(request_.configure());
    return;
  }
  if (!body_) throw CodecError("the body is not configured");
  if (request_.restore_first() && !saved_) throw CodecError("restore_first comes before any save");
  if (request_.restore_first()) body_->restore();
  if (request_.save_first()) body_->save();
  saved_ = saved_ || request_.save_first();
  switch (request_.body_case()) {
    case v1::Request::kAdvance:
      advance();
      return;
    case v1::Request::kMeet:
      meet(request_.meet());
      return;
    case v1::Request::kProbe:
      probe(request_.probe());
      return;
    case v1::Request::kCheckpoint: {
      const std::vector<std::byte> state = body_->checkpoint();
      reply_.mutable_checkpoint()->set_state(state.data(), state.size());
      return;
    }
    case v1::Request::kResume:
      body_->resume(std::as_bytes(std::span<const char>(request_.resume().state())));
      reply_.mutable_resumed();
      return;
    case v1::Request::kHash:
      reply_.mutable_hash()->set_hash(body_->state_hash());
      return;
    case v1::Request::kMeasure: {
      const std::vector<double> values = body_->measure();
      reply_.mutable_measure()->mutable_values()->Assign(values.begin(), values.end());
      return;
    }
    case v1::Request::kGrid:
      encode(body_->grid(), *reply_.mutable_grid());
      return;
    case v1::Request::kFields:
      encode(body_->fields(), *reply_.mutable_fields());
      return;
    default:
      if (!answer_passive()) throw CodecError("the request is empty or unknown");
  }
}

/// False where the request is not about the passive form.
bool Server::answer_passive() {
  switch (request_.body_case()) {
    case v1::Request::kPassiveStep:
      passive_step();
      return true;
    case v1::Request::kPassiveEnter:
      reply_.mutable_passive_entered()->set_lost(passive().enter());
      return true;
    case v1::Request::kPassiveLeave:
      passive_leave(request_.passive_leave().time());
      return true;
    case v1::Request::kPassiveDamp: {
      const double joules = number(request_.passive_damp().joules(),
                                   FieldPath{nullptr, "passive_damp.joules"}, Allow::not_negative);
      reply_.mutable_passive_damped()->set_taken(passive().damp(joules));
      return true;
    }
    default:
      return false;
  }
}

void Server::configure(const v1::Configure& wire) {
  Specification specification;
  decode(wire, specification);
  // Large meshes and reductions take their time. The channel is this thread's again before it is
  // used here: ZeroMQ allows sockets to change hands.
  LifeSigns life([this] { show_progress(); }, deadlines_.progress);
  body_ = make_(specification, [this] { show_progress(); });
  life.end();
  partners_.assign(body_->describe().ports.size(), {});
  encode(body_->describe(), *reply_.mutable_configured()->mutable_description());
}

void Server::meet(const v1::Meet& request) {
  ReceivedMeeting received;
  decode(request, body_->describe(), partners_, received);
  Meeting& meeting = received.meeting;
  reply_.mutable_met();
  if (meeting.surface != nullptr) {
    const FieldPath meet{nullptr, "meet"};
    require_sound(*meeting.surface, FieldPath{&meet, "surface"});
  }
  if (received.first) {
    if (!gather(received)) return;
    meeting.kernel = &gathered_->kernel;
  }
  body_->meet(meeting);
  gathered_.reset();
  if (meeting.surface != nullptr) partners_[meeting.port].push_back(size_of(*meeting.surface));
}

/// Whether the kernel is whole with this part.
bool Server::gather(const ReceivedMeeting& part) {
  const int first = *part.first, end = first + part.kernel.patterns;
  if (first == 0) {
    gathered_ = ReceivedMeeting{part.meeting, {}, room_for(part.kernel, part.patterns), 0, 0};
  } else if (!gathered_ || gathered_->first != first ||
             gathered_->meeting.port != part.meeting.port ||
             gathered_->meeting.partner != part.meeting.partner ||
             !fits(part.kernel, first, gathered_->kernel)) {
    gathered_.reset();
    throw CodecError("meet.first does not follow the parts before");
  }
  put(part.kernel, first, gathered_->kernel);
  gathered_->first = end;
  return end == part.patterns;
}

void Server::probe(const v1::Probe& request) {
  Probing probing;
  decode(request, body_->describe(), probing);
  refuse_large(
      sizeof(double) * probing.patterns.size() * index(probing.count),
      fmt::format("a kernel of {} substeps for {} values", probing.count, probing.patterns.size()));
  try {
    encode(body_->probe(probing), *reply_.mutable_kernel());
  } catch (const NoAnswer& error) {
    encode(error.failed, *reply_.mutable_failed());
  }
}

/// The reply with what goes straight into the frame as its body.
template <class... From>
void Server::seal_around(int field, const From&... from) {
  WireWriter& out = reply_frame_.open();
  encode(from..., out);
  out.close(field, 0);
  out.integer(v1::Reply::kSessionFieldNumber, static_cast<std::int64_t>(session_));
  out.integer(v1::Reply::kNumberFieldNumber, static_cast<std::int64_t>(request_.number()));
  reply_frame_.seal();
}

void Server::advance() {
  decode(bulk_, body_->describe(), partners_, advance_);
  require_taken(advance_, body_->describe());
  const Outcome outcome = body_->advance(advance_, response_);
  if (const Failed* failed = std::get_if<Failed>(&outcome)) {
    encode(*failed, *reply_.mutable_failed());
    return;
  }
  reply_.mutable_advanced();  // the mark of its kind: the frame is written here
  seal_around(v1::Reply::kAdvancedFieldNumber, response_, advance_);
}

PassiveForm& Server::passive() {
  PassiveForm* const form = body_->passive();
  if (form == nullptr)
    throw RunError("the body has no passive form", name_,
                   "this is a fault of the coordinator, or of a description that says it has one");
  return *form;
}

void Server::passive_step() {
  PassiveForm& form = passive();
  decode(bulk_, body_->describe(), passive_step_);
  const std::size_t values = pressed_values(passive_step_, body_->describe());
  const auto refuse = [&](std::size_t numbers) {
    refuse_large(sizeof(double) * numbers,
                 fmt::format("the compliance of {} pressed values", values));
  };
  // Before it is made, but where a body may bound it.
  if (values <= PassiveReply::most_whole) refuse(values * values);
  form.start(passive_step_);
  const Outcome outcome = form.finish(passive_reply_);
  refuse(passive_reply_.compliance.size());
  if (const Failed* failed = std::get_if<Failed>(&outcome)) {
    encode(*failed, *reply_.mutable_failed());
    return;
  }
  reply_.mutable_passive_stepped();
  seal_around(v1::Reply::kPassiveSteppedFieldNumber, passive_reply_);
}

void Server::passive_leave(double time) {
  double lost = 0.0;
  const Outcome outcome =
      passive().leave(number(time, FieldPath{nullptr, "passive_leave.time"}), lost);
  if (const Failed* failed = std::get_if<Failed>(&outcome)) {
    encode(*failed, *reply_.mutable_failed());
  } else {
    reply_.mutable_passive_left()->set_lost(lost);
  }
}

/// Looked at before it is made: a body would use up its memory on what cannot be sent.
void Server::refuse_large(std::size_t least, const std::string& what) const {
  if (least <= reply_limit_) return;
  throw RunError(fmt::format("{} is a frame of more than {} bytes, above the limit of {}", what,
                             least, reply_limit_),
                 name_, remedy_of_large_frame(request_));
}

void Server::show_progress() {
  // Substeps may be much shorter than a look at the clock: look the more rarely the more often
  // called.
  if (++hook_calls_ < hook_stride_) return;
  hook_calls_ = 0;
  const TimePoint now = channel_.now();
  const TimePoint::duration since = now - last_look_;
  last_look_ = now;
  if (since < deadlines_.progress / 1000 && hook_stride_ < 4096) hook_stride_ *= 2;
  if (since > deadlines_.progress / 10) hook_stride_ = 1;
  if (now < next_progress_) return;
  next_progress_ = now + deadlines_.progress;
  v1::Reply progress;
  progress.set_number(request_.number());
  progress.set_session(session_);
  progress.mutable_progress();
  progress_frame_.seal(progress);
  channel_.send(progress_frame_.bytes());
  check_coordinator();
}

void serve(Server& server, Milliseconds patience) {
  const FlushedDenormals flushed;  // as in the coordinator: equal bits in every placement
  server.greet(patience);
  while (server.step(Milliseconds(100))) {
  }
}

}  // namespace abut
