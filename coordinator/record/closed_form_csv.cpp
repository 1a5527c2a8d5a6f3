#include "coordinator/record/closed_form_csv.hpp"

#include <cmath>
#include <iterator>

#include "base/index.hpp"
#include "base/unit_words.hpp"
#include "coordinator/record/csv_history.hpp"
#include "coordinator/record/recorded_bodies.hpp"

namespace abut {

ClosedFormCsv::ClosedFormCsv(const std::filesystem::path& file, const ClosedForm& form,
                             const RunStart& start, const UnitSystem& units,
                             TextFile::Opening opening)
    : form_(form), file_(file, opening) {
  const std::string names = in_words_of(units, header(start));
  if (opening == TextFile::Opening::made) file_.append(names);
}

std::string ClosedFormCsv::header(const RunStart& start) {
  std::string text = "time [s]";
  const std::vector<RecordedBody> recorded = recorded_bodies(start.bodies);
  for (int b = 0; b < static_cast<int>(start.bodies.size()); ++b) {
    const Description& body = *start.bodies[b];
    Body columns;
    for (int p = 0; p < static_cast<int>(body.ports.size()); ++p) {
      const Port& port = body.ports[p];
      const std::size_t on = index(recorded_body_of(start.bodies, b, p));
      const int bar = form_.bar_index(recorded[on].name);
      if (bar < 0) continue;
      columns.ends.push_back({bar, port.geometry.normals.at(0) > 0.0 ? 1 : 0});
      add_port_names(text, body, port);
    }
    for (const RecordedBody& each : recorded) {
      const int bar = form_.bar_index(each.name);
      if (each.body != b || bar < 0) continue;
      columns.bars.push_back(bar);
      add_body_names(text, each);
    }
    bodies_.push_back(columns);
  }
  for (const InterfaceInfo& info : start.interfaces) {
    const int index = form_.interface_index(info.name);
    if (index < 0) continue;
    interfaces_.push_back(index);
    text += fmt::format(",{0}.gap [m],{0}.closed", info.name);
  }
  return text + "\n";
}

void ClosedFormCsv::number(double value) {
  row_.push_back(',');
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(row_), "{}", value);
}

void ClosedFormCsv::write_row(double time) {
  const BarRow& row = form_.row;
  row_.clear();
  fmt::format_to(std::back_inserter(row_), "{}", time);
  for (const Body& body : bodies_) {
    for (const BarEnd& end : body.ends) {
      number(row.displacement(end, time));
      number(row.velocity(end, time));
      number(row.force(end, time));
    }
    for (const int bar : body.bars) {
      const BarRow::State state = row.state(bar, time);
      number(state.kinetic);
      number(state.stored);
      number(state.total());
      number(state.momentum);
      number(state.momentum / row.mass(bar));
    }
  }
  for (const int interface : interfaces_) {
    number(row.gap(interface, time));
    const RowContact& contact = row.contacts()[interface];
    fmt::format_to(std::back_inserter(row_), ",{:d}", contact.closed(time));
  }
  row_.push_back('\n');
  file_.append({row_.data(), row_.size()});
}

}  // namespace abut
