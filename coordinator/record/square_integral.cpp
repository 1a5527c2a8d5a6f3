#include "coordinator/record/square_integral.hpp"

#include <algorithm>
#include <cmath>

#include "base/archive_lists.hpp"

namespace abut {

void SquareIntegral::add(double begin, double end, double at_begin, double at_end) {
  const double from = std::max(begin, from_);
  const double to = std::min(end, to_);
  if (!(to > from)) return;
  const double slope = (at_end - at_begin) / (end - begin);
  const double first = at_begin + slope * (from - begin);
  const double last = at_end + slope * (to - end);
  sum_ += 0.5 * (first * first + last * last) * (to - from);
  covered_ += to - from;
  largest_ = std::max({largest_, std::abs(first), std::abs(last)});
}

void SquareIntegral::take(const SquareIntegral& other) {
  sum_ += other.sum_;
  covered_ += other.covered_;
  largest_ = std::max(largest_, other.largest_);
}

double SquareIntegral::bare() const {
  const double length = to_ - from_;
  // Thousands of stretches leave rounding between them, whose root would be far above round-off.
  const double rounding = 1e-11 * length;
  return length - covered_ > rounding ? length - covered_ : 0.0;
}

void StepError::expect(double from, double to, double exact) {
  if (to > from) pieces_.push_back({exact, SquareIntegral(from, to)});
}

void StepError::add(double begin, double end, double at_begin, double at_end, double scale) {
  while (next_ < pieces_.size() && pieces_[next_].integral.end() <= begin) ++next_;
  for (std::size_t p = next_; p < pieces_.size() && pieces_[p].integral.begin() < end; ++p)
    pieces_[p].integral.add(begin, end, (at_begin - pieces_[p].exact) / scale,
                            (at_end - pieces_[p].exact) / scale);
}

double StepError::rms(double scale) const {
  double sum = 0.0, length = 0.0;
  for (const Piece& piece : pieces_) {
    const double error = piece.exact / scale;
    sum += piece.integral.sum() + piece.integral.bare() * error * error;
    length += piece.integral.end() - piece.integral.begin();
  }
  return std::sqrt(sum / length);
}

double StepError::largest(double scale) const {
  double largest = 0.0;
  for (const Piece& piece : pieces_) {
    largest = std::max(largest, piece.integral.largest());
    if (piece.integral.bare() > 0.0) largest = std::max(largest, std::abs(piece.exact / scale));
  }
  return largest;
}

double StepError::rms_of_covered() const {
  double sum = 0.0, covered = 0.0;
  for (const Piece& piece : pieces_) {
    sum += piece.integral.sum();
    covered += piece.integral.covered();
  }
  return covered > 0.0 ? std::sqrt(sum / covered) : std::numeric_limits<double>::quiet_NaN();
}

void SquareIntegral::state(Archive& archive) {
  archive.field("sum", sum_);
  archive.field("covered", covered_);
  archive.field("largest", largest_);
}

void StepError::state(Archive& archive) {
  for (Piece& piece : pieces_) piece.integral.state(archive);
  whole(archive, "next", next_);
}

}  // namespace abut
