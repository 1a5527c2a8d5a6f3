#include "subdomain_solver/fe/abaqus_file.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/archive.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/input_file.hpp"
#include "base/machine_memory.hpp"
#include "subdomain_solver/fe/abaqus_groups.hpp"
#include "subdomain_solver/fe/file_digest.hpp"

namespace abut {
namespace {

const Element& element_of(int dim, std::size_t nodes) {
  for (const Element& element : all_elements())
    if (element.dim == dim && index(element.nodes) == nodes) return element;
  return linear_element(Shape::point);
}

std::string file_bytes(const std::string& path) {
  // The mesh takes about as much memory as the text that it was read from.
  const std::size_t most = static_cast<std::size_t>(0.5 * machine_memory());
  constexpr const char* remedy = "Check the path of the mesh.";
  check_input_file(path, most, remedy);
  return read_input_file(path, most, remedy);
}

class AbaqusBuilder {
 public:
  AbaqusBuilder(const AbaqusModel& model, const AbaqusCursor& file, const std::string& part)
      : model_(model), file_(file), pieces_(model, file), named_(part), part_(in_capitals(part)) {}

  FileMesh build() {
    out_.name = file_.files().front();
    for (const AbaqusPieces::Element& element : pieces_.elements())
      dim_ = std::max(dim_, element.type->dim);
    if (dim_ < 2)
      throw InputError("has no solid elements", out_.name,
                       "Write the part's *ELEMENT lines, of C3D, CPS, CPE or CAX types.");
    out_.points = pieces_.points();
    out_.node_tags = pieces_.numbers();
    choose();
    refuse_structures();
    AbaqusGroups groups = abaqus_groups(pieces_, file_, kept_, part_.empty());
    label_.assign(pieces_.elements().size(), 0);
    for (const AbaqusGroups::Group& group : groups.groups) add_group(group);
    add_elements();
    add_notes(std::move(groups.notes));
    divide_cells(out_);
    return std::move(out_);
  }

  /// Of cells, by the elements that they come from.
  CellWords words(std::vector<std::vector<std::int32_t>> origins) const {
    struct Written {
      std::int64_t number;
      AbaqusLine line;
    };
    std::vector<Written> elements;
    for (const AbaqusPieces::Element& element : pieces_.elements())
      elements.push_back({element.number, element.line});
    return [origins = std::move(origins), elements = std::move(elements), files = file_.files()](
               std::size_t block, std::size_t cell) {
      const Written& own = elements[index(origins[block][cell])];
      return fmt::format("element {}, {}:{}", own.number, files[index(own.line.file)],
                         own.line.number);
    };
  }

 private:
  using Group = AbaqusGroups::Group;

  /// The elements of the body.
  void choose() {
    const std::size_t count = pieces_.elements().size();
    kept_.assign(count, part_.empty() ? 1 : 0);
    if (part_.empty()) return;
    bool found = false;
    std::vector<std::string> names;
    for (std::size_t p = 0; p < pieces_.pieces().size(); ++p) {
      const AbaqusPieces::Piece& piece = pieces_.pieces()[p];
      if (!piece.name.empty()) names.push_back(piece.name);
      const bool named =
          in_capitals(piece.name) == part_ || in_capitals(piece.scope->name) == part_;
      for (const auto& [number, place] : piece.element_of)
        if (named) kept_[index(place)] = 1;
      found = found || named;
    }
    for (std::size_t p = 0; p < pieces_.pieces().size(); ++p) {
      const AbaqusModel::Sets& sets = pieces_.pieces()[p].scope->element_sets;
      for (const auto& [key, set] : sets) {
        if (!set.internal && std::ranges::find(names, set.name) == names.end())
          names.push_back(set.name);
        if (found || key != part_) continue;
        for (std::int32_t e : pieces_.elements(p, set.picked, set.name)) kept_[index(e)] = 1;
      }
    }
    if (std::ranges::find(kept_, 1) != kept_.end()) return;
    throw InputError(fmt::format("has no instance, part or set of elements '{}'", named_),
                     out_.name,
                     names.empty() ? std::string("Leave part out: it has no sets.")
                                   : fmt::format("Choose one of {}.", fmt::join(names, ", ")));
  }

  /// Lines and facets among solids are names of places, unless a section gives them something.
  void refuse_structures() const {
    for (const AbaqusModel::Section& section : model_.sections) {
      for (std::size_t p = 0; p < pieces_.pieces().size(); ++p) {
        const AbaqusModel::Scope& scope = *pieces_.pieces()[p].scope;
        const AbaqusModel::Scope& own =
            section.part < 0 ? model_.assembly : model_.parts[index(section.part)];
        const auto set = scope.element_sets.find(section.set);
        if (&scope != &own || set == scope.element_sets.end()) continue;
        for (std::int32_t e : pieces_.elements(p, set->second.picked, section.set)) {
          const AbaqusPieces::Element& element = pieces_.elements()[index(e)];
          if (element.type->dim == dim_ || kept_[index(e)] == 0) continue;
          throw InputError(
              fmt::format("has *{} of element {} ({}), which is no solid beside the others",
                          section.keyword, element.number, element.name),
              file_.where(section.line),
              "Trusses, membranes and shells are not supported: take them out, or mesh solids.");
        }
      }
    }
  }

  FileMesh::Entity entity(int dim, std::vector<int> tags) {
    const FileMesh::Entity next = {dim, ++entities_};
    out_.groups[next] = std::move(tags);
    return next;
  }

  void add_group(const Group& group) {
    const int tag = ++tags_;
    if (!group.elements.empty()) {
      int dim = 0;  // of a set with cells the others have no name
      for (std::int32_t e : group.elements) dim = std::max(dim, type_of(e).dim);
      out_.group_names[{dim, tag}] = group.name;
      for (std::int32_t e : group.elements)
        if (type_of(e).dim == dim) label_[index(e)] = joined(label_[index(e)], tag);
    } else if (!group.nodes.empty()) {
      out_.group_names[{0, tag}] = group.name;
      FileMesh::Elements set = {&linear_element(Shape::point),
                                entity(0, {tag}),
                                file_.where(group.line),
                                {},
                                group.nodes};
      for (std::int32_t node : group.nodes) set.tags.push_back(out_.node_tags[index(node)]);
      out_.elements.push_back(std::move(set));
    } else {
      out_.group_names[{dim_ - 1, tag}] = group.name;
      add_faces(group, tag);
    }
  }

  void add_faces(const Group& group, int tag) {
    std::map<std::size_t, FileMesh::Elements> by_nodes;
    for (const AbaqusGroups::Face& face : group.faces) {
      const AbaqusPieces::Element& element = pieces_.elements()[index(face.element)];
      const std::vector<int>& local = element.type->faces[index(face.face)];
      const auto [entry, fresh] = by_nodes.try_emplace(local.size());
      FileMesh::Elements& block = entry->second;
      if (fresh)
        block = {&element_of(dim_ - 1, local.size()),
                 entity(dim_ - 1, {tag}),
                 file_.where(group.line),
                 {},
                 {}};
      block.tags.push_back(static_cast<std::uint64_t>(element.number));
      for (int a : local) block.nodes.push_back(pieces_.nodes_of(element)[a]);
    }
    for (auto& [nodes, block] : by_nodes) out_.elements.push_back(std::move(block));
  }

  const AbaqusElement& type_of(std::int32_t e) const { return *pieces_.elements()[index(e)].type; }

  /// The label of those that are in one more group.
  int joined(int label, int tag) {
    const auto [entry, fresh] = next_.try_emplace({label, tag}, static_cast<int>(tags_of_.size()));
    if (fresh) {
      std::vector<int> tags = tags_of_[index(label)];
      tags.push_back(tag);
      tags_of_.push_back(std::move(tags));
    }
    return entry->second;
  }

  void add_elements() {
    std::map<std::pair<const AbaqusElement*, int>, std::size_t> place;
    for (std::size_t e = 0; e < kept_.size(); ++e) {
      if (kept_[e] == 0) continue;
      const AbaqusPieces::Element& element = pieces_.elements()[e];
      const AbaqusElement& type = *element.type;
      const auto number = static_cast<std::uint64_t>(element.number);
      types_.insert(std::string(element.name));
      const std::size_t count =
          type.divided == nullptr ? out_.elements.size() : out_.divided.size();
      const auto [entry, fresh] = place.try_emplace({element.type, label_[e]}, count);
      const auto put = [&](auto& block) {
        block.tags.push_back(number);
        block.origins.push_back(static_cast<std::int32_t>(e));
        for (int a : type.order) block.nodes.push_back(pieces_.nodes_of(element)[a]);
      };
      const std::string where = fresh ? file_.where(element.line) : std::string();
      if (fresh && type.divided == nullptr)
        out_.elements.push_back(
            {type.type, entity(type.dim, tags_of_[index(label_[e])]), where, {}, {}});
      if (fresh && type.divided != nullptr)
        out_.divided.push_back({type.divided,
                                type.quadratic,
                                entity(type.dim, tags_of_[index(label_[e])]),
                                where,
                                {},
                                {}});
      type.divided == nullptr ? put(out_.elements[entry->second])
                              : put(out_.divided[entry->second]);
    }
    order_lines();
  }

  /// In the plane lines are sides: their corners come first, wherever the file has the middle.
  void order_lines() {
    std::vector<char> corner(out_.node_tags.size(), 0);
    for (std::size_t e = 0; e < kept_.size() && dim_ == 2; ++e) {
      const AbaqusPieces::Element& element = pieces_.elements()[e];
      const std::int32_t corners = element.type->nodes / (element.type->quadratic ? 2 : 1);
      for (std::int32_t a = 0; a < corners; ++a) corner[index(pieces_.nodes_of(element)[a])] = 1;
    }
    for (FileMesh::Elements& block : out_.elements) {
      if (dim_ != 2 || block.type->dim != 1 || block.type->nodes != 3) continue;
      for (auto end = block.nodes.begin(); end != block.nodes.end(); end += 3)
        std::stable_sort(end, end + 3, [&corner](std::int32_t a, std::int32_t b) {
          return corner[index(a)] > corner[index(b)];
        });
    }
  }

  void add_notes(std::vector<std::string> of_groups) {
    std::vector<std::string> read, instances;
    for (const std::string& name : types_) {
      const AbaqusElement& type = *abaqus_element(name);
      const bool plain = name == fmt::format("C3D{}", type.nodes) || type.type == nullptr;
      if (!plain && type.dim == dim_)
        read.push_back(fmt::format("{} as {}", name, type.type->name));
    }
    if (!read.empty()) out_.notes.push_back(fmt::format("{}", fmt::join(read, ", ")));
    std::vector<std::string> collapsed;
    for (const auto& [shape, count] : pieces_.collapsed_to())
      collapsed.push_back(fmt::format("{} {}", count, shape));
    if (!collapsed.empty())
      out_.notes.push_back(
          fmt::format("of elements with repeated nodes: {}", fmt::join(collapsed, ", ")));
    if (part_.empty() && model_.instances.size() > 1)
      out_.notes.push_back(
          fmt::format("{} instances are one body: part chooses one", model_.instances.size()));
    if (!model_.skipped.empty())
      out_.notes.push_back(
          fmt::format("skipped, not applied: *{}", fmt::join(model_.skipped, ", *")));
    std::ranges::move(of_groups, std::back_inserter(out_.notes));
  }

  const AbaqusModel& model_;
  const AbaqusCursor& file_;
  AbaqusPieces pieces_;
  std::string named_, part_;  // the part as written, and in capitals
  FileMesh out_;
  int dim_ = 0, tags_ = 0, entities_ = 0;
  std::vector<char> kept_;  // (elements)
  std::vector<int> label_;  // (elements) into tags_of_
  std::vector<std::vector<int>> tags_of_ = {{}};
  std::map<std::pair<int, int>, int> next_;  // label of a label and one more tag
  std::set<std::string> types_;              // names of those that are kept
};

}  // namespace

Mesh abaqus_mesh(std::string bytes, const std::string& name, double scale, const std::string& part,
                 int surface_in, std::vector<std::string>* notes, CellWords* words) {
  AbaqusCursor cursor(std::move(bytes), name);
  const AbaqusModel model = parse_abaqus(cursor);
  AbaqusBuilder builder(model, cursor, part);
  FileMesh file = builder.build();
  if (notes != nullptr) notes->insert(notes->end(), file.notes.begin(), file.notes.end());
  std::vector<std::vector<std::int32_t>> origins;
  Mesh mesh = mesh_of(std::move(file), scale, surface_in, &origins);
  if (words != nullptr && !origins.empty()) *words = builder.words(std::move(origins));
  return mesh;
}

Mesh read_abaqus(const std::string& path, double scale, const std::string& part, int surface_in,
                 std::vector<std::string>* notes, CellWords* words) {
  return abaqus_mesh(file_bytes(path), path, scale, part, surface_in, notes, words);
}

std::uint64_t digest_of_abaqus(const std::string& path) {
  AbaqusCursor cursor(file_bytes(path), path);
  AbaqusCard card;
  while (cursor.next_card(card))
    if (card.has("INPUT")) cursor.read_from(card.value("INPUT"));
  std::uint64_t digest = 0;
  const std::vector<std::string> files = cursor.files();
  if (files.size() == 1) return digest_of_file(path);
  for (const std::string& file : files) digest = hash_combine(digest, digest_of_file(file));
  return std::max<std::uint64_t>(1, digest);
}

}  // namespace abut
