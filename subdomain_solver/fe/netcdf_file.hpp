#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace abut {

/// A NetCDF file open for reading. What is missing, has another shape, or cannot be read is refused
/// by InputError that names the file and the dimension or variable. Damage of the header is left to
/// the library, which does not survive all of it (4.9.0).
class NetcdfFile {
 public:
  explicit NetcdfFile(const std::string& path);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;
  NetcdfFile(NetcdfFile&&) = delete;
  NetcdfFile& operator=(NetcdfFile&&) = delete;

  /// Length of a dimension; the second form gives 0 when there is none.
  std::size_t length(const std::string& dimension) const;
  std::size_t length_or_zero(const std::string& dimension) const;
  bool has(const std::string& variable) const;

  /// All values of a variable, which must be `count`.
  std::vector<double> reals(const std::string& variable, std::size_t count) const;
  std::vector<std::int64_t> integers(const std::string& variable, std::size_t count) const;
  /// `count` texts, without padding.
  std::vector<std::string> texts(const std::string& variable, std::size_t count) const;
  /// Text of an attribute of a variable.
  std::string attribute(const std::string& variable, const std::string& name) const;

  [[noreturn]] void refuse(const std::string& what, const std::string& remedy) const;

 private:
  /// Number of a variable; its values in all must be `count` rows.
  int variable_of(const std::string& name, std::size_t count, std::size_t* row = nullptr) const;
  void check(int status, const std::string& doing) const;

  std::string path_;
  int id_ = -1;
  std::uint64_t most_ = 0;  // values that the file can hold
};

}  // namespace abut
