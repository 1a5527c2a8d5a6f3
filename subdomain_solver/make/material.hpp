#pragma once

#include <memory>
#include <string>

#include "base/yaml_document.hpp"
#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

/// The law that a scene describes at a key path, e.g. "bodies.left.material". Throws InputError
/// with file, line and key. In one dimension linear_elastic may have Young's modulus alone.
std::unique_ptr<const Material> make_material(const MaterialSpec& spec, const Document& document,
                                              const std::string& path, int dimension = 3);

}  // namespace abut
