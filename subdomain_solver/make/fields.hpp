#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "subdomain_solver/fe/loads.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

// What a scene says of a solid's space: loads and the state of the start.

/// One expression per dimension, read. Throws InputError.
VectorField field_of(const std::vector<std::string>& texts, int dim, const std::string& where);

/// The value of a field of the start. Throws InputError where it has none: `where`, the expression.
double start_value(const ScalarField& field, const std::array<double, 3>& at, int dim,
                   const std::string& where);

/// [m] reference position of a node.
std::array<double, 3> position_of(const Mesh& mesh, std::int32_t node);

/// The loads on a mesh, body forces last. They refer to the model. Throws InputError.
std::vector<std::unique_ptr<Load>> make_loads(const BodySpec& spec, const Place& place,
                                              const FeModel& model);
/// The same of a body in its passive form.
std::vector<std::unique_ptr<Load>> make_whole_loads(const BodySpec& spec, const Place& place,
                                                    const FeModel& model);

/// [m/s^2] by which body forces and loads of given acceleration may raise speeds, as a function of
/// time: of these where the frame of the mesh begins.
std::function<double(double)> body_acceleration(const BodySpec& spec, const Place& place, int dim);

/// Coordinates [m] and velocities [m/s] of the mesh's model at the start. Throws InputError.
Motion initial_motion(const BodySpec& spec, const Place& place, const FeModel& model);

}  // namespace abut
