#include "coordinator/record/measure_history.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/unit_words.hpp"
#include "coordinator/record/measure_names.hpp"

namespace abut {

std::string_view unit_of_body_measure(std::string_view name) {
  // The first that a name has decides: a port may be called as one of the later ones.
  constexpr std::array<std::pair<std::string_view, std::string_view>, 15> units = {
      {{"stress.", "Pa"},
       {"von_mises", "Pa"},
       {"pressure_max", "Pa"},
       {"contact.area", "m^2"},
       {"contact.stick_area", "m^2"},
       {"contact.spread", "m"},
       {"displacement.", "m"},
       {"velocity.", "m/s"},
       {"angular_momentum.", "kg m^2/s"},
       {"momentum.", "kg m/s"},
       {"energy.hourglass_share", ""},
       {"energy.", "J"},
       {"reaction.", "N"},
       {"stable_step.", "s"},
       {"rotation.", "rad"}}};
  for (const auto& [part, unit] : units)
    if (name.find(part) != std::string_view::npos) return unit;
  return "";
}

MeasureHistory::MeasureHistory(const std::filesystem::path& directory,
                               std::vector<Subdomain*> bodies, const std::vector<std::string>& of,
                               int every, UnitSystem units, TextFile::Opening opening)
    : directory_(directory),
      bodies_(std::move(bodies)),
      of_(of),
      every_(every),
      units_(std::move(units)),
      opening_(opening) {
  ABUT_ASSERT(every > 0);
}

void MeasureHistory::on_start(const RunStart&) {
  std::string header = "time [s]";
  for (const std::string& name : of_) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const Description& body = bodies_[b]->describe();
      const auto told = std::ranges::find_if(body.measures, [&](const std::string& measure) {
        return body_measure(body.name, measure) == name;
      });
      if (told == body.measures.end()) continue;
      columns_.push_back({name, b, static_cast<std::size_t>(told - body.measures.begin())});
      const std::string_view unit = unit_of_body_measure(*told);
      header += unit.empty() ? fmt::format(",{}", name) : fmt::format(",{} [{}]", name, unit);
    }
  }
  file_.emplace(directory_ / "measures.csv", opening_);
  if (opening_ == TextFile::Opening::made) file_->append(in_words_of(units_, header + "\n"));
}

void MeasureHistory::state(Archive& archive) {
  archive.field("windows", windows_);
  archive.field("written", written_);
  file_->state(archive);
}

void MeasureHistory::on_window(const WindowReport& report) {
  const std::int64_t before = std::exchange(windows_, report.windows);
  const bool begin = report.window.length() <= 0.0;
  if (begin || windows_ / every_ > before / every_) write(report.window.end);
}

void MeasureHistory::on_end(const RunEnd& end) {
  // A failed run ends in a state that was never accepted; where there is no hash the bodies are
  // gone.
  const bool there = end.state_hash.has_value() && end.status != "failed";
  if (there && end.time > written_) write(end.time);
  if (file_) file_->close();
}

void MeasureHistory::write(double time) {
  std::vector<std::vector<double>> told(bodies_.size());
  std::string row = fmt::format("{}", time);
  for (const Column& column : columns_) {
    std::vector<double>& values = told[column.body];
    if (values.empty()) values = bodies_[column.body]->measure();
    const double value = values.at(column.measure);
    row += std::isfinite(value) ? fmt::format(",{}", value) : ",";
  }
  file_->append(row + "\n");
  file_->flush();
  written_ = time;
}

}  // namespace abut
