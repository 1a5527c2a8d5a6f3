#pragma once

#include <span>

#include "contract/subdomain.hpp"

namespace abut {

/// Watches the bodies' energy less the work of external loads. Supports, ties and contact make
/// none, so it must not grow; that it does is how an unstable step or window shows itself before
/// its numbers overflow  [M.21].
class EnergyGuard {
 public:
  enum class Verdict { fine, warn, fail };

  /// `share`: growth, as a fraction of the largest kinetic and stored energy so far, that fails.
  explicit EnergyGuard(double share) : share_(share) {}

  /// Looks at the last record of every body. Warns once, at half the share.
  Verdict look(std::span<const Response> responses);
  double growth() const { return growth_; }  // as a fraction, at the last look
  double most() const { return most_; }      // [J] largest kinetic and stored energy so far

 private:
  double share_;
  bool begun_ = false, warned_ = false;
  double first_ = 0.0;  // [J] at the first look
  double most_ = 0.0;   // [J] largest kinetic and stored energy so far
  double growth_ = 0.0;
};

}  // namespace abut
