#pragma once

#include <string>

#include "base/error.hpp"
#include "base/yaml_document.hpp"

namespace abut {

/// Where in a scene a body stands, for errors.
struct Place {
  const Document& document;
  std::string path;  // bodies.left

  std::string name() const { return path.substr(path.rfind('.') + 1); }
  std::string where(const std::string& key) const { return document.where(path + "." + key); }
};

/// An InputError of the mesh about a name, told of the scene's key.
template <class Call>
auto named(const Place& place, const std::string& key, Call call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw InputError(error.what_is_wrong, place.where(key), error.remedy);
  }
}

}  // namespace abut
