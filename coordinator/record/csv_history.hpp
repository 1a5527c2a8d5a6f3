#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "coordinator/closed_form.hpp"
#include "coordinator/record/observer.hpp"
#include "coordinator/record/port_reader.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

/// history.csv: one row per record, numbers in their shortest exact form, units in the header.
/// Where a closed form is named also closed_form.csv: the same times, the columns that the closed
/// form knows, same names. A number that is not finite leaves its cell empty (Measures reports it).
class CsvHistory : public Observer {
 public:
  /// `form` may be null; else it must outlive the history.
  CsvHistory(const std::filesystem::path& directory, const ClosedForm* form);

  void on_start(const RunStart& start) override;
  void on_window(const WindowReport& report) override;
  void on_end(const RunEnd& end) override;

 private:
  struct PortColumn {
    int body, port;
    PortReader reader;
    PortValues values;  // at the record being written
  };
  struct InterfaceColumn {
    InterfaceInfo info;
    int port[2];  // index into ports_
    bool has_gap;
  };

  std::string header() const;
  std::string exact_header() const;
  void write_row(const WindowReport& report, std::size_t record);
  void write_body(const RecordedBody& body, const BodyRecord& record);
  void write_exact_row(double time);
  void number(double value);
  void end_row(TextFile& file);

  std::filesystem::path directory_;
  const ClosedForm* form_;
  int form_interface_ = -1;
  RunStart start_;
  std::vector<RecordedBody> recorded_;
  std::vector<PortColumn> ports_;  // by body, then by port
  std::vector<InterfaceColumn> interfaces_;
  std::optional<TextFile> history_, exact_;
  fmt::memory_buffer row_;
};

}  // namespace abut
