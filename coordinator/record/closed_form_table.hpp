#pragma once

#include <string>

#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/measure_names.hpp"

namespace abut {

/// The contacts and the bodies beside the exact solution, for people. `end` [s]: time of the last
/// record. Times are judged by the contact's duration, velocities by the spread of the velocities
/// at the begin.
std::string closed_form_table(const ClosedForm& form, double end, const Measures& measures);

}  // namespace abut
