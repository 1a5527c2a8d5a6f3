#pragma once

#include <optional>
#include <span>
#include <string>

namespace abut {

/// Tells explicit steps how fast their model can vibrate about its present state.
class FrequencyWatch {
 public:
  struct Bound {
    double square = 0.0;        // [1/s^2] that of no frequency of the tangent is above it
    int block = -1, cell = -1;  // of the cell that decides, where one is known
  };
  enum class Effort {
    bounded,  // a bound within a few percent, at limited cost
    exact     // above `from` only if a cell is, then that of one such cell
  };

  virtual ~FrequencyWatch() = default;
  /// A bound of at least `from` [1/s^2]: slower cells are not told apart. None: q is inadmissible.
  [[nodiscard]] virtual std::optional<Bound> bound(std::span<const double> q,
                                                   std::span<const double> history, double from,
                                                   Effort effort) = 0;
  /// The cell of a bound, for people.
  virtual std::string place(const Bound& bound) const = 0;
  /// Steps between two questions that keep the cost of bounds below a twentieth of the steps'.
  virtual int least_interval() const = 0;
};

}  // namespace abut
