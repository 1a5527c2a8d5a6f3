#include "coordinator/record/vtk_fields.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/assert.hpp"
#include "base/error.hpp"

namespace abut {
namespace {

constexpr const char* folder = "fields";
constexpr const char* list_begin =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n <Collection>\n";
constexpr const char* list_end = " </Collection>\n</VTKFile>\n";

/// The box of a view becomes one around this grid as well.
void include(const Grid& grid, bool first, ParaviewView& view) {
  for (std::size_t k = 0; k < grid.points.size(); ++k) {
    const double x = grid.points[k];
    double &low = view.low[k % 3], &high = view.high[k % 3];
    low = first && k < 3 ? x : std::min(low, x);
    high = first && k < 3 ? x : std::max(high, x);
  }
}

}  // namespace

VtkFields::VtkFields(const std::filesystem::path& directory, std::vector<Subdomain*> bodies,
                     int every, TextFile::Opening opening)
    : directory_(directory), bodies_(std::move(bodies)), every_(every), opening_(opening) {
  ABUT_ASSERT(every > 0);
}

void VtkFields::on_start(const RunStart&) {
  for (Subdomain* body : bodies_) {
    if (body->describe().fields.empty()) continue;
    const Grid grid = body->grid();
    shown_.push_back({body, VtuFile(grid, body->describe().fields)});
    include(grid, shown_.size() == 1, view_);
    // Bodies that deform decide: a wall in front of them has no stress.
    const std::optional<FieldInfo> colour = colour_among(body->describe().fields);
    if (colour && (!view_.colour || view_.colour->name == "velocity")) view_.colour = colour;
  }
  std::error_code error, ignored;
  std::filesystem::create_directory(directory_ / folder, error);
  const bool made =
      std::filesystem::is_directory(std::filesystem::symlink_status(directory_ / folder, ignored));
  if (error || !made)
    throw RunError(fmt::format("cannot be made: {}", error ? error.message() : "it is no folder"),
                   (directory_ / folder).string(),
                   "Check that the folder above is writable and has space left.");
  list_.emplace(directory_ / "fields.pvd", opening_);
  if (opening_ == TextFile::Opening::made) {
    list_->append(list_begin);
    list_->append_ended("", list_end);
  }
  write_view();
}

void VtkFields::state(Archive& archive) {
  archive.field("windows", windows_);
  archive.field("written", written_);
  archive.field("largest", view_.largest);
  list_->state(archive);
  if (archive.writing()) return;
  list_->append_ended("", list_end);
  remove_later();
}

/// States that the run before wrote after its checkpoint: not all of them come again.
void VtkFields::remove_later() const {
  std::ifstream file(directory_ / "fields.pvd");
  const std::string listed{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::regex name(R"((.+)_\d{6,}\.vtu)");
  for (const auto& entry : std::filesystem::directory_iterator(directory_ / folder)) {
    const std::string state = entry.path().filename().string();
    std::smatch parts;
    if (!std::regex_match(state, parts, name) ||
        listed.find(fmt::format("\"{}/{}\"", folder, state)) != std::string::npos)
      continue;
    const bool ours = std::ranges::any_of(shown_, [&parts](const Shown& shown) {
      return shown.body->describe().name == parts[1].str();
    });
    std::error_code ignored;
    if (ours && std::filesystem::is_regular_file(entry.symlink_status(ignored)))
      std::filesystem::remove(entry.path(), ignored);
  }
}

void VtkFields::on_window(const WindowReport& report) {
  const std::int64_t before = std::exchange(windows_, report.windows);
  const bool begin = report.window.length() <= 0.0;
  if (begin || windows_ / every_ > before / every_) write(report.window.end);
}

void VtkFields::on_end(const RunEnd& end) {
  // A failed run ends in a state that was never accepted; where there is no hash the bodies are
  // gone.
  const bool there = end.state_hash.has_value() && end.status != "failed";
  if (there && end.time > written_) write(end.time);
  if (list_) list_->close();
  if (there) write_view();
}

void VtkFields::write_view() const {
  // A file that is moved with its folder is looked for where it was: ParaView asks for the place.
  write_whole(directory_ / "fields.pvsm",
              paraview_state(std::filesystem::absolute(directory_ / "fields.pvd"), view_));
}

void VtkFields::write(double time) {
  std::string lines;
  for (std::size_t b = 0; b < shown_.size(); ++b) {
    const Description& body = shown_[b].body->describe();
    const std::vector<FieldValues> values = shown_[b].body->fields();
    const std::string fault = not_finite(values, body.fields);
    if (!fault.empty())
      throw RunError(fmt::format("{} at {:.9g} s", fault, time),
                     fmt::format("body '{}'", body.name),
                     "Take smaller steps, and look at the states before this one");
    const std::string name = fmt::format("{}/{}_{:06}.vtu", folder, body.name, windows_);
    shown_[b].file.write(directory_ / name, time, values);
    for (std::size_t k = 0; view_.colour && k < values.size(); ++k)
      if (body.fields[k].name == view_.colour->name)
        view_.largest =
            std::max(view_.largest, largest_magnitude(values[k], body.fields[k].components));
    lines += fmt::format("  <DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time,
                         b, body.name, name);
  }
  list_->append_ended(lines, list_end);
  written_ = time;
}

}  // namespace abut
