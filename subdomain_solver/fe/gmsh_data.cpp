#include "subdomain_solver/fe/gmsh_data.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "base/index.hpp"
#include "subdomain_solver/fe/divide_cells.hpp"
#include "subdomain_solver/fe/gmsh_cursor.hpp"

namespace abut {
namespace {

const char* const as_version =
    "Export as version 4.1 (in Gmsh: `gmsh -format msh41`, or Mesh.MshFileVersion = 4.1), or 2.2 "
    "as text.";

/// A type of elements: one of ours, or cells that are divided.
struct Kind {
  int gmsh = 0;  // its number
  int dim = 0, nodes = 0;
  std::string_view name;
  const Element* element = nullptr;
  const DividedShape* shape = nullptr;  // where there is no element
};

/// Without element and shape: we do not have it.
Kind kind_of(int gmsh) {
  for (const Element& element : all_elements())
    if (element.gmsh == gmsh) return {gmsh, element.dim, element.nodes, element.name, &element};
  const bool prism = gmsh == 6 || gmsh == 18, pyramid = gmsh == 7 || gmsh == 19;
  if (!prism && !pyramid) return {};
  const DividedShape& shape = prism ? prism_shape() : pyramid_shape();
  return {gmsh, 3, shape.nodes(gmsh > 7), shape.name, nullptr, &shape};
}

/// What to do about elements that we do not have.
std::string other_element(int type) {
  const bool complete = type == 12 || type == 13 || type == 14;  // with nodes inside of faces
  if (complete)
    return "Set Mesh.SecondOrderIncomplete = 1 in Gmsh: nodes on edges are supported, as of hex20.";
  return "Use elements of order 1 or 2: bars, triangles, quadrilaterals, tetrahedra, hexahedra, "
         "prisms, pyramids.";
}

class GmshParser {
 public:
  GmshParser(std::string bytes, const std::string& name) : file_(std::move(bytes), name) {
    data_.name = name;
  }

  FileMesh parse() {
    format();
    while (!file_.at_end()) {
      const std::string section(file_.line());
      if (section == "$PhysicalNames") {
        physical_names();
      } else if (section == "$Entities") {
        in_binary([this]() { entities(); });
      } else if (section == "$Nodes") {
        in_binary([this]() { listed_ ? listed_nodes() : nodes(); });
      } else if (section == "$Elements") {
        in_binary([this]() { listed_ ? listed_elements() : elements(); });
      } else if (section == "$PartitionedEntities" || section == "$GhostElements") {
        file_.refuse("is a partitioned mesh", "Export it without partitions.");
      } else if (section.size() > 1 && section[0] == '$' && !section.starts_with("$End")) {
        file_.skip_to("$End" + section.substr(1));
        continue;
      } else {
        file_.refuse("has a line outside of all sections", "Export the file again.");
      }
      file_.expect_line("$End" + section.substr(1));
    }
    if (data_.node_tags.empty()) file_.refuse("has no nodes", "Mesh the part before the export.");
    if (!has_elements_) file_.refuse("has no $Elements", "Mesh the part before the export.");
    return std::move(data_);
  }

 private:
  template <typename Read>
  void in_binary(Read read) {
    if (binary_) file_.begin_binary();
    read();
    file_.end_binary();
  }

  void format() {
    if (file_.at_end() || file_.line() != "$MeshFormat")
      file_.refuse("is not a Gmsh mesh: it does not begin with $MeshFormat", as_version);
    const std::string line(file_.line());
    const std::string version = line.substr(0, line.find(' '));
    if (version != "4.1" && version != "2.2")
      file_.refuse("is in version " + version.substr(0, 12), as_version);
    listed_ = version == "2.2";
    if (line == "2.2 1 8")
      file_.refuse("is in version 2.2, binary", "Export it as text, or as version 4.1.");
    if (line != "4.1 0 8" && line != "4.1 1 8" && line != "2.2 0 8")
      file_.refuse("has the format '" + line.substr(0, 40) + "'",
                   "Expected is 4.1 0 8, 4.1 1 8 or 2.2 0 8.");
    binary_ = line[4] == '1';
    if (binary_) {
      in_binary([this]() {
        if (file_.integer() != 1)
          file_.refuse("was written on a machine of another byte order", "Export it as text.");
      });
    }
    file_.expect_line("$EndMeshFormat");
  }

  int dimension() {
    const int dim = file_.integer();
    if (dim < 0 || dim > 3)
      file_.refuse(fmt::format("has an entity of {} dimensions", dim), "Export the file again.");
    return dim;
  }

  void physical_names() {
    const std::size_t count = file_.count("physical names", 3);
    for (std::size_t i = 0; i < count; ++i) {
      const int dim = dimension();
      const int tag = file_.integer();
      const std::string_view name = file_.line();
      if (name.size() < 3 || name.front() != '"' || name.back() != '"')
        file_.refuse("has a physical group without a name in quotes", "Name the group in Gmsh.");
      data_.group_names[{dim, tag}] = name.substr(1, name.size() - 2);
    }
  }

  void entities() {
    std::size_t counts[4];
    for (std::size_t& count : counts) count = file_.count("entities", 4);
    for (int dim = 0; dim < 4; ++dim) {
      for (std::size_t i = 0; i < counts[dim]; ++i) {
        const int tag = file_.integer();
        for (int k = 0; k < (dim == 0 ? 3 : 6); ++k) file_.real();  // place, or bounding box
        std::vector<int>& groups = data_.groups[{dim, tag}];
        groups.resize(file_.count("physical groups", 1));
        // the sign is an orientation, which facets have from their cells
        for (int& group : groups) group = static_cast<int>(std::llabs(file_.integer()));
        if (dim == 0) continue;
        const std::size_t bounds = file_.count("boundary entities", 1);
        for (std::size_t k = 0; k < bounds; ++k) file_.integer();
      }
    }
  }

  void nodes() {
    if (!data_.node_tags.empty()) file_.refuse("has $Nodes twice", "Export the file again.");
    const std::size_t blocks = file_.count("blocks of nodes", 4);
    const std::size_t total = file_.count("nodes", 4);
    file_.natural();  // smallest and largest tag
    file_.natural();
    data_.node_tags.reserve(total);
    data_.points.reserve(3 * total);
    for (std::size_t b = 0; b < blocks; ++b) {
      const int dim = dimension();
      file_.integer();
      const bool parametric = file_.integer() != 0;
      const std::size_t count = file_.count("nodes", 4);
      for (std::size_t i = 0; i < count; ++i) {
        add_node(file_.natural());
      }
      for (std::size_t i = 0; i < count; ++i) {
        for (int d = 0; d < 3; ++d) data_.points.push_back(file_.real());
        for (int d = 0; d < (parametric ? dim : 0); ++d) file_.real();
      }
    }
    if (data_.node_tags.size() != total)
      file_.refuse(fmt::format("announces {} nodes and has {}", total, data_.node_tags.size()),
                   "Export the file again.");
  }

  void elements() {
    if (data_.node_tags.empty()) file_.refuse("has elements before its nodes", "Export it again.");
    const std::size_t blocks = file_.count("blocks of elements", 4);
    const std::size_t total = file_.count("elements", 2);
    file_.natural();  // smallest and largest tag
    file_.natural();
    std::size_t read = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const int dim = dimension();
      const FileMesh::Entity entity = {dim, file_.integer()};
      const Kind kind = element_kind();
      if (kind.dim != dim)
        file_.refuse(fmt::format("has {} on an entity of {} dimensions", kind.name, dim),
                     "Export the file again.");
      const auto nodes = index(kind.nodes);
      const std::size_t count = file_.count("elements", nodes + 1);
      const std::string where = file_.where();
      const auto take = [&](auto& block) {
        block.nodes.reserve(count * nodes);
        for (std::size_t i = 0; i < count; ++i) {
          block.tags.push_back(file_.natural());
          for (std::size_t a = 0; a < nodes; ++a) block.nodes.push_back(node(block.tags.back()));
        }
      };
      in_block(kind, entity, where, take);
      read += count;
    }
    if (read != total)
      file_.refuse(fmt::format("announces {} elements and has {}", total, read),
                   "Export the file again.");
    has_elements_ = true;
  }

  void add_node(std::uint64_t tag) {
    if (!number_.try_emplace(tag, static_cast<std::int32_t>(number_.size())).second)
      file_.refuse(fmt::format("has node {} twice", tag), "Export the file again.");
    data_.node_tags.push_back(tag);
  }

  Kind element_kind() {
    const int type = file_.integer();
    const Kind found = kind_of(type);
    if (found.gmsh == 0)
      file_.refuse(fmt::format("has elements of Gmsh's type {}", type), other_element(type));
    return found;
  }

  /// Calls `take` with a new block of elements, or of cells that are divided.
  template <typename Take>
  void in_block(const Kind& kind, FileMesh::Entity entity, const std::string& where, Take take) {
    if (kind.element != nullptr) {
      take(data_.elements.emplace_back(FileMesh::Elements{kind.element, entity, where, {}, {}}));
    } else {
      const bool quadratic = kind.nodes > kind.shape->corners;
      take(data_.divided.emplace_back(
          FileMesh::Divided{kind.shape, quadratic, entity, where, {}, {}}));
    }
  }

  /// Of version 2.2: a line per node.
  void listed_nodes() {
    if (!data_.node_tags.empty()) file_.refuse("has $Nodes twice", "Export the file again.");
    const std::size_t count = file_.count("nodes", 4);
    data_.node_tags.reserve(count);
    data_.points.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
      add_node(file_.natural());
      for (int d = 0; d < 3; ++d) data_.points.push_back(file_.real());
    }
  }

  /// Of version 2.2: a line per element, with its physical group and its entity, to which other
  /// programs than Gmsh pay no regard; so what has the same groups is one entity of ours. An
  /// element of several groups stands there once for each.
  void listed_elements() {
    if (data_.node_tags.empty()) file_.refuse("has elements before its nodes", "Export it again.");
    const std::size_t count = file_.count("elements", 4);
    std::map<std::vector<std::int32_t>, std::size_t> place;  // of nodes, types' numbers in front
    std::vector<Listed> all;
    for (std::size_t i = 0; i < count; ++i) {
      Listed next;
      next.where = file_.where();
      next.tag = file_.natural();
      next.kind = element_kind();
      const std::size_t tags = file_.count("tags", 1);
      for (std::size_t k = 0; k < tags; ++k) {
        const int value = static_cast<int>(std::llabs(file_.integer()));
        if (k == 0 && value != 0) next.groups.push_back(value);
      }
      next.nodes.push_back(next.kind.gmsh);
      for (int a = 0; a < next.kind.nodes; ++a) next.nodes.push_back(node(next.tag));
      const auto [entry, fresh] = place.try_emplace(next.nodes, all.size());
      if (fresh || !all[entry->second].join(next.groups)) all.push_back(std::move(next));
    }
    add(all);
    has_elements_ = true;
  }

  struct Listed {
    Kind kind;
    std::string where;
    std::uint64_t tag = 0;
    std::vector<int> groups;
    std::vector<std::int32_t> nodes;  // the first is the type's number
    /// Takes the groups as well, unless it has them or has none: then that is another element.
    bool join(const std::vector<int>& more) {
      if (groups.empty() || more.empty() || std::ranges::count(groups, more[0]) > 0) return false;
      groups.push_back(more[0]);
      return true;
    }
  };

  /// What is of one type and in the same groups becomes a block, in the order of the first ones.
  void add(const std::vector<Listed>& all) {
    std::map<std::pair<int, std::vector<int>>, std::size_t> place;
    std::vector<std::vector<const Listed*>> blocks;
    for (const Listed& element : all) {
      const auto [entry, fresh] =
          place.try_emplace({element.kind.gmsh, element.groups}, blocks.size());
      if (fresh) blocks.emplace_back();
      blocks[entry->second].push_back(&element);
    }
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const Listed& first = *blocks[b].front();
      const FileMesh::Entity entity = {first.kind.dim, static_cast<int>(b) + 1};
      data_.groups[entity] = first.groups;
      const auto take = [&blocks, b](auto& block) {
        for (const Listed* one : blocks[b]) {
          block.tags.push_back(one->tag);
          block.nodes.insert(block.nodes.end(), one->nodes.begin() + 1, one->nodes.end());
        }
      };
      in_block(first.kind, entity, first.where, take);
    }
  }

  std::int32_t node(std::uint64_t element) {
    const std::uint64_t tag = file_.natural();
    const auto found = number_.find(tag);
    if (found == number_.end())
      file_.refuse(fmt::format("has element {} with node {}, which is not in $Nodes", element, tag),
                   "Export the file again.");
    return found->second;
  }

  GmshCursor file_;
  FileMesh data_;
  std::unordered_map<std::uint64_t, std::int32_t> number_;       // of a node tag
  bool binary_ = false, listed_ = false, has_elements_ = false;  // listed: version 2.2
};

}  // namespace

FileMesh parse_gmsh(std::string bytes, const std::string& name) {
  return GmshParser(std::move(bytes), name).parse();
}

}  // namespace abut
