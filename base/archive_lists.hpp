#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/archive.hpp"

namespace abut {

// Fields of state lists that are made of several.

/// A whole number or a choice.
template <class Integer>
void whole(Archive& archive, std::string_view name, Integer& value) {
  std::int64_t number = static_cast<std::int64_t>(value);
  archive.field(name, number);
  value = static_cast<Integer>(number);
}

template <std::size_t n>
void field(Archive& archive, std::string_view name, std::array<double, n>& values) {
  for (double& value : values) archive.field(name, value);
}

/// A list of anything that has its own fields: `each(archive, item)`. No archive holds more items
/// than bytes.
template <class List, class Each>
void list(Archive& archive, std::string_view name, List& items, const Each& each) {
  std::int64_t count = static_cast<std::int64_t>(items.size());
  archive.field(name, count);
  archive.check_count(name, count);
  items.resize(static_cast<std::size_t>(count));
  for (auto& item : items) each(archive, item);
}

}  // namespace abut
