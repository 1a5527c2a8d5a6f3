#include "coordinator/record/progress_file.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/log.hpp"
#include "coordinator/record/run_facts.hpp"
#include "coordinator/record/text_file.hpp"

namespace abut {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::seconds between_looks{1};

double since_1970() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// When a process began, in ticks since the machine did: with its id, one of its kind. Empty: it
/// is gone.
std::string began_at(std::int64_t id) {
  constexpr int fields_after_name = 20;  // of /proc/ID/stat
  std::string stat = first_line(fmt::format("/proc/{}/stat", id));
  stat.erase(0, std::min(stat.size(), stat.rfind(')') + 2));
  for (int k = 1; k < fields_after_name; ++k)
    stat.erase(0, std::min(stat.size(), stat.find(' ') + 1));
  return stat.substr(0, stat.find(' '));
}

}  // namespace

ProgressFile::ProgressFile(const std::filesystem::path& directory, Heading heading,
                           const BodyMeter& meter, const Clock& clock)
    : path_(directory / "progress.json"),
      heading_(std::move(heading)),
      meter_(meter),
      clock_(clock),
      boot_(first_line("/proc/sys/kernel/random/boot_id")),
      opened_(since_1970()) {
  std::error_code ignored;
  space_ = std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string();
  since_.push_back(began_at(getpid()));
  for (const Process& process : heading_.processes) since_.push_back(began_at(process.id));
}

double ProgressFile::wall() const {
  return std::chrono::duration<double>(clock_.now() - began_).count();
}

void ProgressFile::on_start(const RunStart& start) {
  begin_ = start.begin;
  end_ = start.end;
  bodies_.clear();
  for (const Description* body : start.bodies) bodies_.push_back(body->name);
  facts_ = facts(start);
  began_ = clock_.now();
  write(start.begin);
}

void ProgressFile::on_window(const WindowReport& report) {
  windows_ = report.windows;
  if (std::exchange(first_, false)) remaining_.start(part_of(report.window.begin));
  if (clock_.now() < next_) return;
  closed_ = static_cast<std::int64_t>(report.pairs.size());
  iterations_ = 0;
  for (const InterfaceReport& interface : report.interfaces) {
    closed_ += interface.closed && report.pairs.empty() ? 1 : 0;
    iterations_ = std::max(iterations_, interface.iterations);
  }
  write(report.window.end);
  remaining_.add(wall(), part_of(report.window.end));
}

void ProgressFile::on_end(const RunEnd& end) {
  if (heading_.more && end.status == "completed") return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void ProgressFile::write(double reached) {
  next_ = clock_.now() + between_looks;
  try {
    write_whole(path_, text(reached, wall()));
  } catch (const RunError& error) {  // a run is worth more than a look at it
    if (!std::exchange(warned_, true))
      log_warning(fmt::format("abut monitor sees nothing new of this run: {}", error.what()));
  }
}

/// All members of an object, without its brackets.
std::string ProgressFile::facts(const RunStart& start) const {
  Json json = {{"title", heading_.title}};
  if (!heading_.units.empty()) json["units"] = heading_.units;
  json["opened"] = opened_;
  json["bodies"] = bodies_json(start, heading_.units);
  json["ports"] = ports_json(start);
  json["interfaces"] = interfaces_json(start);
  json["local"] = heading_.local;
  json["machine"] = {{"boot", boot_}, {"process_ids", space_}};
  json["program"] = {{"id", getpid()}, {"began", since_[0]}};
  json["processes"] = Json::array();
  for (std::size_t p = 0; p < heading_.processes.size(); ++p) {
    Json entry = {{"id", heading_.processes[p].id}, {"began", since_[p + 1]}};
    entry["bodies"] = Json::array();
    for (const std::size_t b : heading_.processes[p].bodies) entry["bodies"].push_back(bodies_[b]);
    json["processes"].push_back(std::move(entry));
  }
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.substr(1, text.size() - 2);
}

std::string ProgressFile::text(double reached, double wall) const {
  const std::optional<double> left = remaining_.left(wall, part_of(reached));
  Json json = Json::object();
  json["written"] = since_1970();
  json["time"] = {{"begin", begin_}, {"end", end_}, {"reached", reached}};
  json["wall_s"] = wall;
  json["left_s"] = left && std::isfinite(*left) ? Json(*left) : Json(nullptr);
  json["windows"] = windows_;
  json["in_contact"] = closed_;
  json["iterations"] = iterations_;
  json["of_bodies"] = Json::object();
  std::int64_t calls = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    calls += meter_.calls()[b];
    json["of_bodies"][bodies_[b]] = {{"exchanges", meter_.calls()[b]},
                                     {"waited_s", meter_.waited_seconds()[b]}};
  }
  json["exchanges"] = calls;
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();
  return text + ",\n" + facts_ + "}\n";
}

}  // namespace abut
