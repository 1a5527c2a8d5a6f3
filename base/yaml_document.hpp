#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace YAML {
class Node;
}

namespace abut {

/// One parsed YAML file with the values that the command line puts in place (`key.path=value`, the
/// value in YAML; null takes the key out). Text, name and overrides are kept as given, so that
/// another process can build the same document from them. Key paths read
/// `bodies.left.initial.velocity` and `meta.expect[0].measure`. Bodies that are `like` another one
/// are written out: what a document has at a path, they have. All that is wrong with the file's
/// form throws InputError: syntax, duplicate keys, several documents.
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

  bool has(std::string_view path) const;
  /// Keys of the map at a path, in the file's order; empty when there is no map.
  std::vector<std::string> keys(std::string_view path) const;
  /// Whether the choice at a path is this one: the bare word, or a map with this key.
  bool chooses(std::string_view path, std::string_view name) const;
  /// For InputError::where: "scene.yaml:12: bodies.left", or "scene.yaml, from --set key=value:
  /// key". A path that is not there is located at its nearest ancestor; what a body has from
  /// another one where it stands, with " (like left)" after the path.
  std::string where(std::string_view path) const;

  const YAML::Node& root() const { return *root_; }

 private:
  Document(std::string name, std::string text, std::vector<std::string> overrides);
  bool put(const std::string& override_text);  // false: it takes a key out
  void write_out();
  std::string place_of(std::string_view path, std::string_view shown) const;

  std::string name_, text_;
  std::vector<std::string> overrides_;
  std::unique_ptr<YAML::Node> root_;
  std::unique_ptr<YAML::Node>
      written_;  // before bodies were written out; null: none is like another
};

/// "bodies.left[0]" into "bodies", "left", "[0]".
std::vector<std::string> split_path(std::string_view path);
/// The inverse, one step at a time.
std::string join_path(std::string_view parent, std::string_view child);

}  // namespace abut
