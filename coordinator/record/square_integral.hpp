#pragma once

#include <limits>
#include <vector>

#include "base/archive.hpp"

namespace abut {

/// Integral of a square over the part of an interval of time that a run covers, and
/// the largest magnitude there.
class SquareIntegral {
 public:
  SquareIntegral() = default;
  SquareIntegral(double from, double to) : from_(from), to_(to) {}

  /// Adds a stretch of time with the values at its ends, by the trapezoid rule on the square.
  void add(double begin, double end, double at_begin, double at_end);
  /// Adds what another one holds; both have all of time as their interval.
  void take(const SquareIntegral& other);
  double begin() const { return from_; }
  double end() const { return to_; }
  double sum() const { return sum_; }
  double covered() const { return covered_; }  // [s]
  double largest() const { return largest_; }
  double bare() const;  // [s] of the interval where nothing was added

  void state(Archive& archive);

 private:
  double from_ = -std::numeric_limits<double>::infinity();
  double to_ = std::numeric_limits<double>::infinity();
  double sum_ = 0.0, covered_ = 0.0, largest_ = 0.0;
};

/// Root mean square, and largest magnitude, of the difference to a piecewise constant function.
class StepError {
 public:
  /// Compares with `exact` from `from` to `to`; pieces are given in the order of time.
  void expect(double from, double to, double exact);
  /// Adds a stretch of time with the values at its ends, whose error counts as part of `scale`.
  /// Stretches come in the order of time.
  void add(double begin, double end, double at_begin, double at_end, double scale);
  bool empty() const { return pieces_.empty(); }
  double end() const { return pieces_.back().integral.end(); }
  /// Over all pieces, with the value 0 where nothing was added.
  double rms(double scale) const;
  /// Largest magnitude in all pieces, with the value 0 where nothing was added.
  double largest(double scale) const;
  /// Over what was added; NaN when nothing was.
  double rms_of_covered() const;

  void state(Archive& archive);

 private:
  struct Piece {
    double exact;
    SquareIntegral integral;
  };
  std::vector<Piece> pieces_;
  std::size_t next_ = 0;  // pieces before this one have ended
};

}  // namespace abut
