#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "base/clock.hpp"

namespace abut {

/// A stretch of the clock in which a program was busy with one thing.
struct Span {
  std::string_view what;        // of a word that lives as long as the program
  std::int64_t number = -1;     // of those of its kind; -1: not counted
  std::string label;            // which one, for people; may be empty
  double from = 0.0, to = 0.0;  // [s] of the scene; equal: of no time of it
  Clock::Time began{}, ended{};
};

/// Who is told of spans when they are over; empty: nobody. Must not throw.
using SpanSink = std::function<void(const Span&)>;

/// A span from here to the end of the block. Where nobody listens it looks at no clock.
class SpanScope {
 public:
  /// The sink must outlive it.
  SpanScope(const SpanSink& sink, std::string_view what, std::int64_t number = -1)
      : sink_(sink ? &sink : nullptr) {
    if (sink_ == nullptr) return;
    span_.what = what;
    span_.number = number;
    span_.began = SystemClock().now();
  }
  ~SpanScope() {
    if (sink_ == nullptr) return;
    span_.ended = SystemClock().now();
    (*sink_)(span_);
  }
  SpanScope(const SpanScope&) = delete;
  SpanScope& operator=(const SpanScope&) = delete;

  /// [s] of the scene.
  void covers(double from, double to) { span_.from = from, span_.to = to; }
  /// Whether anybody listens: labels are made only then.
  bool heard() const { return sink_ != nullptr; }
  void label(std::string text) { span_.label = std::move(text); }

 private:
  const SpanSink* sink_;
  Span span_;
};

}  // namespace abut
