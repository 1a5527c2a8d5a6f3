#pragma once

#include <exception>
#include <string>

namespace abut {

/// What ended a run, for its files: of our own errors the place and what is wrong, without the
/// remedy; of others what they say.
std::string without_remedy(const std::exception& error);

}  // namespace abut
