#pragma once

#include <string>

namespace abut {

/// A time of the clock [s] for people, in two figures or two units: "0.35 s", "14 s", "3 min 20 s",
/// "5 h 10 min", "3 d 4 h".
std::string time_words(double seconds);

}  // namespace abut
