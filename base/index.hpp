#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace abut {

/// A choice, or a part of a sum of places, as a place in a container; a whole subscript needs none.
template <class T>
  requires std::integral<T> || std::is_enum_v<T>
constexpr std::size_t index(T place) {
  return static_cast<std::size_t>(place);
}

}  // namespace abut
