#include "coordinator/record/progress_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>

#include "base/log.hpp"
#include "coordinator/record/shares.hpp"
#include "coordinator/record/time_words.hpp"

namespace abut {

namespace {

constexpr std::size_t named_bodies = 2;  // the line is to fit a terminal
constexpr std::size_t most_columns = 99;

double seconds(Clock::Duration duration) { return std::chrono::duration<double>(duration).count(); }

/// How long elsewhere than on a terminal after so many seconds: ten seconds, and then a twentieth
/// of the time so far.
Clock::Duration interval(double wall) {
  const std::chrono::duration<double> length(std::max(10.0, wall / 20.0));
  return std::chrono::duration_cast<Clock::Duration>(length);
}

}  // namespace

void ProgressLine::on_start(const RunStart& start) {
  begin_ = start.begin;
  end_ = start.end;
  for (const Description* body : start.bodies) bodies_.push_back(body->name);
  began_ = clock_.now();
  if (!terminal_) next_ = began_ + interval(0.0);
}

void ProgressLine::on_window(const WindowReport& report) {
  if (std::exchange(first_, false)) remaining_.start(part_of(report.window.begin));
  const Clock::Time now = clock_.now();
  if (now < next_) return;
  const double wall = seconds(now - began_);
  const std::string line = text(report, wall);
  remaining_.add(wall, part_of(report.window.end));
  if (!terminal_) {
    next_ = now + interval(wall);
    return log_info(line);
  }
  next_ = now + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r\x1b[K%s", line.substr(0, most_columns).c_str());
  std::fflush(stderr);
  shown_ = true;
}

std::string ProgressLine::text(const WindowReport& report, double wall) const {
  const double part = part_of(report.window.end);
  const std::optional<double> left = remaining_.left(wall, part);
  const std::string contacts =
      closed_ == 0 ? "free" : fmt::format("{} contact{}", closed_, closed_ == 1 ? "" : "s");
  return fmt::format("{:5.1f} %  time {:.4e} {}{}  {}  {}", 100.0 * part, report.window.end,
                     second_, left ? fmt::format("  {} left", time_words(*left)) : "", contacts,
                     shares_words(shares_of(waited_, wall), bodies_, named_bodies));
}

void ProgressLine::on_event(const RunEvent& event) {
  erase();
  if (event.kind == RunEvent::Kind::contact_closed) ++closed_;
  if (event.kind == RunEvent::Kind::contact_opened && closed_ > 0) --closed_;
  if (event.thrown) return;
  const bool named =
      event.subject.empty() || event.text.find("'" + event.subject + "'") != std::string::npos;
  const std::string line = fmt::format("{:.6e} {}: {}{}", event.time, second_,
                                       named ? "" : event.subject + ": ", event.text);
  if (event.kind == RunEvent::Kind::failure)
    log_error(line);
  else if (event.kind == RunEvent::Kind::warning)
    log_warning(line);
  else
    log_info(line);
}

void ProgressLine::on_end(const RunEnd&) { erase(); }

void ProgressLine::erase() {
  if (!shown_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  shown_ = false;
}

}  // namespace abut
