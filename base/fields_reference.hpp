#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.hpp"

namespace abut {

/// A declared key as data, with the keys below it.
struct KeyNode {
  enum class Kind {
    number,
    whole,
    flag,
    text,
    numbers,
    words,
    two_words,
    word,    // one of `words`
    map,     // of `keys`
    list,    // of maps of `keys`
    names,   // from names that the user chooses to maps of `keys`
    choice,  // a map with one of `keys`, each a map; or the name of one alone
  };
  std::string name, unit, help, fallback;
  bool required = false;
  Kind kind = Kind::map;
  Rule rule;
  std::vector<std::string> words;
  std::string shorthand;        // of a map, or of items: the key that a plain value is meant for
  bool open = false;            // of a map, or of items: other keys belong to another reader
  std::vector<Preset> presets;  // of a choice or a map: names that may stand in its place
  std::vector<KeyNode> keys;

  /// "number, at least 0", "one of red, green", "map from names to maps".
  std::string type() const;
};

/// What is documented at one place of a scene.
struct KeySection {
  std::string heading;
  std::string path;  // of its keys
  KeyNode root;      // a map
};

/// The keys of structs as sections of Markdown tables: key path, type, unit, default or "required",
/// help. Generated from the declared fields, so it cannot disagree with the reader.
class Reference {
 public:
  /// The keys of a default-constructed S, which live at `path`, under the heading.
  template <HasFields S>
  void add(std::string_view heading, std::string_view path) {
    S sample{};
    const std::unique_ptr<Fields> documenter = documenter_of(heading, path);
    sample.fields(*documenter);
  }
  const std::vector<KeySection>& sections() const { return sections_; }

  /// What alternatives of a choice have in common stands once: `{fe,modal}.dimension`, or with `*`
  /// where all of them have it.
  std::string markdown() const;
  /// The part of the reference at a key path of a scene, for people. Throws InputError: there is no
  /// such key.
  std::string part(std::string_view path) const;
  /// Key paths one by one, a line each.
  std::string key_paths() const;

 private:
  std::unique_ptr<Fields> documenter_of(std::string_view heading, std::string_view path);
  std::vector<KeySection> sections_;
};

}  // namespace abut
