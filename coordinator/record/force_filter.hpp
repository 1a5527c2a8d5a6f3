#pragma once

#include <memory>

#include "base/archive.hpp"
#include "coordinator/force_filter_spec.hpp"

namespace abut {

/// The largest value that a force takes behind a filter. Forces are exact in time: linear or
/// constant over stretches of any length, which come in the order of time; where they leave time
/// out, and before and after all of them, there is no force. Memory is bounded whatever the number
/// of stretches.
class ForceFilter {
 public:
  virtual ~ForceFilter() = default;
  /// A stretch of time with the forces at its ends [s] [N].
  virtual void add(double from, double to, double force_from, double force_to) = 0;
  /// [N]; 0 when the force never pressed. Nothing is added after it.
  virtual double peak() = 0;
  virtual void state(Archive& archive) = 0;
};

std::unique_ptr<ForceFilter> make_force_filter(const ForceFilterSpec& spec);

}  // namespace abut
