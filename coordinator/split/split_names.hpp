#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/split/divided_mesh.hpp"
#include "subdomain_solver/fe/mesh.hpp"

namespace abut {

/// In which parts of a mesh its sides, node sets and named points lie.
class SplitNames {
 public:
  SplitNames(const Mesh& whole, const std::vector<MeshPart>& parts)
      : whole_(whole), parts_(parts) {}

  /// Whether a part has facets of a side, or nodes of a set.
  bool reaches(std::size_t part, const std::string& name) const;
  /// The parts that it reaches, ascending.
  std::vector<std::size_t> parts_of(const std::string& name) const;
  /// The one part that has all nodes of it and shares none of them; none: there is no such part.
  std::optional<std::size_t> alone_in(const std::string& name) const;

 private:
  const Mesh& whole_;
  const std::vector<MeshPart>& parts_;
};

}  // namespace abut
