#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/place.hpp"

namespace abut {

/// The checked mesh of a solid, moved to its position (dim; otherwise not moved). `model` is the
/// key of the spec, e.g. "model.fe"; `notes` gets lines for people on what its file has otherwise.
/// Throws InputError.
Mesh make_mesh(const SolidShapeSpec& spec, const std::vector<double>& position, const Place& place,
               const std::string& model, std::vector<std::string>* notes = nullptr);

/// A mesh file on another machine is that of the spec's digest, where one is known. Throws
/// InputError.
void require_same_file(const SolidShapeSpec& spec, const Place& place, const std::string& model);

/// Of the bytes of a mesh's file, and of those that it includes. Throws InputError.
std::uint64_t digest_of(const MeshFileSpec& mesh);
std::uint64_t digest_of(const AbaqusSpec& mesh);

/// For the line that tells people of a body: " on part.msh (digest 0123456789abcdef; 2 prisms
/// divided into 6 tetrahedra)", with the notes of make_mesh; empty where the mesh is generated.
/// Throws InputError.
std::string on_file(const SolidShapeSpec& spec, const std::vector<std::string>& notes);

/// Adds the scene's named points to a mesh, as sets of one node. Throws InputError where no node
/// is.
void name_points(const BodySpec& spec, const Place& place, Mesh& mesh);

/// Throws InputError when the mesh has cells that the formulation has no form for.
void check_formulation(const FiniteElementsSpec& spec, const Mesh& mesh, const Place& place,
                       const std::string& model);

}  // namespace abut
