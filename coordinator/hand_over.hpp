#pragma once

#include "contract/hand_over.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// What a body hands over to another model or mesh of itself; `record` is its latest. Throws
/// RunError: it has a history that the other one cannot have, stands in statics, or does not tell
/// where its nodes are.
HandOver hand_over(Subdomain& body, const BodyRecord& record);

}  // namespace abut
