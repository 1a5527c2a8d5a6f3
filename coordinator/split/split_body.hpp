#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/split/split_names.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

/// The body that is to be divided: its keys, and its mesh where it stands, named points as sets.
struct WholeBody {
  std::string name;
  BodySpec spec;
  Mesh mesh;

  /// The side, set or point that a port, a constraint or a point of this name is; empty: none is
  /// called so.
  std::string set_called(const std::string& name) const;
};

/// The body of this name; without a name the only one of the scene that can be divided. Throws
/// InputError: no such body, or one that cannot be divided, with the reason.
WholeBody whole_body(const Document& document, const Scene& scene, const std::string& name);

/// Nodes of the ports that may touch: these stay whole, because what gives way under a contact is
/// known of its own body alone, and what a cut through it adds, iteration would have to find out.
std::vector<std::int32_t> touched_nodes(const WholeBody& whole);

/// A part may have nodes of a side that is held and not the facets around them: there the
/// constraint is of a node set "held_" + its name, so that it holds the same nodes as in the whole.
/// Throws InputError where the mesh has such a name.
void hold_single_nodes(const Document& document, const WholeBody& whole,
                       std::vector<MeshPart>& parts);

/// The keys of a part: those of the whole, but for the mesh, for what does not reach into it, and
/// for the sides towards other parts, each a port.
BodySpec part_spec(const WholeBody& whole, const SplitNames& where, std::size_t part,
                   const std::string& file, const std::map<int, std::string>& towards);

}  // namespace abut
