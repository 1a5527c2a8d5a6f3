#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace abut {

/// A number that is known not to be negative, or a choice, as a place in a container. Where such a
/// number is the whole subscript of a container, it needs no conversion: `list[i]`.
template <class T>
  requires std::integral<T> || std::is_enum_v<T>
constexpr std::size_t index(T place) {
  return static_cast<std::size_t>(place);
}

}  // namespace abut
