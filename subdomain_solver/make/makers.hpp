#pragma once

#include "subdomain_solver/interior.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

// One maker per kind of body, for make_body, which has read the specification. Each throws
// InputError with file, line and key.

/// Of finite elements in two and three dimensions.
std::unique_ptr<Interior> make_solid(const BodySpec& spec, const Document& document,
                                     const std::string& path);
std::unique_ptr<Interior> make_modal(const BodySpec& spec, const Document& document,
                                     const std::string& path);
std::unique_ptr<Interior> make_rigid(const BodySpec& spec, const Document& document,
                                     const std::string& path);
std::unique_ptr<Interior> make_pair(const BodySpec& spec, const Document& document,
                                    const std::string& path);

}  // namespace abut
