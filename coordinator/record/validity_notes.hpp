#pragma once

#include <span>
#include <string>
#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// What a body's own measures at the end of a run say against its model, one sentence each: a law
/// of small rotations that has turned far enough to lengthen the body by 1 % (rotation.max), a
/// tenth of the stored energy in hourglasses (energy.hourglass_share); and how much a body that
/// contact alone holds was stabilised (stabilisation.share). values: in the order of body.measures,
/// or none.
std::vector<std::string> validity_notes(const Description& body, std::span<const double> values);

/// What its stabilisation bears of the forces on it, over what it may bear at the end of a run.
double borne_over_allowed(const Description& body, std::span<const double> values);

/// Why a body that contact alone holds is not in equilibrium: its stabilisation bears more than is
/// allowed. Empty: it is, or has none.
std::string unheld(const Description& body, std::span<const double> values);

/// What to do where sweeps do not converge.
std::string sweeps_remedy(std::span<const Description* const> bodies);

}  // namespace abut
