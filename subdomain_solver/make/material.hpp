#pragma once

#include <memory>

#include "subdomain_solver/make/solid_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

/// The law that a scene gives a body. Throws InputError with file, line and key. In one dimension
/// linear_elastic may have Young's modulus alone.
std::unique_ptr<const Material> make_material(const MaterialSpec& spec, const Place& place,
                                              int dimension);

}  // namespace abut
