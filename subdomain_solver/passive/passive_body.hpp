#pragma once

#include <optional>

#include "contract/passive.hpp"

namespace abut {

/// A body that has a passive form [M.128], as its interior offers it: Body is the PassiveForm that
/// others see, and fills the record.
class PassiveBody {
 public:
  /// As PassiveForm has them.
  virtual double enter() = 0;
  [[nodiscard]] virtual std::optional<Failed> leave(double time, double& lost) = 0;
  virtual double damp(double joules) = 0;
  /// From the present state through a step; all of the reply but its record.
  [[nodiscard]] virtual std::optional<Failed> pass(const PassiveStep& step,
                                                   PassiveReply& reply) = 0;

 protected:
  ~PassiveBody() = default;
};

}  // namespace abut
