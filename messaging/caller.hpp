#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "abut/v1/subdomain.pb.h"
#include "contract/subdomain.hpp"
#include "messaging/channel.hpp"
#include "messaging/frame.hpp"
#include "messaging/liveness.hpp"
#include "messaging/protocol.hpp"

namespace abut {

/// What binds a caller to its surroundings; all must outlive it.
struct CallContext {
  Channel& channel;
  Liveness& liveness;
  const std::atomic<bool>* interrupted = nullptr;  // set by a signal handler: every wait ends
  Limits limits;
  Deadlines deadlines;
};

/// Numbered requests to one body, one at a time: repeats them when no reply comes, gives up in
/// words when none will come. The body executes each number at most once, so that a repeat is
/// harmless.
class Caller {
 public:
  Caller(std::string body, const CallContext& context);

  /// The message to fill; it still holds the last one, so that its memory is used again.
  v1::Request& request() { return request_; }
  /// Numbers, encodes and sends the request; `verb` names it in error messages and must be a
  /// literal.
  void post(const char* verb);
  /// The same of an Advance, with the flags of request(): its waveforms go straight into the frame.
  void post(const Advance& advance);
  void post(const PassiveStep& step);
  /// Waits for the reply to the request under way. Throws RunError when it will not come, and the
  /// error that the body reports, if it reports one.
  const v1::Reply& await();
  /// Whether it is there already; without a wait.
  bool has_reply();
  /// What the reply holds of an Advanced or PassiveStepped, as it came; valid until the next
  /// request.
  Bytes bulk() const { return bulk_; }
  /// post and await.
  const v1::Reply& call(const char* verb);
  /// Like await, but gives up silently after `time`; false when no sound reply came.
  bool await_at_most(Milliseconds time);
  bool under_way() const { return under_way_; }

  /// After a sound Hello, before the first request. All requests carry this session, and a reply of
  /// another one is nobody's; a later Hello of another one is another solver with this body's name.
  void accept_session(std::uint64_t session) { session_ = session; }
  std::uint64_t session() const { return session_; }
  /// Replies of other sessions that came so far.
  int foreign() const { return foreign_; }
  const std::string& body() const { return body_; }
  std::size_t frame_limit() const { return context_.limits.frame_bytes; }  // [B]
  /// Throws: the reply to the request under way is no answer to it.
  [[noreturn]] void refuse_reply(const std::string& why) const;

 private:
  void number_request(const char* verb);
  template <class Bulk>
  void seal_around(const Bulk& bulk, int field);
  void send_request();
  bool is_reply(Bytes frame);
  void greeted_again(const v1::Hello& hello);
  void look_around();
  void heard(TimePoint when);
  void repeat();
  [[noreturn]] void rethrow(const v1::Fault& fault) const;
  std::string under_way_text() const;

  std::string body_;
  CallContext context_;
  v1::Request request_;
  v1::Reply reply_;
  Bytes bulk_;  // of the reply, in the channel's memory
  Frame frame_;
  const char* verb_ = "";
  std::uint64_t number_ = 0;
  std::uint64_t session_ = 0;  // 0: not greeted yet
  int foreign_ = 0;
  bool under_way_ = false;
  bool replied_ = false;  // to the request under way
  TimePoint begun_{};     // of the request
  TimePoint heard_{};     // the last sign of its body, or of what its process did meanwhile
  TimePoint deadline_{};  // moves with every sign of progress
  Milliseconds patience_{};  // from a sign to the deadline
  TimePoint repeat_at_{};
  Milliseconds pause_{};           // until the next repeat; doubles
  int corrupt_ = 0;                // damaged frames during this request
  std::size_t corrupt_bytes_ = 0;  // size of the last one
};

}  // namespace abut
