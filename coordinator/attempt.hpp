#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/outcome.hpp"
#include "coordinator/coupling/convergence.hpp"
#include "coordinator/coupling/schwarz.hpp"

namespace abut {

/// What trying a window by the accurate method has come to.
struct Attempt {
  std::optional<Failed> failed;
  std::vector<SchwarzReport> reports;  // by island

  bool converged() const;
  /// What is missed is less than another way would lose by it.
  bool nearly() const;
  FieldResiduals missed() const;                // of islands that have not converged
  std::string trouble(double tolerance) const;  // in words
};

}  // namespace abut
