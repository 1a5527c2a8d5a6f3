#pragma once

#include <cstddef>

#include "contract/port.hpp"

namespace abut {

/// [B] of the responses to one pattern.
std::size_t bytes_of_pattern(const PortKernel& kernel);
/// A kernel of the patterns [first, first + count) of another one alone.
PortKernel part_of(const PortKernel& whole, int first, int count);
/// Room for as many patterns, and all else as a part of it has it.
PortKernel room_for(const PortKernel& part, int patterns);
/// Puts the responses of a part where they belong in the whole, whose pattern `first` is its first
/// one. Precondition: as many substeps, as wide, and with the same arrays.
void put(const PortKernel& part, int first, PortKernel& whole);
/// Whether put() may take the part.
bool fits(const PortKernel& part, int first, const PortKernel& whole);

}  // namespace abut
