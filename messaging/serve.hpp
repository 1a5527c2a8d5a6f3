#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "abut/v1/subdomain.pb.h"
#include "base/error.hpp"
#include "contract/subdomain.hpp"
#include "messaging/channel.hpp"
#include "messaging/codec.hpp"
#include "messaging/frame.hpp"
#include "messaging/liveness.hpp"
#include "messaging/protocol.hpp"

namespace abut {

/// Cheap to call between any two substeps: says at most four times a second that the solve still
/// goes on.
using ProgressHook = std::function<void()>;

/// Makes the body when its specification has arrived. Throws InputError when the specification is
/// wrong.
using MakeBody =
    std::function<std::unique_ptr<Subdomain>(const Specification&, const ProgressHook&)>;

/// The coordinator will never ask again. Not an answer to any request: it passes through the body.
class CoordinatorLost : public RunError {
 public:
  using RunError::RunError;
};

/// Answers the requests of one coordinator with any Subdomain. Every number is executed at most
/// once; the last reply is kept, so that a repeated request gets the same answer and nothing runs
/// twice.
class Server {
 public:
  Server(std::string body, MakeBody make, Channel& channel, Liveness& coordinator,
         const Limits& limits, const Deadlines& deadlines);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Says hello until the coordinator answers. Throws RunError after `patience`, or when refused.
  void greet(Milliseconds patience);
  /// The same of a body that waits beside others: says hello when it is time to, as long as nobody
  /// has answered since `begin`.
  void greet_when_due(TimePoint begin, Milliseconds patience);
  /// Handles at most one frame; false after Finish. Throws CoordinatorLost when there is no
  /// coordinator any more.
  bool step(Milliseconds wait);
  /// After Finish.
  bool finished() const { return finished_; }
  /// Throws CoordinatorLost when there is no coordinator any more.
  void check_coordinator();

  /// Drawn for this process; every request and reply carries it.
  std::uint64_t session() const { return session_; }
  /// Requests of other sessions that came so far: for a solver that had this name before.
  int foreign() const { return foreign_; }

 private:
  void say_hello();
  bool handle(Bytes frame);
  bool is_mine() const;
  bool handle_greeting();
  void execute();
  void dispatch();
  void configure(const v1::Configure& specification);
  void meet(const v1::Meet& request);
  bool gather(const ReceivedMeeting& part);
  void probe(const v1::Probe& request);
  void advance();
  bool answer_passive();
  PassiveForm& passive();
  void passive_step();
  void passive_leave(double time);
  void refuse_large(std::size_t least, const std::string& what) const;
  template <class... From>
  void seal_around(int field, const From&... from);
  void fault(v1::FaultKind kind, const std::string& what, const std::string& where,
             const std::string& remedy);
  void seal_reply();
  void show_progress();

  std::string name_;
  MakeBody make_;
  Channel& channel_;
  Liveness& coordinator_;
  Limits limits_;
  Deadlines deadlines_;
  std::unique_ptr<Subdomain> body_;
  Partners partners_;   // that the body has met
  std::optional<ReceivedMeeting> gathered_;  // of a kernel in parts, as far as they have come
  bool saved_ = false;  // there is a state to restore
  v1::Request request_;
  Bytes bulk_;  // the Advance or PassiveStep of the request, in the channel's memory
  v1::Reply reply_;
  Frame reply_frame_, progress_frame_;
  Advance advance_;
  Response response_;
  PassiveStep passive_step_;
  PassiveReply passive_reply_;
  std::uint64_t session_;
  int foreign_ = 0;
  std::uint64_t executed_ = 0;  // number of the last request executed
  std::size_t reply_limit_;     // [bytes]
  bool welcome_ = false;
  bool finished_ = false;
  TimePoint next_hello_{};
  TimePoint next_progress_{};
  TimePoint last_look_{};
  int hook_calls_ = 0;  // since the clock was looked at
  int hook_stride_ = 1;
};

/// The whole of a solver's main after start-up: greets, then answers until Finish.
void serve(Server& server, Milliseconds patience);

}  // namespace abut
