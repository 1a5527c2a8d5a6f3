#pragma once

#include "contract/subdomain.hpp"

namespace abut {

/// [B] of a body's reply with so many times of its ports' traces and so many records: of numbers
/// alone, as a run asks for them (u, v and f of all points), without reactions.
double reply_bytes(const Description& body, double times, double records);

}  // namespace abut
