#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clock.hpp"
#include "base/span.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// trace.json: what a run's wall time went into, as events of Chrome's trace format, which Perfetto
/// and others open: a track of the coordinator (windows, islands, iterations, waits) and
/// one of each body (requests, and what of them was computing). It is whole JSON whenever it is
/// written, twice a second and at the end.
///
/// At most `limit` bytes, about: when half of what is left is taken, three of four of the windows
/// that were kept are left out from then on, so that the file goes on to the end of any run. A
/// file that cannot be written costs a warning and the rest of the trace, not the run.
class SpanFile : public Observer {
 public:
  static constexpr std::int64_t usual_limit = 64'000'000;
  /// Makes the file. Throws RunError.
  explicit SpanFile(const std::filesystem::path& path, std::int64_t limit = usual_limit);
  ~SpanFile() override;
  SpanFile(const SpanFile&) = delete;
  SpanFile& operator=(const SpanFile&) = delete;

  /// Of a stage, or after a loss: who the bodies are, and the number of the process of each; -1:
  /// they compute here.
  void begin(const std::vector<std::string>& bodies, const std::vector<int>& processes);
  /// Of the coordinator.
  void tell(const Span& span) noexcept;
  /// A body is asked for something, and has answered. `computed` [s], as it tells: replies say how
  /// long, not when; it is put at the begin of a request to another process, behind what that
  /// process was asked before, and at the end of one that is answered here.
  void asked(std::size_t body) noexcept;
  void answered(std::size_t body, std::string_view what, double computed) noexcept;
  /// Whoever is asked now will not answer: an error ends the run.
  void lost() noexcept;

  void on_event(const RunEvent& event) override;
  /// What is under way is told as far as it has come.
  void on_end(const RunEnd& end) override;

  std::int64_t every() const { return every_; }  // window that is kept

 private:
  struct Track {
    int process = -1;
    std::optional<Clock::Time> asked;
  };
  void name(int track, const std::string& name);
  void add(int track, std::string_view what, Clock::Time from, Clock::Time to,
           const std::string& arguments = "");
  void add_answer(std::size_t body, std::string_view what, double computed);
  void see_window(std::int64_t number);
  void end_outer(const Span& span);
  void drop_pending();
  void keep_pending();
  void write();
  void give_up(const std::string& why) noexcept;
  void finish();  // what is pending is written
  double micros(Clock::Time time) const;

  std::optional<TextFile> file_;  // absent: it could not be written on
  Clock::Time began_;
  std::string pending_;                        // since the last window ended
  std::string kept_;                           // before that, and not written yet
  Clock::Time next_{};                         // time to write
  std::int64_t limit_, taken_ = 0, room_ = 0;  // bytes
  std::int64_t every_ = 1, seen_ = 0, window_ = -1;
  bool keep_ = true, cut_ = false;
  std::vector<std::string> names_;
  std::vector<Track> tracks_;
  std::vector<Clock::Time> busy_;  // until when, by process
  int under_way_ = 0;
  Clock::Time waits_{};
};

}  // namespace abut
