#include "coordinator/split/split_names.hpp"

#include <algorithm>

namespace abut {

bool SplitNames::reaches(std::size_t part, const std::string& name) const {
  const Mesh& mesh = parts_[part].mesh;
  return mesh.sides.contains(name) || mesh.node_sets.contains(name);
}

std::vector<std::size_t> SplitNames::parts_of(const std::string& name) const {
  std::vector<std::size_t> reached;
  for (std::size_t p = 0; p < parts_.size(); ++p)
    if (reaches(p, name)) reached.push_back(p);
  return reached;
}

std::optional<std::size_t> SplitNames::alone_in(const std::string& name) const {
  std::optional<std::size_t> only;
  const std::vector<std::int32_t> nodes = whole_.nodes_of(name);
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const bool some = std::ranges::any_of(nodes, [&](std::int32_t node) {
      return std::ranges::binary_search(parts_[p].nodes, node);
    });
    if (some && only) return std::nullopt;
    if (some) only = p;
  }
  return only;
}

}  // namespace abut
