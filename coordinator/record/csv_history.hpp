#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/clock.hpp"
#include "base/units.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/record/closed_form_csv.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// history.csv: one row per record, numbers in their shortest exact form, units in the header.
/// Twice a second what there is reaches the files. Where a closed form is named also
/// closed_form.csv at the same times. A number that is not finite leaves its cell empty
/// (Measures reports it).
class CsvHistory : public Observer {
 public:
  /// `form` may be null; else it must outlive the history.
  CsvHistory(const std::filesystem::path& directory, const ClosedForm* form, UnitSystem units = {},
             TextFile::Opening opening = TextFile::Opening::made);

  std::string_view kept_as() const override { return "history"; }
  void state(Archive& archive) override;
  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override;

 private:
  struct PortColumn {
    int body, port;
    PortReader reader;
    PortMeans values;  // at the record being written
  };
  struct InterfaceColumn {
    InterfaceInfo info;
    int port[2];  // index into ports_
    bool has_gap;
  };

  std::string header() const;
  void write_row(const WindowReport& report, std::size_t record);
  void write_body(const RecordedBody& body, const BodyRecord& record);
  void number(double value);
  void end_row(TextFile& file);

  std::filesystem::path directory_;
  const ClosedForm* form_;
  UnitSystem units_;
  TextFile::Opening opening_;
  RunStart start_;
  std::vector<RecordedBody> recorded_;
  std::vector<PortColumn> ports_;  // by body, then by port
  bool statics_ = false;  // no body has inertia: forces are those in balance, and no impulses
  std::vector<InterfaceColumn> interfaces_;
  std::optional<TextFile> history_;
  std::optional<ClosedFormCsv> exact_;
  fmt::memory_buffer row_;
  SystemClock clock_;
  Clock::Time next_flush_{};
};

/// Names of the columns of a port and of a body, each with a comma before it.
void add_port_names(std::string& header, const Description& body, const Port& port);
void add_body_names(std::string& header, const RecordedBody& body);

}  // namespace abut
