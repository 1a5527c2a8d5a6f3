#include "subdomain_solver/fe/abaqus_model.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/counted.hpp"
#include "base/index.hpp"

namespace abut {
namespace {

using Picked = AbaqusModel::Picked;
using Fields = std::vector<std::string_view>;

/// Keywords that make or move nodes and elements: passed over, the mesh would be another.
constexpr std::array<std::string_view, 7> makers = {"NGEN",  "NFILL",  "NCOPY", "NMAP",
                                                    "ELGEN", "ELCOPY", "SYSTEM"};

bool is_number(std::string_view field) {
  return !field.empty() && std::isdigit(static_cast<unsigned char>(field.front())) != 0 &&
         field.find_first_not_of("0123456789") == std::string_view::npos;
}

class AbaqusParser {
 public:
  explicit AbaqusParser(AbaqusCursor& file) : file_(file) {}

  AbaqusModel parse() {
    while (file_.next_card(card_)) {
      if (card_.keyword == "NODE") {
        nodes();
      } else if (card_.keyword == "ELEMENT") {
        elements();
      } else if (card_.keyword == "NSET") {
        set("NSET", scope().node_sets);
      } else if (card_.keyword == "ELSET") {
        set("ELSET", scope().element_sets);
      } else if (card_.keyword == "SURFACE") {
        surface();
      } else if (card_.keyword == "INSTANCE") {
        instance();
      } else if (!bracket()) {
        other();
      }
    }
    constexpr const char* cut = "Is the file cut short? Write it again.";
    if (part_ >= 0) file_.refuse("ends within a *PART", cut);
    if (in_assembly_) file_.refuse("ends within its *ASSEMBLY", cut);
    return std::move(model_);
  }

 private:
  AbaqusModel::Scope& scope() { return part_ < 0 ? model_.assembly : model_.parts[index(part_)]; }

  /// The value of a parameter that must be there.
  std::string needed(const char* key) const {
    std::string value = card_.value(key);
    if (value.empty())
      file_.refuse(fmt::format("has *{} without {}", card_.keyword, key),
                   fmt::format("Write *{}, {}=...", card_.keyword, key));
    return value;
  }

  void open_input() {
    if (card_.has("INPUT")) file_.read_from(card_.value("INPUT"));
  }

  /// Begin and end of parts and of the assembly; false: the keyword is another.
  bool bracket() {
    if (card_.keyword == "PART") {
      if (part_ >= 0 || in_assembly_)
        file_.refuse("has a *PART within another one or the assembly", "Write *END PART before.");
      const std::string name = needed("NAME");
      if (part_of(name) >= 0)
        file_.refuse(fmt::format("has the part '{}' twice", name), "Give them different names.");
      part_ = static_cast<std::int32_t>(model_.parts.size());
      model_.parts.emplace_back().name = name;
    } else if (card_.keyword == "END PART") {
      part_ = -1;
    } else if (card_.keyword == "ASSEMBLY" || card_.keyword == "END ASSEMBLY") {
      in_assembly_ = card_.keyword == "ASSEMBLY";
    } else {
      return card_.keyword == "END INSTANCE" || card_.keyword == "HEADING";
    }
    return true;
  }

  std::int32_t part_of(const std::string& name) const {
    for (std::size_t p = 0; p < model_.parts.size(); ++p)
      if (in_capitals(model_.parts[p].name) == in_capitals(name))
        return static_cast<std::int32_t>(p);
    return -1;
  }

  std::int32_t instance_of(std::string_view name) const {
    for (std::size_t i = 0; i < model_.instances.size(); ++i)
      if (in_capitals(model_.instances[i].name) == in_capitals(name))
        return static_cast<std::int32_t>(i);
    return -1;
  }

  void nodes() {
    if (card_.has("SYSTEM") && in_capitals(card_.value("SYSTEM")) != "R")
      file_.refuse("has nodes in cylindrical or spherical coordinates",
                   "Write rectangular coordinates.");
    AbaqusModel::Scope& own = scope();
    open_input();
    std::vector<Picked> all;
    for (Fields fields; file_.next_data(fields);) {
      const std::int64_t number = file_.integer(fields[0], "the number of a node");
      if (fields.size() < 2 || fields.size() > 7)
        file_.refuse(
            fmt::format("has node {} with {} numbers behind it", number, fields.size() - 1),
            "Write NUMBER, x, y, z.");
      if (own.numbers.size() >= index(std::numeric_limits<std::int32_t>::max()))
        file_.refuse("has too many nodes", "Make the mesh coarser.");
      const auto place = static_cast<std::int32_t>(own.numbers.size());
      if (!own.place_of.try_emplace(number, place).second)
        file_.refuse(fmt::format("has node {} twice", number),
                     "Take one of them out, or give it another number.");
      own.numbers.push_back(number);
      for (std::size_t d = 1; d < 4; ++d)
        own.points.push_back(d < fields.size() ? file_.real(fields[d]) : 0.0);
      add_number(all, number);
    }
    if (card_.has("NSET")) add(own.node_sets, needed("NSET"), std::move(all));
  }

  void elements() {
    AbaqusModel::Elements block;
    block.name = in_capitals(needed("TYPE"));
    block.type = abaqus_element(block.name);
    if (block.type == nullptr)
      file_.refuse(fmt::format("has elements of type {}", block.name),
                   abaqus_element_remedy(block.name));
    open_input();
    const auto count = index(block.type->nodes);
    std::vector<Picked> all;
    for (Fields fields; file_.next_data(fields);) {
      const std::int64_t number = file_.integer(fields[0], "the number of an element");
      block.numbers.push_back(number);
      block.lines.push_back(file_.line());
      add_number(all, number);
      const std::size_t before = block.nodes.size();
      take_nodes(block, fields, 1);
      while (block.nodes.size() - before < count && file_.next_data(fields))
        take_nodes(block, fields, 0);
      if (block.nodes.size() - before != count)
        file_.refuse(fmt::format("has element {} ({}) with {} nodes in place of {}", number,
                                 block.name, block.nodes.size() - before, count),
                     "Write as many as the type has, or another type.");
    }
    if (card_.has("ELSET")) add(scope().element_sets, needed("ELSET"), std::move(all));
    scope().elements.push_back(std::move(block));
  }

  void take_nodes(AbaqusModel::Elements& block, const Fields& fields, std::size_t first) const {
    for (std::size_t k = first; k < fields.size(); ++k)
      block.nodes.push_back(file_.integer(fields[k], "the number of a node"));
  }

  /// Numbers that follow each other become one entry.
  void add_number(std::vector<Picked>& all, std::int64_t number, std::int32_t instance = -1) const {
    if (!all.empty()) {
      Picked& last = all.back();
      const bool plain = last.step == 1 && !last.generated && !last.elements_nodes;
      if (plain && last.instance == instance && last.last + 1 == number) {
        last.last = number;
        return;
      }
    }
    Picked one;
    one.first = one.last = number;
    one.instance = instance;
    one.line = file_.line();
    all.push_back(one);
  }

  void add(AbaqusModel::Sets& sets, const std::string& name, std::vector<Picked> picked) {
    const auto [entry, fresh] = sets.try_emplace(in_capitals(name));
    AbaqusModel::Set& set = entry->second;
    if (fresh) set.name = name;
    if (fresh) set.line = card_.line;
    set.internal = card_.has("INTERNAL");
    set.picked.insert(set.picked.end(), picked.begin(), picked.end());
  }

  /// What a name or number stands for in a scope, or in an instance as seen from the assembly.
  /// `nodes`: a set of nodes, else of elements.
  std::vector<Picked> picked_by(std::string_view field, std::int32_t instance, bool nodes) {
    std::vector<Picked> out;
    const std::size_t dot = field.find('.');
    if (instance < 0 && part_ < 0 && dot != std::string_view::npos &&
        instance_of(field.substr(0, dot)) >= 0)
      return picked_by(field.substr(dot + 1), instance_of(field.substr(0, dot)), nodes);
    if (is_number(field)) {
      add_number(out, file_.integer(field, nodes ? "a node" : "an element"), instance);
      return out;
    }
    const AbaqusModel::Scope& from =
        instance < 0 ? scope() : model_.parts[index(model_.instances[index(instance)].part)];
    const AbaqusModel::Sets& sets = nodes ? from.node_sets : from.element_sets;
    const auto found = sets.find(in_capitals(field));
    if (found == sets.end())
      file_.refuse(fmt::format("names '{}', which is no set of {} above it", field,
                               nodes ? "nodes" : "elements"),
                   "Write the set before it, with this name.");
    out = found->second.picked;
    for (Picked& one : out)
      if (instance >= 0) one.instance = instance;
    return out;
  }

  void set(const char* key, AbaqusModel::Sets& sets) {
    const std::string name = needed(key);
    const bool nodes = card_.keyword == "NSET";
    std::int32_t instance = -1;
    if (card_.has("INSTANCE")) instance = named_instance(needed("INSTANCE"));
    std::vector<Picked> all;
    if (nodes && card_.has("ELSET")) {
      all = picked_by(needed("ELSET"), instance, false);
      for (Picked& one : all) one.elements_nodes = true;
    }
    open_input();
    for (Fields fields; file_.next_data(fields);) {
      if (card_.has("GENERATE")) {
        all.push_back(generated(fields, instance));
        continue;
      }
      for (std::string_view field : fields) {
        if (field.empty()) continue;
        const std::vector<Picked> more = picked_by(field, instance, nodes);
        if (is_number(field))
          add_number(all, more[0].first, instance);
        else
          all.insert(all.end(), more.begin(), more.end());
      }
    }
    add(sets, name, std::move(all));
  }

  std::int32_t named_instance(const std::string& name) const {
    const std::int32_t found = instance_of(name);
    if (found < 0)
      file_.refuse(fmt::format("names the instance '{}', which is not above it", name),
                   "Write *INSTANCE with this name before it.");
    return found;
  }

  Picked generated(const Fields& fields, std::int32_t instance) const {
    if (fields.size() < 2 || fields.size() > 3)
      file_.refuse(fmt::format("has {} in a line of GENERATE", counted(fields.size(), "number")),
                   "Write FIRST, LAST, STEP.");
    Picked range;
    range.first = file_.integer(fields[0], "the first number");
    range.last = file_.integer(fields[1], "the last number");
    if (fields.size() == 3 && !fields[2].empty()) range.step = file_.integer(fields[2], "the step");
    range.instance = instance;
    range.generated = true;
    range.line = file_.line();
    if (range.last < range.first)
      file_.refuse(fmt::format("has GENERATE from {} down to {}", range.first, range.last),
                   "Write the smaller number first.");
    return range;
  }

  void surface() {
    AbaqusModel::Surface surface;
    surface.name = needed("NAME");
    surface.internal = card_.has("INTERNAL");
    surface.line = card_.line;
    const std::string type = in_capitals(card_.value("TYPE"));
    surface.of_nodes = type == "NODE";
    if ((!type.empty() && type != "NODE" && type != "ELEMENT") || card_.has("COMBINE"))
      file_.refuse(
          fmt::format("has the surface '{}' of another kind than faces and nodes", surface.name),
          "Write it with TYPE=ELEMENT and faces S1, S2, ..., or TYPE=NODE.");
    for (Fields fields; file_.next_data(fields);) {
      AbaqusModel::Surface::Row row;
      row.picked = picked_by(fields[0], -1, surface.of_nodes);
      row.line = file_.line();
      if (!surface.of_nodes) row.face = face_of(fields);
      surface.rows.push_back(std::move(row));
    }
    scope().surfaces.push_back(std::move(surface));
  }

  int face_of(const Fields& fields) const {
    const std::string face = fields.size() < 2 ? "" : in_capitals(fields[1]);
    if (face.empty()) return 0;
    if (face.size() == 2 && face[0] == 'S' && face[1] >= '1' && face[1] <= '6')
      return face[1] - '0';
    file_.refuse(fmt::format("names the face {} of a surface", face),
                 "Write a face S1 to S6 behind the set or number of the elements, or none for all "
                 "that no other cell shares.");
  }

  void instance() {
    AbaqusModel::Instance one;
    one.name = needed("NAME");
    const std::string part = needed("PART");
    one.part = part_of(part);
    if (one.part < 0)
      file_.refuse(fmt::format("has an instance of '{}', which is no *PART above it", part),
                   "Write the part before its instances; an instance has no mesh of its own.");
    if (instance_of(one.name) >= 0)
      file_.refuse(fmt::format("has the instance '{}' twice", one.name),
                   "Give them different names.");
    Fields fields;
    std::vector<double> numbers;
    for (int k = 0; k < 2 && file_.next_data(fields); ++k) {
      for (std::string_view field : fields) numbers.push_back(file_.real(field));
      numbers.resize(k == 0 ? 3 : 10);
    }
    numbers.resize(10);
    std::copy_n(numbers.begin(), 3, one.move.begin());
    std::copy_n(numbers.begin() + 3, 3, one.a.begin());
    std::copy_n(numbers.begin() + 6, 3, one.b.begin());
    one.degrees = numbers[9];
    if (one.degrees != 0.0 && one.a == one.b)
      file_.refuse(fmt::format("turns the instance '{}' about an axis without length", one.name),
                   "Write two points of the axis, and the angle in degrees.");
    model_.instances.push_back(std::move(one));
  }

  /// Not of meshes: told to people, not applied.
  void other() {
    if (std::ranges::find(makers, card_.keyword) != makers.end())
      file_.refuse(fmt::format("has *{}, which makes or moves nodes or elements", card_.keyword),
                   "Write the mesh out in full, as Abaqus/CAE and Gmsh do.");
    if (card_.keyword.ends_with("SECTION") && card_.has("ELSET"))
      model_.sections.push_back(
          {card_.keyword, in_capitals(card_.value("ELSET")), part_, card_.line});
    if (card_.keyword.starts_with("END ")) return;
    if (std::ranges::find(model_.skipped, card_.keyword) == model_.skipped.end())
      model_.skipped.push_back(card_.keyword);
  }

  AbaqusCursor& file_;
  AbaqusModel model_;
  AbaqusCard card_;
  std::int32_t part_ = -1;  // that is being read; -1: none
  bool in_assembly_ = false;
};

}  // namespace

AbaqusModel parse_abaqus(AbaqusCursor& file) { return AbaqusParser(file).parse(); }

}  // namespace abut
