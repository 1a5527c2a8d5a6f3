#include "subdomain_solver/fe/exodus_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "subdomain_solver/fe/named_sides.hpp"
#include "subdomain_solver/fe/netcdf_file.hpp"

namespace abut {
namespace {

/// What Exodus calls shapes: names that begin with this, in any case and with any number behind.
constexpr std::array<std::pair<const char*, Shape>, 7> shape_names = {
    {{"HEX", Shape::hexahedron},
     {"TET", Shape::tetrahedron},
     {"QUAD", Shape::quadrilateral},
     {"TRI", Shape::triangle},
     {"BAR", Shape::line},
     {"TRUSS", Shape::line},
     {"EDGE", Shape::line}}};

std::string solid_names() {
  std::vector<std::string_view> names;
  for (const Element& element : all_elements())
    if (element.dim > 0) names.push_back(element.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const Element* element_of(const std::string& type, std::size_t nodes) {
  std::string upper = type;
  for (char& letter : upper)
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  for (const auto& [name, shape] : shape_names) {
    if (!upper.starts_with(name)) continue;
    for (const Element& element : all_elements())
      if (element.shape == shape && index(element.nodes) == nodes) return &element;
  }
  return nullptr;
}

class Reader {
 public:
  Reader(const std::string& path, double scale) : path_(path), file_(path), scale_(scale) {}

  Mesh read() {
    const std::size_t dim = file_.length("num_dim");
    if (dim > 3) file_.refuse(fmt::format("has {} dimensions", dim), "Write 1 to 3.");
    mesh_.dim = static_cast<int>(dim);
    nodes_ = file_.length("num_nodes");
    if (nodes_ > index(INT32_MAX))
      file_.refuse(fmt::format("has {} nodes", nodes_), "Make the mesh coarser.");
    read_blocks();
    read_points();
    refuse_repeated_cells(mesh_, path_);
    read_sides();
    read_node_sets();
    settle_names(mesh_, path_);
    return std::move(mesh_);
  }

 private:
  /// Names of the sets of a kind: given, or made of the kind and the id.
  std::vector<std::string> names_of(const std::string& given, const std::string& ids,
                                    const char* kind, std::size_t count) const {
    std::vector<std::string> names(count);
    if (file_.has(given)) names = file_.texts(given, count);
    std::vector<std::int64_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::int64_t>(i) + 1;
    if (file_.has(ids)) numbers = file_.integers(ids, count);
    std::map<std::string, std::size_t> seen;
    for (std::size_t i = 0; i < count; ++i) {
      if (names[i].empty()) names[i] = fmt::format("{}_{}", kind, numbers[i]);
      if (!seen.try_emplace(names[i], i).second)
        file_.refuse(fmt::format("has two of {} called '{}'", given, names[i]),
                     "Give them different names.");
    }
    return names;
  }

  /// A number counted from 1 in the file, from 0 here.
  std::size_t from_one(std::int64_t number, std::size_t count, const std::string& variable) const {
    if (number < 1 || static_cast<std::uint64_t>(number) > count)
      file_.refuse(
          fmt::format("has the number {} in {}, where 1 to {} must be", number, variable, count),
          "The file is damaged: write it again.");
    return index(number) - 1;
  }

  void read_blocks() {
    const std::size_t count = file_.length("num_el_blk");
    const std::vector<std::string> names = names_of("eb_names", "eb_prop1", "block", count);
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t cells = file_.length_or_zero(fmt::format("num_el_in_blk{}", b + 1));
      if (cells == 0) continue;
      const std::size_t width = file_.length(fmt::format("num_nod_per_el{}", b + 1));
      const std::string variable = fmt::format("connect{}", b + 1);
      const std::string type = file_.attribute(variable, "elem_type");
      const Element* element = element_of(type, width);
      if (element == nullptr)
        file_.refuse(
            fmt::format("has elements {} of {} nodes in block '{}'", type, width, names[b]),
            "Use bars, triangles, quadrilaterals, tetrahedra, hexahedra: " + solid_names() + ".");
      if (element->dim != mesh_.dim)
        file_.refuse(fmt::format("has elements {} of {} dimensions in block '{}', in a space of {}",
                                 type, element->dim, names[b], mesh_.dim),
                     "Leave out shells and bars; write plane parts with two dimensions.");
      const std::vector<std::int64_t> numbers = file_.integers(variable, cells * width);
      const std::vector<int>& order = element->exodus_nodes;
      CellBlock block = {element, {}, names[b]};
      block.nodes.resize(numbers.size());
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::size_t a = i % width;
        const std::size_t from = order.empty() ? a : index(order[a]);
        block.nodes[i] =
            static_cast<std::int32_t>(from_one(numbers[i - a + from], nodes_, variable));
      }
      for (std::size_t cell = 0; cell < cells; ++cell)
        cells_.push_back(
            {static_cast<std::int32_t>(mesh_.blocks.size()), static_cast<std::int32_t>(cell), 0});
      mesh_.blocks.push_back(std::move(block));
    }
  }

  /// Coordinates of the nodes of cells; numbers them, in the file's order.
  void read_points() {
    const auto dim = index(mesh_.dim);
    std::vector<double> x;  // (dim, nodes)
    if (file_.has("coord")) {
      x = file_.reals("coord", dim * nodes_);
    } else {
      constexpr const char* names[] = {"coordx", "coordy", "coordz"};
      for (std::size_t d = 0; d < dim; ++d) {
        const std::vector<double> more = file_.reals(names[d], nodes_);
        x.insert(x.end(), more.begin(), more.end());
      }
    }
    number_.assign(nodes_, -1);
    for (const CellBlock& block : mesh_.blocks)
      for (std::int32_t node : block.nodes) number_[node] = 0;
    std::int32_t next = 0;
    for (std::size_t n = 0; n < nodes_; ++n) {
      if (number_[n] < 0) continue;
      number_[n] = next++;
      for (std::size_t d = 0; d < dim; ++d) mesh_.points.push_back(scale_ * x[d * nodes_ + n]);
    }
    for (CellBlock& block : mesh_.blocks) {
      for (std::int32_t& node : block.nodes) node = number_[node];
      mesh_.node_sets[block.name] = block.nodes;
    }
  }

  void read_sides() {
    const std::size_t count = file_.length_or_zero("num_side_sets");
    if (count == 0) return;
    const std::vector<std::string> names = names_of("ss_names", "ss_prop1", "surface", count);
    for (std::size_t s = 0; s < count; ++s) {
      const std::size_t facets = file_.length_or_zero(fmt::format("num_side_ss{}", s + 1));
      if (facets == 0) continue;
      const std::string cell_list = fmt::format("elem_ss{}", s + 1);
      const std::string local_list = fmt::format("side_ss{}", s + 1);
      const std::vector<std::int64_t> cells = file_.integers(cell_list, facets);
      const std::vector<std::int64_t> locals = file_.integers(local_list, facets);
      std::vector<Facet>& side = mesh_.sides[names[s]];
      for (std::size_t f = 0; f < facets; ++f) {
        Facet facet = cells_[from_one(cells[f], cells_.size(), cell_list)];
        const CellBlock& block = mesh_.blocks[facet.block];
        // our facets are in Exodus' order
        facet.local = static_cast<std::int32_t>(
            from_one(locals[f], block.element->facets.size(), local_list));
        side.push_back(facet);
      }
    }
  }

  void read_node_sets() {
    const std::size_t count = file_.length_or_zero("num_node_sets");
    if (count == 0) return;
    const std::vector<std::string> names = names_of("ns_names", "ns_prop1", "nodelist", count);
    for (std::size_t s = 0; s < count; ++s) {
      const std::size_t length = file_.length_or_zero(fmt::format("num_nod_ns{}", s + 1));
      if (length == 0) continue;
      const std::string variable = fmt::format("node_ns{}", s + 1);
      std::vector<std::int32_t> set;
      for (std::int64_t number : file_.integers(variable, length)) {
        const std::int32_t node = number_[from_one(number, nodes_, variable)];
        if (node < 0)
          file_.refuse(fmt::format("has node {} of no cell in the set '{}'", number, names[s]),
                       "Take it out of the set.");
        set.push_back(node);
      }
      if (!mesh_.node_sets.try_emplace(names[s], std::move(set)).second)
        file_.refuse("has a block and a node set called '" + names[s] + "'",
                     "Give them different names.");
    }
  }

  std::string path_;
  NetcdfFile file_;
  double scale_;
  Mesh mesh_;
  std::size_t nodes_ = 0;             // in the file
  std::vector<std::int32_t> number_;  // in the mesh, of a node of the file; -1: in no cell
  std::vector<Facet> cells_;          // block and cell of an element of the file
};

}  // namespace

Mesh read_exodus(const std::string& path, double scale) { return Reader(path, scale).read(); }

}  // namespace abut
