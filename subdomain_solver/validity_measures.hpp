#pragma once

#include <span>
#include <string>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Names of the measures by which the coordinator sees that a model does not fit what the body does
/// (docs/OUTPUT.md): inertia.left and inertia.turned [rad] where a surface without mass leaves less
/// of the moment of inertia; rotation.max [rad] where the law is linear; energy.hourglass [J] and
/// its part of the stored energy, energy.hourglass_share, under one_point. None of a body that
/// cannot deform.
std::vector<std::string> validity_measure_names(const FeModel& model, bool deforms);

/// Their values. u: [m] (nodes, dim) along the axes of space; stored: [J]; turned: [rad] largest
/// rotation seen on the way.
std::vector<double> validity_measures(const FeModel& model, bool deforms, std::span<const double> u,
                                      double stored, double turned);

/// Largest rotation [rad] of a body under a linear law, of a few cells: cheap enough for every
/// record. 0 under other laws.
double rotation_on_the_way(const FeModel& model, bool deforms, std::span<const double> u);

}  // namespace abut
