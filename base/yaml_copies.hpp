#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/yaml_copies_spec.hpp"

namespace YAML {
class Node;
}

namespace abut {

class Document;

/// Bodies that a scene writes once and has many times: `ball: {copies: ...}` stands for `ball_1`,
/// `ball_2`, ..., numbered with as many digits as the last of them has.
class Copies {
 public:
  /// Of a scene in which no body is like another any more. Throws InputError for copies that
  /// cannot be placed, tables that cannot be read and names that another body has.
  explicit Copies(const Document& document);

  bool empty() const { return bodies_.empty(); }
  /// That scene with the copies where their body was. Throws InputError: more values than a scene
  /// can hold.
  YAML::Node written_out(const Document& document) const;

  /// Overrides that put lists in the place of tables, with the same numbers.
  std::vector<std::string> tables_as_lists() const;

  /// The body that a name is a copy of; empty: none.
  std::string body_of(std::string_view copy) const;
  /// "ball_1 to ball_9" of a body; empty when it has no copies.
  std::string names_of(std::string_view body) const;
  /// The key path at which the text has what a copy has at this one; the same path when it is of no
  /// copy. `has`: whether the text has a key path.
  std::string origin_of(std::string_view path,
                        const std::function<bool(const std::string&)>& has) const;

 private:
  struct Place {
    std::vector<double> position, velocity;  // [m] [m/s] (dim), added to the body's
  };
  struct Body {
    CopiesSpec spec;
    std::vector<Place> places;
    std::vector<std::string> names;
  };
  void read_body(const Document& document, const std::string& name);

  std::map<std::string, Body, std::less<>> bodies_;
  std::map<std::string, std::pair<std::string, std::size_t>, std::less<>> copies_;  // body, number
};

/// Whether a body of a scene has this name, less the number of a copy, and has copies: `ball` of
/// `ball_3`. Empty: none.
std::string possible_body_of(const YAML::Node& scene, std::string_view name);

}  // namespace abut
