#pragma once

#include <optional>
#include <span>
#include <string>

#include "coordinator/record/observer.hpp"

namespace abut {

/// What would give up less: smaller steps or a finer mesh of one body.
struct GivenUpRemedy {
  int body = 0;
  bool finer_mesh = false;
};

/// Nothing where nothing to speak of was given up, or no body is to blame: rigid bodies lose what
/// rigid bodies lose.
std::optional<GivenUpRemedy> remedy_of(const GivenUp& up);

/// What a run gave up, for people: shares of windows, joules by cause, the deepest overlap, and the
/// remedy that helps most. Empty where no window was passive.
std::string given_up_words(const GivenUp& up, std::int64_t windows,
                           std::span<const Description* const> bodies);

}  // namespace abut
