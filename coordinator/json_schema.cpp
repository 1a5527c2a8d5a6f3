#include "coordinator/json_schema.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/assert.hpp"
#include "base/unit_pattern.hpp"

namespace abut {
namespace {

using Json = nlohmann::ordered_json;
using Kind = KeyNode::Kind;

constexpr std::size_t short_text = 120;  // a part of the schema that may stand several times

const KeyNode* find(const std::vector<KeyNode>& keys, std::string_view name) {
  const auto found = std::ranges::find(keys, name, &KeyNode::name);
  return found == keys.end() ? nullptr : &*found;
}

void limit(const Rule& rule, Json& schema) {
  if (std::isfinite(rule.low)) schema[rule.above_low ? "exclusiveMinimum" : "minimum"] = rule.low;
  if (std::isfinite(rule.high))
    schema[rule.below_high ? "exclusiveMaximum" : "maximum"] = rule.high;
}

Json number(const Rule& rule) {
  Json schema = {{"type", "number"}};
  limit(rule, schema);
  return schema;
}

/// A number, or where the key has a unit, a number with a unit of its own.
Json number_of(const KeyNode& key) {
  if (key.unit.empty()) return number(key.rule);
  return {{"anyOf",
           {number(key.rule),
            {{"type", "string"},
             {"pattern",
              fmt::format("^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)? *{} *$", unit_pattern(key.unit))}}}}};
}

Json preset_names(const std::vector<Preset>& presets) {
  Json names = Json::array();
  for (const Preset& preset : presets) names.push_back(preset.name);
  return names;
}

Json text() { return {{"type", {"string", "number", "boolean"}}}; }

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json one_or_list_of(const Json& item) { return {{"anyOf", {item, list_of(item)}}}; }

/// Parts of the schema that stand more than once, under names of their keys.
class Definitions {
 public:
  /// The part itself where it is short, else a reference to it.
  Json shared(Json part, const std::string& name) {
    const std::string dumped = part.dump();
    if (dumped.size() < short_text) return part;
    const auto known = names_.find(dumped);
    if (known != names_.end()) return reference(known->second);
    std::string own = name;
    for (int k = 2; all_.contains(own); ++k) own = fmt::format("{}_{}", name, k);
    names_.emplace(dumped, own);
    all_[own] = std::move(part);
    return reference(own);
  }
  Json take() { return std::move(all_); }

 private:
  static Json reference(const std::string& name) { return {{"$ref", "#/definitions/" + name}}; }

  Json all_ = Json::object();
  std::map<std::string, std::string> names_;  // by text
};

/// Schemas of keys. `partial`: of a body that has the rest from another one, so that no key is
/// required and null leaves one out.
class Schemas {
 public:
  Schemas(Definitions& definitions, bool partial) : definitions_(definitions), partial_(partial) {}

  Json map_of(const std::vector<KeyNode>& keys, bool open) const {
    Json properties = Json::object(), required = Json::array();
    for (const KeyNode& key : keys) {
      properties[key.name] = property(key);
      if (key.required && !partial_) required.push_back(key.name);
    }
    Json schema = {{"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = std::move(required);
    if (!open) schema["additionalProperties"] = false;
    return schema;
  }

 private:
  /// Null leaves out what another body has.
  Json or_null(Json schema) const {
    if (!partial_) return schema;
    return {{"anyOf", {std::move(schema), {{"type", "null"}}}}};
  }

  /// With what editors show beside the key.
  Json property(const KeyNode& key) const {
    Json schema = or_null(definitions_.shared(value(key), key.name));
    if (schema.contains("$ref")) schema = {{"allOf", {std::move(schema)}}};
    std::string words = key.help;
    if (!key.unit.empty()) words += fmt::format(" [{}]", key.unit);
    if (key.required) words += "; required";
    if (!key.required && key.fallback != "optional" && key.fallback != "absent")
      words += "; default " + key.fallback;
    if (!words.empty()) schema["description"] = std::move(words);
    return schema;
  }

  Json value(const KeyNode& key) const {
    switch (key.kind) {
      case Kind::number:
        return number_of(key);
      case Kind::whole: {
        Json schema = {{"type", "integer"}};
        limit(key.rule, schema);
        return schema;
      }
      case Kind::flag:
        return {{"type", "boolean"}};
      case Kind::text:
        return text();
      case Kind::numbers:
        return one_or_list_of(number_of(key));
      case Kind::words:
        return one_or_list_of(text());
      case Kind::two_words: {
        Json schema = list_of(text());
        schema["minItems"] = schema["maxItems"] = 2;
        return schema;
      }
      case Kind::word:
        return {{"enum", key.words}};
      case Kind::map:
        return items_of(key);
      case Kind::list:
        return list_of(definitions_.shared(items_of(key), key.name + "_item"));
      case Kind::names:
        return {{"type", "object"},
                {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
                {"additionalProperties",
                 or_null(definitions_.shared(items_of(key), key.name + "_item"))}};
      case Kind::choice:
        return choice(key);
    }
    return {};
  }

  /// A map of a node's keys, or the plain value that may stand in its place.
  Json items_of(const KeyNode& node) const {
    Json map = map_of(node.keys, node.open);
    if (!node.presets.empty())
      return {{"anyOf", {{{"enum", preset_names(node.presets)}}, std::move(map)}}};
    const KeyNode* plain = node.shorthand.empty() ? nullptr : find(node.keys, node.shorthand);
    if (plain == nullptr) return map;
    return {{"anyOf", {value(*plain), std::move(map)}}};
  }

  Json choice(const KeyNode& key) const {
    Json alone = preset_names(key.presets), properties = Json::object();
    for (const KeyNode& alternative : key.keys) {
      const bool needs = std::ranges::any_of(alternative.keys, &KeyNode::required);
      if (!needs) alone.push_back(alternative.name);
      properties[alternative.name] =
          or_null(definitions_.shared(items_of(alternative), alternative.name));
    }
    Json map = {{"type", "object"},
                {"properties", std::move(properties)},
                {"additionalProperties", false},
                {"minProperties", 1}};
    if (!partial_) map["maxProperties"] = 1;
    if (alone.empty()) return map;
    return {{"anyOf", {{{"enum", std::move(alone)}}, std::move(map)}}};
  }

  Definitions& definitions_;
  bool partial_;
};

/// A body of ours: keys of the scene's reader and of the body's. Where `like` gives it the rest, no
/// key is required; where its model is external, another reader has its keys.
Json body_schema(const KeyNode& entry, const KeyNode& body, const KeyNode& external,
                 Definitions& definitions) {
  std::vector<KeyNode> whole = entry.keys, foreign = entry.keys;
  whole.insert(whole.end(), body.keys.begin(), body.keys.end());
  foreign.insert(foreign.end(), external.keys.begin(), external.keys.end());
  const Json full = Schemas(definitions, false).map_of(whole, false);
  const Json partial = Schemas(definitions, true).map_of(whole, false);
  const Json of_others = Schemas(definitions, false).map_of(foreign, false);
  const Json is_external = {
      {"properties",
       {{"model",
         {{"anyOf",
           {{{"const", "external"}}, {{"type", "object"}, {"required", {"external"}}}}}}}}},
      {"required", {"model"}}};
  return {{"if", {{"required", {"like"}}}},
          {"then", definitions.shared(partial, "body_like_another")},
          {"else",
           {{"if", is_external},
            {"then", definitions.shared(of_others, "body_of_another_program")},
            {"else", definitions.shared(full, "body")}}}};
}

}  // namespace

std::string json_schema(const Reference& reference) {
  const std::vector<KeySection>& sections = reference.sections();
  ABUT_ASSERT(sections.size() == 3);
  const KeyNode &scene = sections[0].root, &body = sections[1].root, &external = sections[2].root;
  const KeyNode* bodies = find(scene.keys, "bodies");
  ABUT_ASSERT(bodies != nullptr);
  Definitions definitions;
  Json whole = Schemas(definitions, false).map_of(scene.keys, false);
  const std::string unit =
      fmt::format("(?:{}|{}|{})", unit_pattern("m"), unit_pattern("kg"), unit_pattern("s"));
  Json& units = whole["properties"]["units"];
  units["type"] = "string";
  units["pattern"] = fmt::format("^ *(?:SI|{0}(?:[ ,]+{0}){{2}})[ ,]*$", unit);
  Json& entry = whole["properties"]["bodies"];
  entry = {{"type", "object"},
           {"description", bodies->help},
           {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
           {"additionalProperties", body_schema(*bodies, body, external, definitions)}};
  Json out = {{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "A scene of abut"},
              {"$comment",
               "Printed by `abut reference --json-schema`. An editor with a YAML language server "
               "checks and completes a scene that begins with the line: "
               "# yaml-language-server: $schema=abut.schema.json"}};
  out.update(whole);
  out["definitions"] = definitions.take();
  return out.dump(1) + "\n";
}

}  // namespace abut
