#pragma once

#include <deque>
#include <string>

#include "base/yaml_fields.hpp"

/// The keys of a body below model.external, as abut reads its own: what is wrong is gathered by the
/// reader, and told when all has been read.
struct abut_keys {
  abut::Fields& fields;
  const abut::Document& document;
  std::string path;  // bodies.NAME.model.external
  bool refused = false;
  std::deque<std::string> texts = {};  // that have been handed out

  std::string path_of(const char* name) const { return path + "." + name; }
};
