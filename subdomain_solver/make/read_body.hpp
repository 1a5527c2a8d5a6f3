#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/yaml_document.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

/// A body of a scene. Throws InputError.
BodySpec read_body(const Document& scene, const std::string& path, const BodyContext& context);
/// The same with its mesh file where it is.
BodySpec placed_body(const Document& scene, const std::string& path, const BodyContext& context);

/// The keys of a body without the rules across them; nothing where a key is wrong.
std::optional<BodySpec> read_keys(const Document& scene, const std::string& path);

/// The partner whose keys a body of this scene was told, with its mesh file where it is; nothing
/// where it was told none, or wrong ones.
std::optional<BodySpec> read_partner(const PortPartner& partner, const Document& scene);

/// Digest of the file of the body's mesh, of a scene at this place; 0: there is none, or it cannot
/// be read.
std::uint64_t mesh_digest(BodySpec spec, const Document& scene);

}  // namespace abut
