#pragma once

#include <span>
#include <string>
#include <vector>

namespace abut {

/// Shares of a run's wall time, from 0 to 1.
struct Shares {
  std::vector<double> bodies;  // by body, for which it was waited for
  double coupling = 0.0;       // all other time: iterations, searches, messages, files
};

/// `waited` [s] by body, of `wall` [s].
Shares shares_of(std::span<const double> waited, double wall);

/// "plate 61 %, ball 20 %, coupling 19 %": the largest `most` of the bodies, the largest first, all
/// others together, and the coupling. `names` by body.
std::string shares_words(const Shares& shares, std::span<const std::string> names,
                         std::size_t most = 4);

}  // namespace abut
