#pragma once

#include <string>

#include "contract/subdomain.hpp"

namespace abut {

/// What tells that a body in another process is not the one that the coordinator sees in the scene
/// and in its own files: dimension, degrees of freedom, mass, or the line that describes its model,
/// with the digest of its mesh file. Empty where nothing does.
std::string difference_of(const Description& own, const Description& theirs);

}  // namespace abut
