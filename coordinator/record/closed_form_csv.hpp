#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/units.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// closed_form.csv: the columns of history.csv that the closed form knows, of the same names, with
/// the exact values.
class ClosedFormCsv {
 public:
  /// The form must outlive this.
  ClosedFormCsv(const std::filesystem::path& file, const ClosedForm& form, const RunStart& start,
                const UnitSystem& units, TextFile::Opening opening = TextFile::Opening::made);

  void write_row(double time);
  void flush() { file_.flush(); }
  void close() { file_.close(); }
  void state(Archive& archive) { file_.state(archive); }
  void check_in_place() const { file_.check_in_place(); }

 private:
  std::string header(const RunStart& start);
  void number(double value);

  const ClosedForm& form_;
  TextFile file_;
  /// In the order of the columns, by body: its ends at ports, then its bars.
  struct Body {
    std::vector<BarEnd> ends;
    std::vector<int> bars;  // index into the row
  };
  std::vector<Body> bodies_;
  std::vector<int> interfaces_;  // index into the row's contacts
  fmt::memory_buffer row_;
};

}  // namespace abut
