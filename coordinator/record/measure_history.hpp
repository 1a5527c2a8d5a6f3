#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// measures.csv: measures of bodies over time, as the stress at a point: at the begin, after every
/// so many accepted windows, and at the end of a run that did not fail. Numbers in their shortest
/// exact form; one that is not finite leaves its cell empty. Asks the bodies itself, in states that
/// the run has accepted.
class MeasureHistory : public Observer {
 public:
  /// The bodies, in the scene's order, must outlive this. `of`: names that the bodies tell, with
  /// `body.NAME.` before them; `every` [windows] is positive.
  MeasureHistory(const std::filesystem::path& directory, std::vector<Subdomain*> bodies,
                 const std::vector<std::string>& of, int every, UnitSystem units = {},
                 TextFile::Opening opening = TextFile::Opening::made);

  std::string_view kept_as() const override { return "measure_history"; }
  void state(Archive& archive) override;
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override;

 private:
  struct Column {
    std::string name;
    std::size_t body = 0, measure = 0;  // its place among what the body tells
  };

  void write(double time);

  std::filesystem::path directory_;
  std::vector<Subdomain*> bodies_;
  std::vector<std::string> of_;
  std::int64_t every_;
  UnitSystem units_;
  TextFile::Opening opening_;
  std::vector<Column> columns_;
  std::optional<TextFile> file_;
  std::int64_t windows_ = 0;  // accepted so far
  double written_ = 0.0;      // [s] time of the last row
};

/// SI's unit of a measure that a body tells, by its name; empty: a number without one.
std::string_view unit_of_body_measure(std::string_view name);

}  // namespace abut
