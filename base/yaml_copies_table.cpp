#include "base/yaml_copies_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

constexpr std::size_t most_table_bytes = 16'000'000;
constexpr std::array<std::string_view, 6> columns = {"x", "y", "z", "vx", "vy", "vz"};
constexpr const char* name_columns =
    "Begin the table with a line of its columns, some of x, y, z in m and vx, vy, vz in m/s.";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    cells.push_back(trimmed(line.substr(begin, comma - begin)));
    if (comma == std::string_view::npos) return cells;
    begin = comma + 1;
  }
}

class Table {
 public:
  Table(const std::string& path, std::size_t dim, std::size_t most_rows)
      : path_(path), dim_(dim), most_rows_(most_rows) {}

  void take(std::string_view line) {
    ++line_;
    const std::string_view values = trimmed(line.substr(0, line.find('#')));
    if (values.empty()) return;
    if (places_.empty()) {
      name_columns_of(cells_of(values));
    } else {
      add_row(cells_of(values));
    }
  }

  std::vector<TableRow> rows() && {
    if (places_.empty()) throw InputError("is empty", path_, name_columns);
    if (rows_.empty())
      throw InputError("has no rows", path_, "Give one line per copy below that of the columns.");
    return std::move(rows_);
  }

 private:
  std::string where() const { return fmt::format("{}:{}", path_, line_); }

  void name_columns_of(const std::vector<std::string_view>& names) {
    std::size_t dims = 1;
    for (const std::string_view name : names) {
      const auto found = std::find(columns.begin(), columns.end(), name);
      if (found == columns.end())
        throw InputError(name.empty() ? "has a column without a name"
                                      : fmt::format("has the column {}, which is not known", name),
                         where(), name_columns);
      const std::size_t place = static_cast<std::size_t>(found - columns.begin());
      if (std::find(places_.begin(), places_.end(), place) != places_.end())
        throw InputError(fmt::format("has the column {} twice", name), where(),
                         "Take one of the two out.");
      dims = std::max(dims, place % 3 + 1);
      if (dim_ > 0 && dims > dim_)
        throw InputError(fmt::format("has the column {}, but the body has {}", name,
                                     dim_ == 1 ? "one dimension" : "two dimensions"),
                         where(), "Take the column out.");
      places_.push_back(place);
      (place < 3 ? has_position_ : has_velocity_) = true;
    }
    if (dim_ == 0) dim_ = dims;
  }

  void add_row(const std::vector<std::string_view>& cells) {
    if (cells.size() != places_.size())
      throw InputError(
          fmt::format("has {} values, but the table has {} columns", cells.size(), places_.size()),
          where(), "Give one value per column, with commas between them.");
    if (rows_.size() == most_rows_)
      throw InputError(fmt::format("has more than {} rows", most_rows_), where(),
                       "Give fewer copies.");
    TableRow row;
    if (has_position_) row.position.assign(dim_, 0.0);
    if (has_velocity_) row.velocity.assign(dim_, 0.0);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::optional<double> value = parse<double>(cells[c]);
      if (!value || !std::isfinite(*value))
        throw InputError(fmt::format("has {} in the column {}, which is not a finite number",
                                     cells[c].empty() ? "nothing" : cells[c], columns[places_[c]]),
                         where(), "Give a number.");
      (places_[c] < 3 ? row.position : row.velocity)[places_[c] % 3] = *value;
    }
    rows_.push_back(std::move(row));
  }

  const std::string& path_;
  std::size_t dim_, most_rows_, line_ = 0;
  std::vector<std::size_t> places_;  // in the list of columns
  bool has_position_ = false, has_velocity_ = false;
  std::vector<TableRow> rows_;
};

}  // namespace

std::vector<TableRow> read_copies_table(const std::string& path, std::size_t dim,
                                        std::size_t most_rows) {
  const std::string text = read_input_file(
      path, most_table_bytes, "Give the path of a table, relative to the scene's folder.");
  Table table(path, dim, most_rows);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    table.take(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
  }
  return std::move(table).rows();
}

}  // namespace abut
