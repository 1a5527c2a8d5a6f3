#pragma once

#include <functional>
#include <string_view>

#include "base/fields.hpp"
#include "base/yaml_document.hpp"

namespace abut {

/// Lets `visit` read the map at a path ("" is the whole document). Throws InputError for the
/// keys that are unknown, missing, of the wrong type, out of range or without effect: an
/// InputErrorList where there are several.
void read_fields(const Document& document, std::string_view path,
                 const std::function<void(Fields&)>& visit);

template <HasFields S>
S read(const Document& document, std::string_view path = {}) {
  S value{};
  read_fields(document, path, [&value](Fields& f) { value.fields(f); });
  return value;
}

}  // namespace abut
