#include "subdomain_solver/fe/netcdf_file.hpp"

#include <netcdf.h>

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/machine_memory.hpp"

namespace abut {
namespace {

const char* const damaged = "The file is cut short or damaged: write it again.";

}  // namespace

NetcdfFile::NetcdfFile(const std::string& path) : path_(path) {
  check_input_file(path, static_cast<std::size_t>(0.5 * machine_memory()),
                   "Check the path of the mesh.");
  // Deflate packs a byte of zeros in 1/1032 byte at best: a header that promises more lies.
  most_ = static_cast<std::uint64_t>(std::filesystem::file_size(path)) * 1032;
  check(nc_open(path.c_str(), NC_NOWRITE, &id_), "is not a NetCDF file, so no Exodus file");
}

NetcdfFile::~NetcdfFile() { nc_close(id_); }

void NetcdfFile::refuse(const std::string& what, const std::string& remedy) const {
  throw InputError(what, path_, remedy);
}

void NetcdfFile::check(int status, const std::string& doing) const {
  if (status != NC_NOERR) refuse(fmt::format("{} ({})", doing, nc_strerror(status)), damaged);
}

std::size_t NetcdfFile::length_or_zero(const std::string& dimension) const {
  int number = 0;
  if (nc_inq_dimid(id_, dimension.c_str(), &number) != NC_NOERR) return 0;
  std::size_t length = 0;
  check(nc_inq_dimlen(id_, number, &length), "has no readable dimension " + dimension);
  if (length > most_)
    refuse(fmt::format("has {} of {}, more than its size can hold", length, dimension), damaged);
  return length;
}

std::size_t NetcdfFile::length(const std::string& dimension) const {
  const std::size_t found = length_or_zero(dimension);
  if (found == 0)
    refuse("has no dimension " + dimension, "Expected is a mesh in Exodus II: write it as such.");
  return found;
}

bool NetcdfFile::has(const std::string& variable) const {
  int number = 0;
  return nc_inq_varid(id_, variable.c_str(), &number) == NC_NOERR;
}

int NetcdfFile::variable_of(const std::string& name, std::size_t count, std::size_t* row) const {
  int number = 0, dimensions = 0;
  std::array<int, NC_MAX_VAR_DIMS> dimension{};
  if (nc_inq_varid(id_, name.c_str(), &number) != NC_NOERR)
    refuse("has no variable " + name, "Expected is a mesh in Exodus II: write it as such.");
  check(nc_inq_varndims(id_, number, &dimensions), "has no readable variable " + name);
  check(nc_inq_vardimid(id_, number, dimension.data()), "has no readable variable " + name);
  std::size_t values = 1, last = 1;
  for (int d = 0; d < dimensions; ++d) {
    check(nc_inq_dimlen(id_, dimension[d], &last), "is damaged");
    if (last != 0 && values > most_ / last)
      refuse("has a variable " + name + " of more values than its size can hold", damaged);
    values *= last;
  }
  if (row != nullptr) *row = last;
  const std::size_t expected = row != nullptr ? count * last : count;
  if (values != expected)
    refuse(fmt::format("has {} values in {} where {} must be", values, name, expected), damaged);
  return number;
}

std::vector<double> NetcdfFile::reals(const std::string& variable, std::size_t count) const {
  const int number = variable_of(variable, count);
  std::vector<double> values(count);
  check(nc_get_var_double(id_, number, values.data()), "cannot be read at " + variable);
  return values;
}

std::vector<std::int64_t> NetcdfFile::integers(const std::string& variable,
                                               std::size_t count) const {
  const int number = variable_of(variable, count);
  std::vector<long long> values(count);
  check(nc_get_var_longlong(id_, number, values.data()), "cannot be read at " + variable);
  return {values.begin(), values.end()};
}

std::vector<std::string> NetcdfFile::texts(const std::string& variable, std::size_t count) const {
  std::size_t width = 0;
  const int number = variable_of(variable, count, &width);
  std::string letters(count * width, '\0');
  check(nc_get_var_text(id_, number, letters.data()), "cannot be read at " + variable);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string padded = letters.substr(i * width, width);
    const std::string text = padded.substr(0, padded.find('\0'));
    texts.push_back(text.substr(0, text.find_last_not_of(' ') + 1));
  }
  return texts;
}

std::string NetcdfFile::attribute(const std::string& variable, const std::string& name) const {
  int number = 0;
  std::size_t length = 0;
  check(nc_inq_varid(id_, variable.c_str(), &number), "has no variable " + variable);
  check(nc_inq_attlen(id_, number, name.c_str(), &length),
        "has no attribute " + name + " of " + variable);
  if (length > most_) refuse("has an attribute larger than itself", damaged);
  std::string text(length, '\0');
  check(nc_get_att_text(id_, number, name.c_str(), text.data()), "cannot be read at " + variable);
  return text.substr(0, text.find('\0'));
}

}  // namespace abut
