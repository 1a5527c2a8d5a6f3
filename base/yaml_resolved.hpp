#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/fields.hpp"
#include "base/units.hpp"

namespace YAML {
class Node;
}

namespace abut {

class Document;

/// The values in use, defaults included, as YAML that reads back to the same values: doubles in the
/// shortest form that round-trips, units beside them. Structs that share a map are merged in it.
class ResolvedYaml {
 public:
  /// `units`: in which the values are, and the units beside them.
  explicit ResolvedYaml(UnitSystem units = {});
  ResolvedYaml(const ResolvedYaml&) = delete;
  ResolvedYaml& operator=(const ResolvedYaml&) = delete;
  ~ResolvedYaml();

  /// `path` is where the struct's keys live; "" is the whole document.
  template <HasFields S>
  void add(std::string_view path, S value) {
    const std::unique_ptr<Fields> writer = writer_at(path);
    value.fields(*writer);
  }
  /// What a document has at a path, whatever it is: keys that belong to another program. `placed`
  /// gets the key path of every text, from the document's root, and the text that is to stand
  /// there.
  using Placed = std::function<std::string(const std::string& key, const std::string& text)>;
  void copy(std::string_view path, const Document& document, const Placed& placed = {});
  /// Leaves out, below a path, what is not wanted; `wanted` is asked of every key path, from the
  /// outside in.
  void keep(std::string_view path, const std::function<bool(const std::string&)>& wanted);
  std::string text() const;

  struct Node;

 private:
  std::unique_ptr<Fields> writer_at(std::string_view path);
  UnitSystem units_;
  std::unique_ptr<Node> root_;
};

template <HasFields S>
std::string to_yaml(S value) {
  ResolvedYaml resolved;
  resolved.add("", std::move(value));
  return resolved.text();
}

}  // namespace abut
