#pragma once

#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

// One maker per kind of body, for make_body, which has read the specification. Each throws
// InputError with file, line and key.

/// Of finite elements in two and three dimensions.
std::unique_ptr<Subdomain> make_solid_body(const BodySpec& spec, const Document& document,
                                           const std::string& path, std::function<void()> progress);
std::unique_ptr<Subdomain> make_modal_body(const BodySpec& spec, const Document& document,
                                           const std::string& path, std::function<void()> progress);
std::unique_ptr<Subdomain> make_rigid_body(const BodySpec& spec, const Document& document,
                                           const std::string& path, std::function<void()> progress);
std::unique_ptr<Subdomain> make_pair_body(const BodySpec& spec, const Document& document,
                                          const std::string& path, std::function<void()> progress);

}  // namespace abut
