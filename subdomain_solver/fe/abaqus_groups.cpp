#include "subdomain_solver/fe/abaqus_groups.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {
namespace {

class Grouper {
 public:
  Grouper(const AbaqusPieces& pieces, const AbaqusCursor& file, const std::vector<char>& kept,
          bool whole)
      : pieces_(pieces), file_(file), kept_(kept), whole_(whole) {
    in_cell_.assign(pieces.numbers().size(), 0);
    for (std::size_t e = 0; e < kept.size(); ++e) {
      if (kept[e] == 0) continue;
      const AbaqusPieces::Element& element = pieces.elements()[e];
      for (int a = 0; a < element.type->nodes; ++a)
        in_cell_[index(pieces.nodes_of(element)[a])] = 1;
    }
  }

  AbaqusGroups run() {
    const std::size_t count = pieces_.pieces().size();
    for (std::size_t p = 0; p < count; ++p)
      for (const AbaqusModel::Surface& surface : pieces_.pieces()[p].scope->surfaces)
        if (!surface.internal) add_surface(p, surface);
    for (std::size_t p = 0; p < count; ++p)
      for (const auto& [key, set] : pieces_.pieces()[p].scope->element_sets)
        if (!set.internal) add_elements(p, set);
    for (std::size_t p = 0; p < count; ++p)
      for (const auto& [key, set] : pieces_.pieces()[p].scope->node_sets)
        if (!set.internal) add_nodes(p, set);
    if (left_out_ > 0)
      out_.notes.push_back(fmt::format("{} nodes of no cell left out of sets", left_out_));
    return std::move(out_);
  }

 private:
  using Group = AbaqusGroups::Group;
  using Nodes = std::vector<std::int32_t>;

  void refuse_nothing(const std::string& name, AbaqusLine line) const {
    if (whole_)
      throw InputError(fmt::format("has '{}', which has nothing in it", name), file_.where(line),
                       "Take it out, or write what is in it.");
  }

  /// A name that no other group has.
  std::string free_name(const std::string& name, std::size_t piece, const char* ending) {
    const std::string& of = pieces_.pieces()[piece].name;
    std::string fresh = name;
    if (taken_.contains(in_capitals(fresh)) && !of.empty() && owner_[in_capitals(name)] != piece)
      fresh = of + "." + name;
    if (taken_.contains(in_capitals(fresh))) fresh += ending;
    if (taken_.contains(in_capitals(fresh)))
      throw InputError(fmt::format("has several sets or surfaces called '{}'", name),
                       file_.files().front(), "Give them different names.");
    if (fresh != name)
      out_.notes.push_back(fmt::format("another '{}' is called '{}'", name, fresh));
    return fresh;
  }

  void keep(Group group, Nodes nodes, std::size_t piece) {
    const std::string key = in_capitals(group.name);
    taken_[key] = std::move(nodes);
    owner_[key] = piece;
    out_.groups.push_back(std::move(group));
  }

  void add_surface(std::size_t piece, const AbaqusModel::Surface& surface) {
    if (surface.rows.empty()) refuse_nothing(surface.name, surface.line);
    Group group;
    group.line = surface.line;
    Nodes nodes;
    std::set<std::pair<std::int32_t, int>> seen;
    for (const AbaqusModel::Surface::Row& row : surface.rows) {
      if (surface.of_nodes) {
        for (std::int32_t node : pieces_.nodes(piece, row.picked, surface.name))
          if (in_cell_[index(node)] != 0) nodes.push_back(node);
        continue;
      }
      for (std::int32_t e : pieces_.elements(piece, row.picked, surface.name)) {
        const AbaqusPieces::Element& element = pieces_.elements()[index(e)];
        const int count = static_cast<int>(element.type->faces.size());
        if (index(row.face) > element.type->faces.size())
          throw InputError(
              fmt::format("names the face S{} of element {} ({}), which has {}", row.face,
                          element.number, element.name, element.type->faces.size()),
              file_.where(row.line), "Name a face that the element has.");
        const int first = row.face == 0 ? 0 : row.face - 1, end = row.face == 0 ? count : row.face;
        for (int face = first; face < end && kept_[index(e)] != 0; ++face) {
          if (element.type->faces[index(face)].empty()) continue;  // it has shrunk to nothing
          if (row.face == 0 && !is_free(element, face)) continue;
          if (!seen.insert({e, face}).second) continue;
          group.faces.push_back({e, face});
          for (int a : element.type->faces[index(face)])
            nodes.push_back(pieces_.nodes_of(element)[a]);
        }
      }
    }
    keep_one_each(nodes);
    if (nodes.empty()) return refuse_nothing(surface.name, surface.line);
    if (surface.of_nodes) group.nodes = nodes;
    group.name = free_name(surface.name, piece, "_surface");
    keep(std::move(group), std::move(nodes), piece);
  }

  using Corners = std::array<std::int32_t, 4>;  // sorted, -1 in front where there are fewer

  Corners corners_of(const AbaqusPieces::Element& element, int face) const {
    const std::vector<int>& local = element.type->faces[index(face)];
    const std::size_t nodes = element.type->dim == 2    ? 2
                              : element.type->quadratic ? local.size() / 2
                                                        : local.size();
    Corners corners = {-1, -1, -1, -1};
    for (std::size_t k = 0; k < nodes; ++k) corners[k] = pieces_.nodes_of(element)[local[k]];
    std::ranges::sort(corners);
    return corners;
  }

  /// Whether no other cell of the body has this face.
  bool is_free(const AbaqusPieces::Element& element, int face) {
    for (std::size_t e = 0; e < kept_.size() && !counted_; ++e) {
      const AbaqusPieces::Element& one = pieces_.elements()[e];
      for (int f = 0; f < static_cast<int>(one.type->faces.size()) && kept_[e] != 0; ++f)
        if (one.type->dim == element.type->dim && !one.type->faces[index(f)].empty())
          ++cells_at_[corners_of(one, f)];
    }
    counted_ = true;
    return cells_at_[corners_of(element, face)] == 1;
  }

  void add_elements(std::size_t piece, const AbaqusModel::Set& set) {
    Group group;
    group.line = set.line;
    Nodes nodes;
    for (std::int32_t e : pieces_.elements(piece, set.picked, set.name)) {
      if (kept_[index(e)] == 0) continue;
      group.elements.push_back(e);
      const AbaqusPieces::Element& element = pieces_.elements()[index(e)];
      for (int a = 0; a < element.type->nodes; ++a) nodes.push_back(pieces_.nodes_of(element)[a]);
    }
    if (group.elements.empty()) return refuse_nothing(set.name, set.line);
    keep_one_each(nodes);
    group.name = free_name(set.name, piece, "_cells");
    keep(std::move(group), std::move(nodes), piece);
  }

  void add_nodes(std::size_t piece, const AbaqusModel::Set& set) {
    Group group;
    group.line = set.line;
    const Nodes all = pieces_.nodes(piece, set.picked, set.name);
    for (std::int32_t node : all)
      if (in_cell_[index(node)] != 0) group.nodes.push_back(node);
    if (whole_) left_out_ += all.size() - group.nodes.size();
    if (all.empty()) refuse_nothing(set.name, set.line);
    if (group.nodes.empty()) return;
    const auto same = taken_.find(in_capitals(set.name));
    if (same != taken_.end() && same->second == group.nodes) return;  // the name is there
    group.name = free_name(set.name, piece, "_nodes");
    Nodes nodes = group.nodes;
    keep(std::move(group), std::move(nodes), piece);
  }

  const AbaqusPieces& pieces_;
  const AbaqusCursor& file_;
  const std::vector<char>& kept_;
  bool whole_;
  std::vector<char> in_cell_;                 // (nodes)
  std::map<std::string, Nodes> taken_;        // nodes of the groups so far, by name in capitals
  std::map<std::string, std::size_t> owner_;  // pieces of the same
  AbaqusGroups out_;
  std::size_t left_out_ = 0;
  std::map<Corners, int> cells_at_;  // of faces
  bool counted_ = false;
};

}  // namespace

AbaqusGroups abaqus_groups(const AbaqusPieces& pieces, const AbaqusCursor& file,
                           const std::vector<char>& kept, bool whole) {
  return Grouper(pieces, file, kept, whole).run();
}

}  // namespace abut
