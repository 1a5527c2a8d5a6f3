#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contract/port.hpp"
#include "subdomain_solver/solve/friction_forces.hpp"

namespace abut {

/// One of the surfaces that rows of contact press on, and how it gives way to forces near it.
struct PressedSide {
  struct Term {
    std::int32_t value;  // (points, dim)
    double factor;
  };
  const PortKernel* near = nullptr;  // whose band says what is near; without one all is
  std::span<const double> moved;     // [m/N] as one step's responses of that kernel
  std::size_t points = 0;
  int dim = 3;
  // The components [first, first + components()) of the rows' problem press on it: each one along
  // its terms.
  Eigen::Index first = 0;
  std::vector<std::size_t> begins;  // (components + 1) where a component's terms begin
  std::vector<Term> terms;

  std::size_t components() const { return begins.size() - 1; }
  std::span<const Term> of(std::size_t component) const {
    return std::span(terms).subspan(begins[component], begins[component + 1] - begins[component]);
  }
  /// Forces [N] (points, dim) by the components' forces.
  void press(const Vector& force, std::span<double> on) const;
  /// Adds what displacements [m] (points, dim) open the components by.
  void open(std::span<const double> by, Vector& opened) const;
};

/// Compliance among rows of contact, blocks of near rows alone: by the row that presses, the rows
/// that it opens.
struct NearBlocks {
  std::vector<std::size_t> offsets;  // (rows + 1)
  std::vector<std::int32_t> opened;  // rows, ascending in a list
  std::vector<std::size_t> begins;   // where blocks begin
  std::vector<double> blocks;        // [m/N] (parts of the opened row, parts), column by column
  std::vector<std::size_t> own;      // (rows) number of a row's own block
  std::vector<double> soft;          // [m/N] (rows) that tangents give way beside; see soften_held
};

/// Rows in the order of their components.
NearBlocks near_rows(std::span<const FrictionRow> rows, std::span<const PressedSide> sides);

/// The same rows along other directions (components, dim) that span what those before did: where a
/// row rubs, any; where it does not, nearly the same normal. `force` [N] (components) turns with
/// them, and presses at least by nothing.
void turn(NearBlocks& near, std::span<const FrictionRow> rows, int dim,
          std::span<const double> before, std::span<const double> now, Vector& force);

/// Whether rounds whose first passes changed forces by so much [N], the latest last, would not end:
/// the last eight did not halve it.
bool too_slow(std::span<const double> changes);

/// One row after the other to the force [N] that fits its own rates (Gauss and Seidel). `rates`:
/// [m] (components) gaps and slips under `force`; both follow. Returns the largest change of a
/// force.
double relax(const NearBlocks& near, std::span<const FrictionRow> rows, Vector& rates,
             Vector& force);

}  // namespace abut
