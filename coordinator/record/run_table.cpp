#include "coordinator/record/run_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/archive_lists.hpp"
#include "coordinator/record/shares.hpp"
#include "coordinator/record/text_table.hpp"

namespace abut {

namespace {

constexpr std::size_t most_rows = 10;  // of a table; all numbers are in the files
constexpr std::size_t most_processes = 4;

using Rows = std::vector<std::vector<std::string>>;

/// "clamp" of the column "clamp.reaction_x [N]"; empty: another column.
std::string constraint_of(const std::string& column) {
  const std::size_t at = column.rfind(".reaction");
  return at == std::string::npos ? "" : column.substr(0, at);
}

/// In a table a missing number is a dash.
std::string shown(const Measures& measures, const std::string& name) {
  const auto found = measures.values.find(name);
  if (found == measures.values.end() || std::isnan(found->second)) return "-";
  return fmt::format("{:.5g}", found->second);
}

/// A time of 1e-18 s beside a run of 1e-3 s is zero; a stage that begins late is told apart.
std::string time_shown(const Measures& measures, const std::string& name, const RunStart& start) {
  const auto found = measures.values.find(name);
  if (found == measures.values.end() || !std::isfinite(found->second)) return "-";
  const double share = std::abs(found->second) / (start.end - start.begin);
  if (!(share >= 1.0e-12)) return "0";
  const int more = static_cast<int>(std::clamp(std::ceil(std::log10(share)), 0.0, 10.0));
  return fmt::format("{:.{}g}", found->second, 5 + more);
}

/// The first rows, and how many there are beside them.
std::string shortened(Rows rows, const char* more) {
  const std::size_t all = rows.size() - 1;
  if (all > most_rows) rows.resize(1 + most_rows);
  std::string text = text_table(rows);
  if (all > most_rows) text += fmt::format("and {} more: {}\n", all - most_rows, more);
  return text + "\n";
}

Energy sum_of(const std::vector<Energy>& energies) {
  Energy sum;
  for (const Energy& energy : energies) {
    sum.kinetic += energy.kinetic;
    sum.stored += energy.stored;
    sum.dissipated += energy.dissipated;
    sum.external_work += energy.external_work;
  }
  return sum;
}

}  // namespace

void RunTable::on_start(const RunStart& start) {
  start_ = start;
  first_.assign(start.bodies.size(), {});
  last_ = first_;
  for (std::size_t b = 0; b < start.bodies.size(); ++b) {
    const std::vector<std::string>& columns = start.bodies[b]->columns;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::string name = constraint_of(columns[c]);
      if (name.empty()) continue;
      const std::string full = start.bodies[b]->name + "." + name;
      if (held_.empty() || held_.back().name != full)
        held_.push_back({b, c, 0, full, 0.0, 0.0, {}});
      ++held_.back().axes;
    }
  }
}

void RunTable::read(const BodyRecord& record, std::size_t body) {
  for (Held& held : held_) {
    const std::size_t axes = static_cast<std::size_t>(held.axes);
    if (held.body != body || held.column + axes > record.columns.size()) continue;
    const auto from = record.columns.begin() + static_cast<std::ptrdiff_t>(held.column);
    held.last.assign(from, from + held.axes);
    double force = 0.0;
    for (const double component : held.last) force = std::hypot(force, component);
    if (!(force > held.peak)) continue;
    held.peak = force;
    held.time = record.time;
  }
}

void RunTable::on_window(const WindowReport& report) {
  for (std::size_t b = 0; b < report.responses.size(); ++b) {
    for (const BodyRecord& record : report.responses[b].records) {
      read(record, b);
      last_[b] = record.energy;
    }
    if (report.window.length() <= 0.0) first_[b] = last_[b];
  }
}

std::string RunTable::contacts(const Measures& measures) const {
  Rows rows = {
      {"contact", "begin [s]", "end [s]", "closings", "impulse [N*s]", "peak [N]", "friction [J]"}};
  Rows ties = {{"tie", "largest force [N]", "largest gap [m]"}};
  for (const InterfaceInfo& info : start_.interfaces) {
    const auto of = [&](const char* what) {
      return shown(measures, fmt::format("contact.{}.{}", info.name, what));
    };
    const auto at = [&](const char* what) {
      return time_shown(measures, fmt::format("contact.{}.{}", info.name, what), start_);
    };
    if (info.tied)
      ties.push_back({info.name, of("force_peak"), of("jump_max")});
    else
      rows.push_back({info.name, at("begin"), at("end"), of("closings"), of("impulse"),
                      of("force_peak"), of("dissipated")});
  }
  constexpr const char* more = "measures contact.* of summary.json";
  return (rows.size() > 1 ? shortened(std::move(rows), more) : "") +
         (ties.size() > 1 ? shortened(std::move(ties), more) : "");
}

std::string RunTable::reactions() const {
  Rows rows = {{"reaction", "peak [N]", "at [s]", "at the end [N]"}};
  for (const Held& held : held_) {
    std::vector<std::string> last;
    for (const double component : held.last) last.push_back(fmt::format("{:.5g}", component));
    rows.push_back({held.name, fmt::format("{:.5g}", held.peak), fmt::format("{:.5g}", held.time),
                    fmt::format("{}", fmt::join(last, ", "))});
  }
  return rows.size() > 1 ? shortened(std::move(rows), "columns of history.csv") : "";
}

std::string RunTable::energies(const Measures& measures) const {
  Rows rows = {{"energy [J]", "kinetic", "stored", "work done on it", "dissipated", "error"}};
  // What passive windows take is in no body's account.
  const GivenUp& up = end_.given_up;
  const bool passive = up.windows > 0;
  if (passive) rows[0].insert(rows[0].end() - 1, {"passive friction", "given up"});
  const auto row = [&rows](const char* name, const Energy& e) {
    std::vector<std::string> cells = {name};
    for (const double value : {e.kinetic, e.stored, e.external_work, e.dissipated})
      cells.push_back(fmt::format("{:.5g}", value));
    rows.push_back(std::move(cells));
  };
  const Energy first = sum_of(first_), last = sum_of(last_);
  row("begin", first);
  row("end", last);
  if (passive)
    for (const double taken : {up.friction, up.joules()})
      rows.back().push_back(fmt::format("{:.5g}", taken));
  const auto drift = measures.values.find("energy.total.relative_drift_end");
  const bool known = drift != measures.values.end() && std::isfinite(drift->second);
  const auto held = [](const Energy& e) { return e.total() + e.dissipated; };
  const auto own = [&held](const Energy& e) { return held(e) - e.external_work; };
  const double change = own(last) - own(first), taken = up.friction + up.joules();
  const double left = change == 0.0 ? 1.0 : (change + taken) / change;  // of the drift
  // Of bodies that begin at rest and are damped little is left of what was done on them.
  const double put_in = held(first) + std::max(0.0, last.external_work - first.external_work);
  const double scale = measures.total_energy_scale;
  const double part = scale > 0.0 && put_in > scale ? scale / put_in : 1.0;
  rows.back().push_back(known ? fmt::format("{:.2g} %", 100.0 * left * part * drift->second) : "-");
  for (std::vector<std::string>& cells : rows) cells.resize(rows[0].size());
  return text_table(rows) + "\n";
}

std::string RunTable::text(const Measures& measures) const {
  return contacts(measures) + reactions() + energies(measures);
}

std::string RunTable::times(std::span<const double> waited,
                            const std::vector<std::vector<std::size_t>>& processes) const {
  if (start_.bodies.empty()) return {};  // the run was ended before it began
  std::vector<std::string> names;
  for (const Description* body : start_.bodies) names.push_back(body->name);
  const double wall = end_.wall_seconds;
  std::string text = fmt::format("time   {}\n", shares_words(shares_of(waited, wall), names));
  if (processes.size() < 2 || !(wall > 0.0)) return text;
  std::vector<std::pair<double, std::string>> idle;  // the process that waited least comes first
  for (const std::vector<std::size_t>& bodies : processes) {
    double computed = 0.0;
    for (const std::size_t b : bodies)
      if (b < end_.compute_seconds.size()) computed += end_.compute_seconds[b];
    std::string name = bodies.empty() ? "" : names[bodies.front()];
    if (bodies.size() > 1) name += fmt::format(" and {} more", bodies.size() - 1);
    idle.emplace_back(std::max(0.0, 1.0 - computed / wall), std::move(name));
  }
  std::ranges::stable_sort(idle, {}, &std::pair<double, std::string>::first);
  text += "waited ";
  for (std::size_t k = 0; k < std::min(idle.size(), most_processes); ++k)
    text += fmt::format("{}{} {:.0f} %", k == 0 ? "" : ", ", idle[k].second, 100.0 * idle[k].first);
  if (idle.size() > most_processes)
    text += fmt::format(", {} more {:.0f} % and more", idle.size() - most_processes,
                        100.0 * idle[most_processes].first);
  return text + " of it\n";
}

void RunTable::state(Archive& archive) {
  for (Held& held : held_) {
    archive.field("peak", held.peak);
    archive.field("time", held.time);
    archive.field("last", held.last);
  }
  for (std::vector<Energy>* energies : {&first_, &last_})
    list(archive, "energies", *energies, [](Archive& a, Energy& energy) {
      for (double* part :
           {&energy.kinetic, &energy.stored, &energy.dissipated, &energy.external_work})
        a.field("energy", *part);
    });
}

}  // namespace abut
