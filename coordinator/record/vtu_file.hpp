#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "contract/field.hpp"

namespace abut {

/// Writes states of one body as VTK's XML files of unstructured grids (.vtu): arrays of doubles and
/// integers in blocks compressed by zlib, as base64. The grid is encoded once.
class VtuFile {
 public:
  /// Grid and fields must be sound (contract/field.hpp).
  VtuFile(const Grid& grid, std::vector<FieldInfo> fields);

  /// `values` in the order of the fields, sound and finite; `time` [s]. Written under a temporary
  /// name first. Throws RunError.
  void write(const std::filesystem::path& path, double time,
             std::span<const FieldValues> values) const;

 private:
  std::vector<FieldInfo> fields_;
  std::size_t nodes_, cells_;
  std::string points_, connectivity_, offsets_, types_;  // encoded
};

/// Bytes as VTK reads them from a DataArray: the sizes of blocks, then the blocks, each part
/// base64.
std::string encode_array(std::span<const std::byte> bytes);

}  // namespace abut
