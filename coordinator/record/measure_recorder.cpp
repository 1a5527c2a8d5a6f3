#include "coordinator/record/measure_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/archive_lists.hpp"
#include "base/index.hpp"
#include "coordinator/record/port_reader.hpp"

namespace abut {

void MeasureRecorder::on_start(const RunStart& start) {
  start_ = start;
  last_time_ = start.begin;
  measures_.scope =
      measure_scope(start_, form_ != nullptr ? form_->interfaces : std::vector<std::string>());
  measures_.scope.filtered = filter_.has_value();
  measures_.scope.steady = steady_after_.has_value();
  for (std::size_t i = 0; i < start_.interfaces.size(); ++i) {
    const InterfaceInfo& info = start_.interfaces[i];
    if (info.many) {
      many_.emplace_back(start_, static_cast<int>(i));
      continue;
    }
    const int exact = form_ != nullptr ? form_->interface_index(info.name) : -1;
    std::optional<ContactErrors> errors;
    if (exact >= 0) errors.emplace(form_->row, form_->row.contacts()[exact]);
    contacts_.emplace_back(start_, static_cast<int>(i), std::move(errors),
                           filter_ ? make_force_filter(*filter_) : nullptr, steady_after_);
    for (const int side : {0, 1}) {
      const int dim = start_.bodies[info.body[side]]->ports[info.port[side]].geometry.dim;
      positions_.push_back(
          {info.body[side], info.port[side],
           std::vector<double>(index(dim), -std::numeric_limits<double>::infinity())});
    }
  }
  balance_.emplace(start_, form_);
}

void MeasureRecorder::on_window(const WindowReport& report) {
  last_time_ = report.window.end;
  check_finite(report);
  count_iterations(report);
  follow_positions(report);
  balance_->on_window(report);
  for (ContactMeasures& contact : contacts_) contact.on_window(report);
  for (ManyContacts& contact : many_) contact.on_window(report);
}

void MeasureRecorder::on_event(const RunEvent& event) {
  for (ContactMeasures& contact : contacts_) contact.on_event(event);
  for (ManyContacts& contact : many_) contact.on_event(event);
}

void MeasureRecorder::count_iterations(const WindowReport& report) {
  if (report.window.length() <= 0.0) return;  // the start
  int most = 0;
  bool closed = false;
  for (const InterfaceReport& interface : report.interfaces) {
    if (!interface.closed) continue;
    closed = true;
    most = std::max(most, interface.iterations);
  }
  if (!closed) return;
  ++contact_windows_;
  iterations_ += most;
  iterations_max_ = std::max(iterations_max_, most);
}

void MeasureRecorder::follow_positions(const WindowReport& report) {
  for (PositionMax& position : positions_) {
    const PortResponse& response = report.responses[position.body].ports[position.port];
    for (std::size_t k = 0; k < response.upper.size(); ++k) {  // (records, dim)
      double& most = position.most[k % position.most.size()];
      most = std::max(most, response.upper[k]);
    }
  }
}

void MeasureRecorder::check_finite(const WindowReport& report) {
  if (!non_finite_.empty()) return;
  for (std::size_t b = 0; b < report.responses.size(); ++b) {
    for (const BodyRecord& record : report.responses[b].records) {
      bool finite = std::isfinite(record.energy.total() + record.energy.external_work);
      for (const double value : record.momentum) finite = finite && std::isfinite(value);
      if (finite) continue;
      non_finite_ = fmt::format("energy or momentum of {} is not a finite number at {} s",
                                start_.bodies[b]->name, record.time);
      return;
    }
  }
}

void MeasureRecorder::write_positions() {
  for (const PositionMax& position : positions_) {
    const Description& body = *start_.bodies[position.body];
    const Port& port = body.ports[position.port];
    const std::size_t dim = position.most.size();
    for (std::size_t k = 0; k < dim; ++k) {
      const std::string name = fmt::format("position.{}.{}.max{}", body.name, port.name,
                                           axis_ending(static_cast<int>(dim), static_cast<int>(k)));
      if (std::isfinite(position.most[k])) {
        measures_.set(name, position.most[k]);
      } else {
        measures_.none(name, "the body reports no displacements of this port");
      }
    }
  }
}

/// What bodies tell of themselves.
void MeasureRecorder::write_told(const RunEnd& end) {
  for (std::size_t b = 0; b < start_.bodies.size(); ++b) {
    const Description& body = *start_.bodies[b];
    for (std::size_t k = 0; k < body.measures.size(); ++k) {
      const std::string name = body_measure(body.name, body.measures[k]);
      if (b < end.body_measures.size() && k < end.body_measures[b].size()) {
        measures_.set(name, end.body_measures[b][k]);
      } else {
        measures_.none(name, "the run did not come to its end");
      }
    }
  }
}

void MeasureRecorder::on_end(const RunEnd& end) {
  for (ContactMeasures& contact : contacts_) contact.write(last_time_, measures_);
  for (const ManyContacts& contact : many_) contact.write(measures_);
  if (balance_) balance_->write(measures_);
  write_positions();
  write_told(end);
  const double windows = static_cast<double>(std::max<std::int64_t>(1, contact_windows_));
  measures_.set("schwarz.iterations_mean", static_cast<double>(iterations_) / windows);
  measures_.set("schwarz.iterations_max", iterations_max_);
  measures_.set("exchanges", static_cast<double>(end.exchanges));
  measures_.set("windows", static_cast<double>(end.windows));
  measures_.set("contact_windows", static_cast<double>(contact_windows_));
  for (auto& [name, value] : measures_.values)
    if (!std::isfinite(value) && !measures_.notes.contains(name))
      measures_.none(name, non_finite_.empty() ? "not a finite number" : non_finite_);
}

void MeasureRecorder::state(Archive& archive) {
  for (ContactMeasures& contact : contacts_) contact.state(archive);
  for (ManyContacts& contact : many_) contact.state(archive);
  balance_->state(archive);
  for (PositionMax& position : positions_) archive.field("most", position.most);
  archive.field("contact_windows", contact_windows_);
  archive.field("iterations", iterations_);
  whole(archive, "iterations_max", iterations_max_);
  archive.field("last_time", last_time_);
  archive.field("non_finite", non_finite_);
}

}  // namespace abut
