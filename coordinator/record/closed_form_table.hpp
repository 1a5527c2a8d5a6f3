#pragma once

#include <array>
#include <string>

#include "coordinator/closed_form.hpp"
#include "coordinator/record/measure_names.hpp"

namespace abut {

/// The contact and the bodies beside the exact solution, for people. `bodies`: names of the sides'
/// bodies; `end` [s]: time of the last record. Times are judged by the contact's duration,
/// velocities by the closing speed.
std::string closed_form_table(const ClosedForm& form, const std::array<std::string, 2>& bodies,
                              double end, const Measures& measures);

}  // namespace abut
