#include "coordinator/record/csv_history.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

#include "base/assert.hpp"
#include "base/index.hpp"
#include "base/unit_words.hpp"

namespace abut {

namespace {

constexpr double empty_cell = std::numeric_limits<double>::quiet_NaN();  // leaves the cell empty

/// Columns that closed forms do not have.
void add_balance_names(std::string& header, const RecordedBody& body) {
  for (const std::string_view name : {"dissipated", "external_work"})
    header += fmt::format(",{}.{} [J]", body.name, name);
  if (body.member >= 0) return;
  for (int axis = first_rotation_axis(body.dim); axis < 3; ++axis)
    header += fmt::format(",{}.angular_momentum{} [kg m^2/s]", body.name, axis_ending(3, axis));
}

}  // namespace

void add_port_names(std::string& header, const Description& body, const Port& port) {
  const std::pair<std::string_view, std::string_view> fields[] = {
      {"u", "m"}, {"v", "m/s"}, {"force", "N"}};
  for (const auto& [name, unit] : fields)
    for (int axis = 0; axis < port.geometry.dim; ++axis)
      header += fmt::format(",{}.{}.{}{} [{}]", body.name, port.name, name,
                            axis_ending(port.geometry.dim, axis), unit);
}

void add_body_names(std::string& header, const RecordedBody& body) {
  for (const std::string_view name : {"kinetic", "stored", "total"})
    header += fmt::format(",{}.{} [J]", body.name, name);
  for (int axis = 0; axis < body.dim; ++axis)
    header += fmt::format(",{}.momentum{} [kg m/s]", body.name, axis_ending(body.dim, axis));
  for (int axis = 0; axis < body.dim; ++axis)
    header += fmt::format(",{}.mean_velocity{} [m/s]", body.name, axis_ending(body.dim, axis));
}

CsvHistory::CsvHistory(const std::filesystem::path& directory, const ClosedForm* form,
                       UnitSystem units, TextFile::Opening opening)
    : directory_(directory), form_(form), units_(std::move(units)), opening_(opening) {}

void CsvHistory::on_start(const RunStart& start) {
  start_ = start;
  recorded_ = recorded_bodies(start_.bodies);
  statics_ = std::ranges::all_of(start_.bodies, [](const Description* body) {
    return body->quasi_static || std::isinf(body->mass);
  });
  std::vector<std::vector<int>> index(start.bodies.size());
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    const std::vector<Port>& ports = start.bodies[b]->ports;
    for (std::size_t p = 0; p < ports.size(); ++p) {
      index[b].push_back(static_cast<int>(ports_.size()));
      ports_.push_back({static_cast<int>(b), static_cast<int>(p), PortReader(ports[p]), {}});
    }
  }
  for (std::size_t i = 0; i < start.interfaces.size(); ++i) {
    const InterfaceInfo& info = start.interfaces[i];
    if (info.many) {
      interfaces_.push_back({info, {0, 0}, false});
      continue;
    }
    const Port& port = start.bodies[info.body[0]]->ports[info.port[0]];
    interfaces_.push_back({info,
                           {index[info.body[0]][info.port[0]], index[info.body[1]][info.port[1]]},
                           port.geometry.dim == 1});
  }
  history_.emplace(directory_ / "history.csv", opening_);
  if (opening_ == TextFile::Opening::made) history_->append(in_words_of(units_, header()));
  if (form_ != nullptr)
    exact_.emplace(directory_ / "closed_form.csv", *form_, start_, units_, opening_);
}

void CsvHistory::state(Archive& archive) {
  history_->state(archive);
  if (exact_) exact_->state(archive);
}

std::string CsvHistory::header() const {
  std::string text = "time [s]";
  for (std::size_t b = 0; b < start_.bodies.size(); ++b) {
    const Description& body = *start_.bodies[b];
    for (const Port& port : body.ports) add_port_names(text, body, port);
    for (const RecordedBody& recorded : recorded_)
      if (recorded.body == static_cast<int>(b)) {
        add_body_names(text, recorded);
        add_balance_names(text, recorded);
      }
    for (const std::string& column : body.columns) text += fmt::format(",{}.{}", body.name, column);
    if (!body.members.empty()) text += fmt::format(",{}.whole [J]", body.name);
  }
  for (const InterfaceColumn& interface : interfaces_) {
    if (interface.has_gap) text += fmt::format(",{}.gap [m]", interface.info.name);
    text += fmt::format(",{0}.closed,{0}.iterations", interface.info.name);
  }
  return text + "\n";
}

void CsvHistory::on_window(const WindowReport& report) {
  if (report.responses.empty()) return;
  const std::vector<BodyRecord>& records = report.responses.front().records;
  for (std::size_t r = 0; r < records.size(); ++r) {
    write_row(report, r);
    if (exact_) exact_->write_row(records[r].time);
  }
  // What is on the disk is what a run that is killed leaves.
  if (clock_.now() < next_flush_) return;
  next_flush_ = clock_.now() + std::chrono::milliseconds(500);
  history_->flush();
  if (exact_) exact_->flush();
}

void CsvHistory::number(double value) {
  row_.push_back(',');
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(row_), "{}", value);
}

void CsvHistory::end_row(TextFile& file) {
  row_.push_back('\n');
  file.append({row_.data(), row_.size()});
}

void CsvHistory::write_row(const WindowReport& report, std::size_t record) {
  const std::vector<BodyRecord>& records = report.responses.front().records;
  const double time = records[record].time;
  row_.clear();
  fmt::format_to(std::back_inserter(row_), "{}", time);
  std::size_t next = 0;
  for (std::size_t b = 0; b < start_.bodies.size(); ++b) {
    const Response& response = report.responses[b];
    for (; next < ports_.size() && ports_[next].body == static_cast<int>(b); ++next) {
      PortColumn& column = ports_[next];
      const Waveform& trace = response.ports[column.port].trace;
      const double before = record > 0 ? records[record - 1].time : report.window.begin;
      column.values = trace.empty() ? PortMeans{}
                      : statics_    ? column.reader.at(trace, time)
                                    : column.reader.since(trace, before, time);
      const int dim = column.reader.port().geometry.dim;
      for (int axis = 0; axis < dim; ++axis) number(column.values.u[axis]);
      for (int axis = 0; axis < dim; ++axis) number(column.values.v[axis]);
      for (int axis = 0; axis < dim; ++axis) number(column.values.f[axis]);
    }
    for (const RecordedBody& recorded : recorded_)
      if (recorded.body == static_cast<int>(b)) write_body(recorded, response.records[record]);
    const std::vector<double>& told = response.records[record].columns;
    for (std::size_t k = 0; k < start_.bodies[b]->columns.size(); ++k)
      number(k < told.size() ? told[k] : empty_cell);
    const Energy& whole = response.records[record].energy;
    if (!start_.bodies[b]->members.empty()) number(whole.total() - whole.external_work);
  }
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    const InterfaceColumn& column = interfaces_[i];
    if (column.has_gap)
      number(gap_of(column.info, start_, ports_[column.port[0]].values.u[0],
                    ports_[column.port[1]].values.u[0]));
    fmt::format_to(std::back_inserter(row_), ",{:d},{}", report.interfaces[i].closed,
                   report.interfaces[i].iterations);
  }
  end_row(*history_);
}

void CsvHistory::write_body(const RecordedBody& body, const BodyRecord& record) {
  const Energy& energy = body.energy(record);
  const std::vector<double>& momentum = body.momentum(record);
  number(energy.kinetic);
  number(energy.stored);
  number(energy.total());
  ABUT_ASSERT(momentum.size() == index(body.dim));
  for (const double value : momentum) number(value);
  for (const double value : momentum) number(value / body.mass);
  number(energy.dissipated);
  number(energy.external_work);
  if (body.member >= 0) return;
  const int rotations = 3 - first_rotation_axis(body.dim);
  const std::vector<double>& angular = record.angular_momentum;
  for (int i = 0; i < rotations; ++i) number(angular.empty() ? empty_cell : angular[i]);
}

void CsvHistory::on_end(const RunEnd&) {
  if (history_) history_->check_in_place();
  if (exact_) exact_->check_in_place();
  if (history_) history_->close();
  if (exact_) exact_->close();
}

}  // namespace abut
