#pragma once

namespace abut {

/// Memory that this process can have at most [bytes]: the machine's, or the limit set for the
/// process where that is lower.
double machine_memory();

}  // namespace abut
