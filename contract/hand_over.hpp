#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "contract/field.hpp"
#include "contract/outcome.hpp"

namespace abut {

/// Where a body stands and how it moves, in terms that every model of it understands: another model
/// or another mesh of the same body goes on from there (docs/METHOD.md, section 12).
struct HandOver {
  std::string model;                 // of whom it is, for people: Description::model
  bool deforms = false;              // that model knows of strain
  Grid grid;                         // the mesh it is told on
  FieldValues displacement;          // [m] (nodes, 3)
  FieldValues velocity;              // [m/s] (nodes, 3)
  double mass = 0.0;                 // [kg]
  BodyRecord record;                 // energies and momenta at this time
  std::vector<std::string> columns;  // Description::columns

  /// As what a body resumes from: the first field says that it is one.
  std::vector<std::byte> bytes();
  /// Out of these. Throws RunError.
  static HandOver from(std::span<const std::byte> bytes);
  /// All fields but that first one.
  void state(Archive& archive);
};

/// In the first field of what a body resumes from: a HandOver follows, and not its own state.
inline constexpr const char* handed_over = "handed over";

/// Whether a body has the same nodes and cells.
bool same_grid(const Grid& one, const Grid& other);

}  // namespace abut
