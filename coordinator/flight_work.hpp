#pragma once

#include <span>

#include "contract/subdomain.hpp"

namespace abut {

/// Windows of free flight in one request, at least 1: as many as take about half a second, so that
/// a run shows progress, can be interrupted, and loses little when it fails. A count of work from
/// degrees of freedom and steps, and never of measured time: flights are the same on every machine
/// and in every placement, and with them the last bits of the times of loads and records. No more
/// than a reply of a body holds of `records` per window, either.
/// `window` [s].
int windows_at_once(double window, int records, std::span<const Description* const> bodies);

}  // namespace abut
