#pragma once

#include <string>

namespace abut {

/// The least that one element takes of a bar, and of a mesh in two or three dimensions [bytes].
inline constexpr double bytes_of_bar_element = 100.0;
inline constexpr double bytes_of_cell = 500.0;

/// Refuses more elements than node numbers of 32 bits or the machine's memory have room for, before
/// any of it is taken. Throws InputError at `where`.
void require_room(double elements, double bytes, const std::string& where);

}  // namespace abut
