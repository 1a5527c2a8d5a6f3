#pragma once

namespace abut {

/// Makes sure that this process may open so many more files, pipes and sockets: libzmq ends the
/// program where it cannot have one. Raises the soft limit where that helps. Throws RunError.
void require_descriptors(int wanted);

}  // namespace abut
