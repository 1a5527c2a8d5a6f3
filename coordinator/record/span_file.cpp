#include "coordinator/record/span_file.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/log.hpp"

namespace abut {

namespace {

constexpr std::string_view list_ending = "\n]\n";
constexpr std::size_t most_pending = 1u << 24;  // bytes of one window
constexpr std::size_t span_piece = 1u << 16;    // bytes that are written at once
constexpr std::chrono::milliseconds between_writes{500};
constexpr int coordinator_track = 1;

int track_of(std::size_t body) { return static_cast<int>(body) + 2; }

std::string json_text(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string finite_text(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null";
}

bool is_window(std::string_view what) {
  return what == "window" || what == "flight" || what == "passive window";
}

/// In which no other one is.
bool is_outer(std::string_view what) {
  return is_window(what) || what == "start" || what == "checkpoint" || what == "end";
}

}  // namespace

SpanFile::SpanFile(const std::filesystem::path& path, std::int64_t limit)
    : file_(std::in_place, path), began_(SystemClock().now()), limit_(limit), room_(limit / 2) {
  file_->append_ended(
      "[\n{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"tid\":1,"
      "\"args\":{\"name\":\"abut\"}}",
      list_ending);
  name(coordinator_track, "coordinator");
  keep_pending();
}

SpanFile::~SpanFile() { finish(); }

void SpanFile::finish() {
  if (!file_) return;
  try {
    keep_pending();
    write();
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

double SpanFile::micros(Clock::Time time) const {
  return std::chrono::duration<double, std::micro>(time - began_).count();
}

void SpanFile::name(int track, const std::string& name) {
  fmt::format_to(std::back_inserter(pending_),
                 ",\n{{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":{0},\"args\":{{"
                 "\"name\":{1}}}}},\n{{\"name\":\"thread_sort_index\",\"ph\":\"M\",\"pid\":1,"
                 "\"tid\":{0},\"args\":{{\"sort_index\":{0}}}}}",
                 track, json_text(name));
}

void SpanFile::begin(const std::vector<std::string>& bodies, const std::vector<int>& processes) {
  if (names_ != bodies)
    for (std::size_t b = 0; b < bodies.size(); ++b) name(track_of(b), bodies[b]);
  names_ = bodies;
  tracks_.assign(bodies.size(), {});
  int most = -1;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    tracks_[b].process = processes[b];
    most = std::max(most, processes[b]);
  }
  busy_.assign(static_cast<std::size_t>(most + 1), began_);
  under_way_ = 0;
  keep_pending();
}

void SpanFile::add(int track, std::string_view what, Clock::Time from, Clock::Time to,
                   const std::string& arguments) {
  fmt::format_to(std::back_inserter(pending_),
                 ",\n{{\"name\":\"{}\",\"cat\":\"{}\",\"ph\":\"X\",\"ts\":{:.3f},\"dur\":{:.3f},"
                 "\"pid\":1,\"tid\":{}{}}}",
                 what, track == coordinator_track ? "coordinator" : "body", micros(from),
                 std::max(0.0, micros(to) - micros(from)), track, arguments);
}

// ---- the coordinator ----------------------------------------------------------------------------

void SpanFile::tell(const Span& span) noexcept {
  if (!file_) return;
  try {
    if (is_window(span.what)) see_window(span.number);
    std::string arguments;
    if (span.number >= 0) arguments += fmt::format(",\"number\":{}", span.number);
    if (span.to > span.from)
      arguments +=
          fmt::format(",\"from_s\":{},\"to_s\":{}", finite_text(span.from), finite_text(span.to));
    if (!span.label.empty()) arguments += ",\"of\":" + json_text(span.label);
    if (is_window(span.what) && every_ > 1) arguments += fmt::format(",\"one_of\":{}", every_);
    if (is_outer(span.what) && cut_) arguments += ",\"told_in_part\":true";
    if (!arguments.empty()) arguments = ",\"args\":{" + arguments.substr(1) + "}";
    add(coordinator_track, span.what, span.began, span.ended, arguments);
    if (is_outer(span.what)) end_outer(span);
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

/// A window that is gone about in two ways is one.
void SpanFile::see_window(std::int64_t number) {
  if (number == window_) return;
  window_ = number;
  keep_ = seen_++ % every_ == 0;
}

void SpanFile::end_outer(const Span& span) {
  cut_ = false;
  const bool fits = taken_ + static_cast<std::int64_t>(pending_.size()) <= limit_;
  if (is_window(span.what) && !(keep_ && fits))
    pending_.clear();
  else
    keep_pending();
  if (kept_.size() > span_piece || span.ended >= next_) write();
}

/// What one window takes is bounded as well.
void SpanFile::drop_pending() {
  pending_.clear();
  cut_ = true;
}

void SpanFile::keep_pending() {
  taken_ += static_cast<std::int64_t>(pending_.size());
  kept_ += pending_;
  pending_.clear();
  if (taken_ <= room_) return;
  room_ += (limit_ - room_) / 2;
  every_ *= 4;
  const std::size_t before = kept_.size();
  fmt::format_to(std::back_inserter(kept_),
                 ",\n{{\"name\":\"from here on one window of {}\",\"ph\":\"i\",\"s\":\"g\","
                 "\"ts\":{:.3f},\"pid\":1,\"tid\":1}}",
                 every_, micros(SystemClock().now()));
  taken_ += static_cast<std::int64_t>(kept_.size() - before);
  log_info(fmt::format("the trace takes {:.3g} MB: of the windows to come one of {} is kept",
                       1e-6 * static_cast<double>(taken_), every_));
}

void SpanFile::write() {
  next_ = SystemClock().now() + between_writes;
  file_->append_ended(kept_, list_ending);
  kept_.clear();
}

void SpanFile::give_up(const std::string& why) noexcept {
  file_.reset();
  try {
    pending_ = {};
    kept_ = {};
    log_warning(fmt::format("trace.json ends before the run does: {}", why));
  } catch (const std::exception&) {  // memory ends: the run says so itself
  }
}

// ---- bodies -------------------------------------------------------------------------------------

void SpanFile::asked(std::size_t body) noexcept {
  if (!file_) return;
  const Clock::Time now = SystemClock().now();
  tracks_[body].asked = now;
  if (under_way_++ == 0) waits_ = now;
}

void SpanFile::answered(std::size_t body, std::string_view what, double computed) noexcept {
  if (!file_ || !tracks_[body].asked) return;
  try {
    add_answer(body, what, computed);
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

void SpanFile::add_answer(std::size_t body, std::string_view what, double computed) {
  Track& track = tracks_[body];
  const Clock::Time now = SystemClock().now(), asked = *track.asked;
  track.asked.reset();
  add(track_of(body), what, asked, now);
  const auto length = std::min(now - asked, std::chrono::duration_cast<Clock::Duration>(
                                                std::chrono::duration<double>(computed)));
  if (computed > 0.0) {
    Clock::Time from = now - length;
    if (track.process >= 0) {
      Clock::Time& busy = busy_[static_cast<std::size_t>(track.process)];
      from = std::min(std::max(asked, busy), now - length);
      busy = from + length;
    }
    add(track_of(body), "computes", from, from + length);
  }
  if (--under_way_ == 0) add(coordinator_track, "waits", waits_, now);
  if (pending_.size() > most_pending) drop_pending();
}

void SpanFile::lost() noexcept {
  if (!file_) return;
  try {
    const Clock::Time now = SystemClock().now();
    for (std::size_t b = 0; b < tracks_.size(); ++b)
      if (tracks_[b].asked)
        add(track_of(b), "no answer", *std::exchange(tracks_[b].asked, std::nullopt), now);
    if (std::exchange(under_way_, 0) > 0) add(coordinator_track, "waits", waits_, now);
  } catch (const std::exception& error) {
    give_up(error.what());
  }
}

// ---- of the run ---------------------------------------------------------------------------------

void SpanFile::on_event(const RunEvent& event) {
  if (!file_ || event.kind == RunEvent::Kind::warning) return;
  const double now = micros(SystemClock().now());
  fmt::format_to(std::back_inserter(pending_),
                 ",\n{{\"name\":{},\"ph\":\"i\",\"s\":\"t\",\"ts\":{:.3f},\"pid\":1,\"tid\":1,"
                 "\"args\":{{\"time_s\":{},\"text\":{}}}}}",
                 json_text(std::string(to_string(event.kind)) + " " + event.subject), now,
                 finite_text(event.time), json_text(event.text));
}

void SpanFile::on_end(const RunEnd&) {
  if (!file_) return;
  lost();
  finish();
}

}  // namespace abut
