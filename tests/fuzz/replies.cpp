// Replies of a hostile solver, in a valid session, to requests of ours: the first part of an input
// is its Configured; each other two are a request, as it may have been, and the reply to it.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "messaging/liveness.hpp"
#include "messaging/remote_subdomain.hpp"
#include "tests/fuzz/hostile_input.hpp"
#include "tests/fuzz/hostile_message.hpp"

namespace {

using namespace abut;

constexpr std::uint64_t session = 7;

/// Answers each request once, with the payload that is given; then time passes in vain.
class OneReply : public Channel {
 public:
  using Channel::send;
  bool send(Bytes frame) override {
    v1::Request request;
    const std::optional<Bytes> payload = open_frame(frame);
    ABUT_ASSERT(payload &&
                request.ParseFromArray(payload->data(), static_cast<int>(payload->size())));
    number_ = request.number();
    return true;
  }
  std::optional<Bytes> receive(Milliseconds wait) override {
    if (reply_)
      return fuzz::seal<v1::Reply>(frame_, *std::exchange(reply_, std::nullopt), number_, session);
    now_ += std::max(wait, Milliseconds(1'000));
    return std::nullopt;
  }
  TimePoint now() const override { return now_; }
  void put(Bytes reply) { reply_ = reply; }

 private:
  std::optional<Bytes> reply_;
  std::uint64_t number_ = 0;
  Frame frame_;
  TimePoint now_{};
};

/// A coordinator's side of one body.
class Asker {
 public:
  void configure(fuzz::Input reply) {
    caller_.accept_session(session);
    channel_.put(reply);
    body_.start_configure(Specification{});
    body_.finish_configure();
    partners_.assign(body_.describe().ports.size(), {});
  }
  /// Asks what the request says, where it can be asked of this body.
  void ask(fuzz::Input request, fuzz::Input reply) {
    v1::Request wanted;
    Bytes bulk;
    if (!parse_into(wanted, request, bulk)) return;
    channel_.put(reply);
    try {
      ask(wanted, bulk);
    } catch (const CodecError&) {  // of the request: nobody asks so
    }
  }

 private:
  void ask(const v1::Request& wanted, Bytes bulk) {
    const Description& body = body_.describe();
    if (wanted.has_advance()) {
      decode(bulk, body, partners_, advance_);
      (void)body_.advance(advance_, response_);
    } else if (wanted.has_passive_step() && body.can.passive) {
      decode(bulk, body, step_);
      body_.passive()->start(step_);
      (void)body_.passive()->finish(passive_reply_);
    } else if (wanted.has_probe()) {
      Probing probing;
      decode(wanted.probe(), body, probing);
      if (!probing.patterns.empty()) body_.probe(probing);
    } else if (wanted.has_meet()) {
      ReceivedMeeting received;
      decode(wanted.meet(), body, partners_, received);
      if (received.meeting.surface == nullptr) return;
      require_sound(*received.meeting.surface, FieldPath{nullptr, "surface"});
      received.meeting.kernel = nullptr;
      body_.meet(received.meeting);
      partners_[index(received.meeting.port)].push_back(size_of(*received.meeting.surface));
    } else {
      ask_plainly(wanted);
    }
  }
  void ask_plainly(const v1::Request& wanted) {
    if (wanted.has_grid()) body_.grid();
    if (wanted.has_fields() && !body_.describe().fields.empty()) body_.fields();
    if (wanted.has_measure()) body_.measure();
    if (wanted.has_hash()) body_.state_hash();
    if (wanted.has_checkpoint()) body_.checkpoint();
    if (wanted.has_resume()) body_.resume({});
    if (wanted.has_ping()) body_.ping();
    if (!body_.describe().can.passive) return;
    double lost = 0.0;
    if (wanted.has_passive_enter()) body_.passive()->enter();
    if (wanted.has_passive_leave()) (void)body_.passive()->leave(0.0, lost);
    if (wanted.has_passive_damp()) body_.passive()->damp(1.0);
  }

  OneReply channel_;
  AlwaysAlive alive_;
  Limits limits_{.frame_bytes = 1 << 20};
  Caller caller_{"body", CallContext{channel_, alive_, nullptr, limits_, Deadlines{}}};
  RemoteSubdomain body_{caller_};
  Partners partners_;
  Advance advance_;
  Response response_;
  PassiveStep step_;
  PassiveReply passive_reply_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input rest = fuzz::input_of(data, size);
  fuzz::read_or_refuse([&rest] {
    Asker asker;
    asker.configure(fuzz::take_part(rest));
    while (!rest.empty()) {
      const fuzz::Input request = fuzz::take_part(rest), reply = fuzz::take_part(rest);
      asker.ask(request, reply);
    }
  });
  return 0;
}
