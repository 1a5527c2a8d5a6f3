#include "coordinator/record/progress_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "base/log.hpp"

namespace abut {

void ProgressLine::on_start(const RunStart& start) {
  begin_ = start.begin;
  end_ = start.end;
  for (const InterfaceInfo& interface : start.interfaces) names_.push_back(interface.name);
}

void ProgressLine::on_window(const WindowReport& report) {
  int iterations = 1;
  for (const InterfaceReport& interface : report.interfaces)
    iterations = std::max(iterations, interface.iterations);
  solves_ += iterations * static_cast<std::int64_t>(report.responses.size());
  if (!terminal_ || clock_.now() < next_) return;
  next_ = clock_.now() + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r\x1b[K%s", text(report).c_str());
  std::fflush(stderr);
  shown_ = true;
}

std::string ProgressLine::text(const WindowReport& report) const {
  std::string state;
  for (std::size_t i = 0; i < report.interfaces.size(); ++i)
    if (report.interfaces[i].closed) state += (state.empty() ? "" : ", ") + names_[i];
  state = state.empty() ? "free" : "contact at " + state;
  const double part = (report.window.end - begin_) / (end_ - begin_);
  return fmt::format("{:5.1f} %  time {:.4e} s  {}  {} solves", 100.0 * part, report.window.end,
                     state, solves_);
}

void ProgressLine::on_event(const RunEvent& event) {
  erase();
  if (event.thrown) return;
  const bool named = event.subject.empty() ||
                     event.text.find("'" + event.subject + "'") != std::string::npos;
  const std::string line = fmt::format("{:.6e} s: {}{}", event.time,
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
