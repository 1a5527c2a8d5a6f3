#include "base/yaml_moved.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "base/yaml_tree.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

std::optional<double> number_in(const YAML::Node& node, const std::string& unit) {
  if (!node.IsScalar()) return std::nullopt;
  const std::optional<double> plain =
      is_plain(node) ? parse<double>(node.Scalar()) : std::optional<double>();
  const std::optional<Quantity> quantity = split_quantity(node.Scalar());
  if (plain || !quantity) return plain;
  const std::optional<Unit> from = parse_unit(quantity->unit), to = parse_unit(unit);
  if (!from || !to || from->dimension != to->dimension) return std::nullopt;
  return converted(quantity->number, *from, *to);
}

/// In the unit. Nothing where a value is neither a number nor a list of numbers, or has another
/// unit.
std::optional<std::vector<double>> numbers_in(const YAML::Node& node, const std::string& unit) {
  const std::optional<double> alone = number_in(node, unit);
  if (alone) return std::vector<double>{*alone};
  if (!node.IsSequence()) return std::nullopt;
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    const std::optional<double> value = number_in(item, unit);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// Of lists of different lengths, the shorter one is 0 beyond its end.
YAML::Node sum(const YAML::Node& list, const std::vector<double>& more, const std::string& unit) {
  std::optional<std::vector<double>> values = numbers_in(list, unit);
  if (!values) return YAML::Clone(list);
  values->resize(std::max(values->size(), more.size()));
  for (std::size_t i = 0; i < more.size(); ++i) (*values)[i] += more[i];
  return numbers_of(*values);
}

/// An expression in x, y, z of a body that has moved: "2 * x" is "2 * (x - 0.1)".
std::string moved(const std::string& text, const std::vector<double>& way) {
  const auto is_of_word = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; };
  std::string out;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end) {
    end = begin;
    while (end < text.size() && is_of_word(static_cast<unsigned char>(text[end]))) ++end;
    end = std::max(end, begin + 1);
    const std::string word = text.substr(begin, end - begin);
    const std::size_t axis = word.size() == 1 ? std::string_view("xyz").find(word[0]) : 3;
    const double along = axis < way.size() ? way[axis] : 0.0;
    out += along == 0.0 ? word
                        : fmt::format("({} {} {})", word, along < 0.0 ? '+' : '-', std::abs(along));
  }
  return out;
}

YAML::Node moved_fields(const YAML::Node& texts, const std::vector<double>& way) {
  if (texts.IsScalar()) return YAML::Node(moved(texts.Scalar(), way));
  if (!texts.IsSequence()) return YAML::Clone(texts);
  YAML::Node list(YAML::NodeType::Sequence);
  for (const YAML::Node& text : texts)
    list.push_back(text.IsScalar() ? YAML::Node(moved(text.Scalar(), way)) : YAML::Clone(text));
  return list;
}

YAML::Node moved_points(const YAML::Node& points, const std::vector<double>& way,
                        const std::string& metre) {
  if (!points.IsMap()) return YAML::Clone(points);
  YAML::Node out(YAML::NodeType::Map);
  for (const auto& pair : points) {
    YAML::Node point = YAML::Clone(pair.second);
    const std::optional<Found> at = child(point, "at");
    if (at) point["at"] = sum(at->node, way, metre);
    if (!point.IsMap()) point = sum(point, way, metre);  // the place alone
    out.force_insert(pair.first.Scalar(), point);
  }
  return out;
}

/// The point about which a tool turns is a place as well.
YAML::Node moved_model(const YAML::Node& model, const std::vector<double>& way,
                       const std::string& metre) {
  YAML::Node out = YAML::Clone(model);
  const std::optional<Found> tool = child(out, "rigid_tool");
  const std::optional<Found> turn = tool ? child(tool->node, "turn") : std::nullopt;
  if (!turn || !child(turn->node, "about")) return out;
  YAML::Node turned = turn->node;
  turned["about"] = sum(child(turn->node, "about")->node, way, metre);
  return out;
}

YAML::Node moved_initial(const YAML::Node& initial, const YAML::Node& own,
                         const std::vector<double>& way, const UnitSystem& units) {
  YAML::Node out(YAML::NodeType::Map);
  const auto put = [&out, &way](const std::string& key, const YAML::Node& value) {
    const bool field = key == "displacement_field" || key == "velocity_field";
    out.force_insert(key, field ? moved_fields(value, way) : YAML::Clone(value));
  };
  for (const auto& pair : initial) {
    const std::string& key = pair.first.Scalar();
    const std::optional<Found> other = child(own, key);
    if (!other) {
      put(key, pair.second);
    } else if (key == "position" || key == "velocity") {
      const std::string unit = units.word(key == "position" ? "m" : "m/s");
      out.force_insert(key, sum(pair.second, numbers_in(other->node, unit).value_or(way), unit));
    } else if (!other->node.IsNull()) {
      put(key, other->node);
    }
  }
  for (const auto& pair : own)
    if (!child(initial, pair.first.Scalar())) put(pair.first.Scalar(), pair.second);
  return out;
}

}  // namespace

YAML::Node numbers_of(const std::vector<double>& values) {
  YAML::Node list(YAML::NodeType::Sequence);
  for (const double value : values) list.push_back(fmt::format("{}", value));
  list.SetStyle(YAML::EmitterStyle::Flow);
  return list;
}

YAML::Node moved_copy(const YAML::Node& body, const YAML::Node& own, const UnitSystem& units) {
  const std::string metre = units.word("m");
  const std::optional<Found> position = child(own, "position");
  const std::vector<double> way =
      position ? numbers_in(position->node, metre).value_or(std::vector<double>())
               : std::vector<double>();
  YAML::Node out(YAML::NodeType::Map);
  bool begins = false;
  for (const auto& pair : body) {
    const std::string& key = pair.first.Scalar();
    if (key == "copies") continue;
    const bool initial = key == "initial" && pair.second.IsMap();
    begins = begins || key == "initial";
    out.force_insert(key, initial           ? moved_initial(pair.second, own, way, units)
                          : key == "points" ? moved_points(pair.second, way, metre)
                          : key == "model"  ? moved_model(pair.second, way, metre)
                                            : YAML::Clone(pair.second));
  }
  if (!begins)
    out.force_insert("initial", moved_initial(YAML::Node(YAML::NodeType::Map), own, way, units));
  return out;
}

}  // namespace abut
