#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace abut {

/// Where a field has its values.
enum class FieldPlace { nodes, cells };

/// A quantity that a body can tell all over itself: its name, where its values are, and how many
/// numbers one value is: 1, 3 for a vector in space, 6 for a symmetric tensor xx yy zz xy yz zx.
struct FieldInfo {
  std::string name;
  FieldPlace place = FieldPlace::nodes;
  int components = 1;
};

/// The nodes and cells on which a body tells its fields, in the reference configuration. Cells and
/// the order of their nodes are those of VTK. Bodies in one and two dimensions lie in space too,
/// with zeros for the axes that they do not have.
struct Grid {
  std::vector<double> points;              // [m] (nodes, 3)
  std::vector<std::int32_t> types;         // (cells) VTK's numbers of cell types
  std::vector<std::int32_t> connectivity;  // nodes of the cells, one cell after the other
  std::vector<std::int32_t> offsets;       // (cells + 1) where a cell begins in connectivity

  std::size_t nodes() const { return points.size() / 3; }
  std::size_t cells() const { return types.size(); }
};

/// The values of one field, (nodes or cells, components), SI units.
using FieldValues = std::vector<double>;

/// What is wrong with fields as a description lists them, in words; empty: nothing.
std::string unsound(std::span<const FieldInfo> fields);
/// The same of a grid: whole points, finite coordinates, offsets that grow from 0, nodes that
/// exist.
std::string unsound(const Grid& grid);
/// The same of values: as many fields as described, as many numbers as nodes or cells ask for.
std::string unsound(std::span<const FieldValues> values, std::span<const FieldInfo> fields,
                    std::size_t nodes, std::size_t cells);
/// The first value that is not finite, in words; empty: all are.
std::string not_finite(std::span<const FieldValues> values, std::span<const FieldInfo> fields);

}  // namespace abut
