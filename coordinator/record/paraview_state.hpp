#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "contract/field.hpp"

namespace abut {

/// What ParaView shows of a run at once: all bodies deformed, coloured by one field, with a scale.
struct ParaviewView {
  std::array<double, 3> low{}, high{};  // [m] box around the bodies in the reference configuration
  std::optional<FieldInfo> colour;      // absent: no body has a field that is worth it
  double largest = 0.0;                 // of that field's magnitude in all states so far
};

/// Of the fields of one body the one that colours it: stress where there is one, else velocity.
std::optional<FieldInfo> colour_among(std::span<const FieldInfo> fields);

/// The largest magnitude among values of so many components.
double largest_magnitude(std::span<const double> values, int components);

/// A state file (.pvsm) of ParaView 5.11 that opens the list of states, an absolute path.
std::string paraview_state(const std::filesystem::path& list, const ParaviewView& view);

}  // namespace abut
