#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace abut {

/// Columns x, y, z, vx, vy, vz of a table.
struct TableRow {
  std::vector<double> position, velocity;  // [m] [m/s] (dim); empty: the table has none
};

/// Reads a table of copies: a line of column names, then one line per copy, values between commas;
/// what follows # is for people. Columns that are left out are 0. `dim`: that of the body; 0: as
/// the columns tell. Throws InputError with file, line and column.
std::vector<TableRow> read_copies_table(const std::string& path, std::size_t dim,
                                        std::size_t most_rows);

}  // namespace abut
