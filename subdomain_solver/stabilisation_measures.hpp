#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/time/quasi_static.hpp"

namespace abut {

/// Names of the measures of a body that contact alone holds and that is stabilised (docs/OUTPUT.md,
/// [M.143]).
std::vector<std::string> stabilisation_measure_names(int dim);

/// Their values.
std::vector<double> stabilisation_measures(const FeModel& model, const QuasiStatic& statics,
                                           const Motion& motion);

}  // namespace abut
