#include "subdomain_solver/fe/abaqus_groups.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"

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
        if (index(row.face) > element.type->faces.size())
          throw InputError(
              fmt::format("names the face S{} of element {} ({}), which has {}", row.face,
                          element.number, element.name, element.type->faces.size()),
              file_.where(row.line), "Name a face that the element has.");
        if (kept_[index(e)] == 0 || !seen.insert({e, row.face - 1}).second) continue;
        group.faces.push_back({e, row.face - 1});
        for (int a : element.type->faces[index(row.face) - 1])
          nodes.push_back(pieces_.nodes_of(element)[a]);
      }
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.empty()) return refuse_nothing(surface.name, surface.line);
    if (surface.of_nodes) group.nodes = nodes;
    group.name = free_name(surface.name, piece, "_surface");
    keep(std::move(group), std::move(nodes), piece);
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
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
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
};

}  // namespace

AbaqusGroups abaqus_groups(const AbaqusPieces& pieces, const AbaqusCursor& file,
                           const std::vector<char>& kept, bool whole) {
  return Grouper(pieces, file, kept, whole).run();
}

}  // namespace abut
