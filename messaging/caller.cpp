#include "messaging/caller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/assert.hpp"
#include "base/error.hpp"
#include "base/printable.hpp"
#include "messaging/codec.hpp"
#include "messaging/codec/wire.hpp"
#include "messaging/lost_body.hpp"

namespace abut {

namespace {
double seconds(Milliseconds time) { return static_cast<double>(time.count()) / 1000.0; }
}  // namespace

const char* build_version() { return ABUT_VERSION; }

Caller::Caller(std::string body, const CallContext& context)
    : body_(std::move(body)), context_(context) {}

std::string Caller::under_way_text() const {
  return fmt::format("{} (request {})", verb_, number_);
}

void Caller::number_request(const char* verb) {
  ABUT_ASSERT(!under_way_ && session_ != 0);
  verb_ = verb;
  request_.set_number(++number_);
  request_.set_session(session_);
}

void Caller::post(const char* verb) {
  number_request(verb);
  frame_.seal(request_);
  send_request();
}

/// The request with what goes straight into the frame as its body.
template <class Bulk>
void Caller::seal_around(const Bulk& bulk, int field) {
  WireWriter& out = frame_.open();
  encode(bulk, out);
  out.close(field, 0);
  out.integer(v1::Request::kSessionFieldNumber, static_cast<std::int64_t>(session_));
  out.integer(v1::Request::kSaveFirstFieldNumber, request_.save_first());
  out.integer(v1::Request::kRestoreFirstFieldNumber, request_.restore_first());
  out.integer(v1::Request::kNumberFieldNumber, static_cast<std::int64_t>(number_));
  frame_.seal();
}

void Caller::post(const Advance& advance) {
  number_request("advance");
  request_.mutable_advance();  // the mark of its kind
  seal_around(advance, v1::Request::kAdvanceFieldNumber);
  send_request();
}

void Caller::post(const PassiveStep& step) {
  number_request("passive step");
  request_.mutable_passive_step();
  seal_around(step, v1::Request::kPassiveStepFieldNumber);
  send_request();
}

void Caller::send_request() {
  const std::size_t size = frame_.bytes().size();
  if (size > context_.limits.frame_bytes) {
    throw RunError(
        fmt::format("{} for body '{}' would be a frame of {} bytes, above the limit of {}",
                    under_way_text(), body_, size, context_.limits.frame_bytes),
        "", remedy_of_large_frame(request_));
  }
  under_way_ = true;
  replied_ = false;
  corrupt_ = 0;
  begun_ = context_.channel.now();
  heard_ = begun_;
  patience_ = context_.deadlines.request;
  deadline_ = begun_ + patience_;
  pause_ = context_.deadlines.repeat;
  repeat_at_ = begun_ + pause_;
  // What the transport refuses now is repeated later.
  context_.channel.send(frame_.bytes(), frame_.owner());
}

const v1::Reply& Caller::call(const char* verb) {
  post(verb);
  return await();
}

const v1::Reply& Caller::await() {
  ABUT_ASSERT(under_way_);
  // Whatever is thrown from here, the request is over.
  struct Over {
    bool& flag;
    ~Over() { flag = false; }
  } over{under_way_};
  Milliseconds wait = std::min(context_.deadlines.slice, pause_);
  while (!replied_) {
    const std::optional<Bytes> frame = context_.channel.receive(wait);
    if (frame && is_reply(*frame)) break;
    look_around();
    const TimePoint next = std::min(repeat_at_, deadline_);
    wait = std::clamp(std::chrono::ceil<Milliseconds>(next - context_.channel.now()),
                      Milliseconds(1), context_.deadlines.slice);
  }
  if (reply_.has_fault()) rethrow(reply_.fault());
  return reply_;
}

bool Caller::has_reply() {
  ABUT_ASSERT(under_way_);
  while (!replied_) {
    const std::optional<Bytes> frame = context_.channel.receive(Milliseconds(0));
    if (!frame) return false;
    replied_ = is_reply(*frame);
  }
  return true;
}

bool Caller::await_at_most(Milliseconds time) {
  patience_ = time;
  deadline_ = context_.channel.now() + time;
  try {
    await();
    return true;
  } catch (const RunError&) {
    return false;
  } catch (const InputError&) {
    return false;
  }
}

bool Caller::is_reply(Bytes frame) {
  if (frame.size() > context_.limits.frame_bytes) {
    throw RunError(
        fmt::format("body '{}' sent a frame of {} bytes while at {}; the limit is {} bytes", body_,
                    frame.size(), under_way_text(), context_.limits.frame_bytes),
        "", remedy_of_large_frame(request_));
  }
  const std::optional<Bytes> payload = open_frame(frame);
  if (!payload || !parse_into(reply_, *payload, bulk_)) {
    // Taken for lost. A peer that sends nothing else is given up.
    corrupt_bytes_ = frame.size();
    if (++corrupt_ < context_.limits.corrupt_frames) {
      repeat();
      return false;
    }
    throw RunError(
        fmt::format("body '{}' sent {} corrupt frames while at {}, the last one of {} bytes "
                    "(limit {} bytes)",
                    body_, corrupt_, under_way_text(), corrupt_bytes_, context_.limits.frame_bytes),
        "", "make sure that an abut-solver of this version is at the other end");
  }
  if (reply_.has_hello()) {
    greeted_again(reply_.hello());
    return false;
  }
  if (reply_.session() != session_) {  // of a solver that had this name before: nobody's
    ++foreign_;
    return false;
  }
  if (reply_.number() != number_) return false;  // repeat of an earlier reply
  if (reply_.has_progress()) {
    // It has the request. Repeats that it cannot look at would fill its queue, and a full queue
    // takes no heartbeats; only when it is silent again may its reply have been lost.
    heard(context_.channel.now());
    return false;
  }
  if (reply_.body_case() == v1::Reply::BODY_NOT_SET) refuse_reply("is empty");
  return true;
}

/// A sign that the body is at work on its request, or on those that came before it.
void Caller::heard(TimePoint when) {
  heard_ = when;
  deadline_ = when + patience_;
  pause_ = context_.deadlines.repeat;
  repeat_at_ = when + pause_;
}

void Caller::greeted_again(const v1::Hello& hello) {
  if (hello.session() != session_) {
    throw LostBody(fmt::format("a second solver with the name of body '{}' has connected", body_),
                   "", "start one solver per body; after the loss of a solver start the run again");
  }
  repeat();  // the connection is new: what was on the old one is lost
}

void Caller::repeat() {
  context_.channel.send(frame_.bytes(), frame_.owner());
  repeat_at_ = context_.channel.now() + pause_;
}

void Caller::look_around() {
  if (context_.interrupted != nullptr && context_.interrupted->load()) {
    throw RunError(fmt::format("interrupted while body '{}' was at {}", body_, under_way_text()),
                   "", "start the run again");
  }
  const std::string loss = context_.liveness.loss(begun_);
  if (!loss.empty()) {
    throw LostBody(fmt::format("body '{}' {} while at {}", body_, loss, under_way_text()), "",
                   "look at the solver's own messages above, then start the run again");
  }
  const TimePoint sign = context_.liveness.last_sign();
  if (sign > heard_) heard(sign);
  const TimePoint now = context_.channel.now();
  if (now >= deadline_) {
    std::string noise;
    if (corrupt_ > 0)
      noise += fmt::format("; {} corrupt frames came, the last one of {} bytes", corrupt_,
                           corrupt_bytes_);
    if (foreign_ > 0) noise += fmt::format("; {} replies of another session came", foreign_);
    throw LostBody(fmt::format("body '{}' has not answered {} within {} s, nor shown progress{}",
                               body_, under_way_text(), seconds(context_.deadlines.request), noise),
                   "", "raise network.request_deadline if one solve may take longer");
  }
  if (now >= repeat_at_) {
    pause_ =
        std::min({2 * pause_, context_.deadlines.request / 10, context_.deadlines.reconnect / 2});
    repeat();
  }
}

void Caller::refuse_reply(const std::string& why) const {
  throw RunError(fmt::format("body '{}' gave no sound answer to {}: {}", body_, under_way_text(),
                             printable(why)),
                 "", "this is a fault of the solver, not of the scene");
}

void Caller::rethrow(const v1::Fault& fault) const {
  const std::string what = printable(fault.what()), where = printable(fault.where()),
                    remedy = printable(fault.remedy());
  if (fault.kind() == v1::FAULT_KIND_INPUT) throw InputError(what, where, remedy);
  throw RunError(fmt::format("body '{}' failed at {}: {}", body_, under_way_text(), what), where,
                 remedy);
}

}  // namespace abut
