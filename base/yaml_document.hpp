#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.hpp"

namespace YAML {
class Node;
}

namespace abut {

class Copies;
class StageOrigin;
class YamlTree;

/// First keys of a document that were read with a unit of their own and without one.
struct UnitsRead {
  std::string with, without;  // key paths; empty: none
};

/// One parsed YAML file with the values that the command line puts in place (`key.path=value`, the
/// value in YAML; null takes the key out; `*` stands for every key at its place). Text, name and
/// overrides, a `*` written out, are kept, so that another process can build the same document from
/// them. Key paths read
/// `bodies.left.initial.velocity` and `meta.expect[0].measure`. Bodies that are `like` another one
/// and copies of bodies are written out: what a document has at a path, they have. All that is
/// wrong with the file's form throws InputError: syntax, duplicate keys, several documents.
class Document {
 public:
  static Document load(const std::string& path, std::vector<std::string> overrides = {});
  static Document from_text(std::string name, std::string text,
                            std::vector<std::string> overrides = {});
  Document(Document&& other) noexcept;
  Document& operator=(Document&& other) noexcept;
  ~Document();

  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  const std::vector<std::string>& overrides() const { return overrides_; }
  /// Those with which another process builds the same document, without the tables that this one
  /// has read: they could be others there, or none.
  std::vector<std::string> overrides_elsewhere() const;

  bool has(std::string_view path) const;
  /// The same, or in the place of the map that has the key stands a short form of it, as the name
  /// alone of a choice.
  bool says(std::string_view path) const;
  /// Keys of the map at a path, in the file's order; empty when there is no map.
  std::vector<std::string> keys(std::string_view path) const;
  /// Whether the choice at a path is this one: the bare word, or a map with this key.
  bool chooses(std::string_view path, std::string_view name) const;
  /// For InputError::where: "scene.yaml:12: bodies.left", or "scene.yaml, from --set key=value:
  /// key". A path that is not there is located at its nearest ancestor; what a body has from
  /// another one where it stands, with " (like left)" after the path; what copies have where it is
  /// written once.
  std::string where(std::string_view path) const;

  /// The scene of the stage that follows this one, where `stages` has one: text and overrides are
  /// its own, places those of the file: in a stage that says it, or in the scene.
  std::optional<Document> next_stage() const;

  /// The body that another one is a copy of; empty: none.
  std::string body_of_copy(std::string_view name) const;
  /// "ball_1 to ball_9": the copies for which a name stands in the text; empty: none.
  std::string copies_of(std::string_view body) const;

  /// What the scene says under `units`; SI where it says nothing.
  const UnitSystem& units() const { return units_; }
  bool declares_units() const { return declares_units_; }
  /// Filled by whoever reads keys.
  UnitsRead& units_read() const { return *units_read_; }

  const YAML::Node& root() const;
  const YamlTree& tree() const { return *tree_; }

 private:
  Document(std::string name, std::string text, std::vector<std::string> overrides);
  void write_out(const YAML::Node& text);
  void read_units();
  void write_out_likes();
  void write_out_copies();
  bool is_set_at(std::string_view path) const;
  std::string place_of(std::string_view path, std::string_view shown) const;

  std::string name_, text_;
  std::vector<std::string> overrides_;
  UnitSystem units_;
  bool declares_units_ = false;
  std::unique_ptr<UnitsRead> units_read_ = std::make_unique<UnitsRead>();
  std::unique_ptr<YamlTree> tree_;
  std::unique_ptr<YamlTree> written_;  // before bodies were written out; null: it is the same
  std::unique_ptr<Copies> copies_;     // null: there are none
  // Of a scene with stages: with the overrides that have their place there, and the others.
  std::unique_ptr<YamlTree> before_;
  std::vector<std::string> later_;
  std::unique_ptr<StageOrigin> origin_;  // of the scene of a stage; null: it is no stage
};

/// "bodies.left[0]" into "bodies", "left", "[0]".
std::vector<std::string> split_path(std::string_view path);
/// The inverse, one step at a time.
std::string join_path(std::string_view parent, std::string_view child);

}  // namespace abut
