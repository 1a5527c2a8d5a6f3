#include "coordinator/verbs/checkpoints.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>
#include <variant>

#include <fmt/format.h>

#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "coordinator/hand_over.hpp"

namespace abut {
namespace {

std::string text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span<const char>(text));
}

/// What has been left since the last checkpoint.
struct Since {
  std::int64_t windows = 0;
  double time = 0.0, wall = 0.0;  // [s]

  bool reach(const WindowsBetween& spec) const { return windows >= spec.every; }
  bool reach(const TimeBetween& spec) const {
    constexpr double rounding = 1.0e-9;  // of sums of windows
    return time >= (1.0 - rounding) * spec.every;
  }
  bool reach(const WallTimeBetween& spec) const { return wall >= spec.every; }
};

void check_bodies(const Checkpoint& from, const std::vector<Subdomain*>& bodies) {
  const bool alike = from.bodies.size() == bodies.size();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Description& body = bodies[b]->describe();
    if (!alike || from.bodies[b].name != body.name)
      throw InputError("has other bodies than the checkpoint, or in another order", "the scene",
                       "Resume with the scene of the run.");
    if (from.bodies[b].fingerprint == 0) continue;  // handed over to another one
    if (from.bodies[b].fingerprint != fingerprint(body))
      throw InputError(
          "is another than the checkpoint's: its mesh or names have changed since",
          fmt::format("body '{}'", body.name),
          "Resume with the files and programs that the run began with, or run again.");
  }
}

/// By body; empty: none is handed over.
std::vector<std::optional<HandOver>> handed_of(const Checkpoint& from) {
  std::vector<std::optional<HandOver>> handed(from.bodies.size());
  bool any = false;
  for (std::size_t b = 0; b < handed.size(); ++b) {
    if (from.bodies[b].fingerprint != 0) continue;
    handed[b] = HandOver::from(bytes_of(from.bodies[b].state));
    any = true;
  }
  if (!any) handed.clear();
  return handed;
}

}  // namespace

Checkpoints::Checkpoints(Keeping keeping, std::vector<Subdomain*> bodies,
                         std::vector<Observer*> observers, const Clock& clock)
    : keeping_(std::move(keeping)),
      bodies_(std::move(bodies)),
      observers_(std::move(observers)),
      clock_(clock),
      written_(clock.now()) {}

bool Checkpoints::due(const Pause& pause) const {
  if (pause.last && keeping_.more) return true;
  if (latest_ && pause.windows == windows_) return false;  // it has this state already
  if (pause.interrupted) return true;
  if (!keeping_.when || pause.windows == windows_) return false;
  if (pause.last) return true;
  const std::chrono::duration<double> wall = clock_.now() - written_;
  const Since since{pause.windows - windows_, pause.time - time_, wall.count()};
  return std::visit([&since](const auto& spec) { return since.reach(spec); }, *keeping_.when);
}

void Checkpoints::look(const Pause& pause, Controller& controller) {
  if (!std::exchange(begun_, true)) time_ = pause.time, windows_ = pause.windows;
  if (!due(pause)) return;
  try {
    write(pause, controller);
  } catch (const RunError& error) {
    if (!pause.interrupted) throw;
    log_warning(fmt::format("this end of the run is not kept: {}", error.what()));
  }
}

void Checkpoints::write(const Pause& pause, Controller& controller) {
  const SpanScope span(controller.spans(), "checkpoint");
  Checkpoint kept;
  kept.version = build_info.version;
  kept.scene = keeping_.scene;
  kept.time = pause.time;
  kept.windows = pause.windows;
  kept.stage_ends = pause.last && keeping_.more;
  if (kept.stage_ends && controller.stays_passive())
    throw RunError("ends while bodies go passively, where no other scheme can go on", "the stage",
                   "Let it end at another time");
  kept.run = text_of(controller.save());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Description& body = bodies_[b]->describe();
    if (kept.stage_ends && std::ranges::find(keeping_.swapped, body.name) != keeping_.swapped.end())
      kept.bodies.push_back(
          {body.name,
           text_of(hand_over(*bodies_[b], controller.record(static_cast<int>(b))).bytes()), 0});
    else
      kept.bodies.push_back({body.name, text_of(bodies_[b]->checkpoint()), fingerprint(body)});
  }
  for (Observer* observer : observers_) {
    if (observer->kept_as().empty()) continue;
    std::vector<std::byte> bytes;
    Archive archive = Archive::writer(bytes, Archive::Form::named);
    observer->state(archive);
    archive.finish();
    kept.records.push_back({std::string(observer->kept_as()), text_of(bytes)});
  }
  write_checkpoint(keeping_.directory, kept);
  latest_ = time_ = pause.time;
  windows_ = pause.windows;
  written_ = clock_.now();
}

void Checkpoints::resume(const Checkpoint& from, Controller& controller) {
  latest_ = from.time;
  check_bodies(from, bodies_);
  if (from.stage_ends)
    controller.load_end(bytes_of(from.run), handed_of(from));
  else
    controller.load(bytes_of(from.run));
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    bodies_[b]->resume(bytes_of(from.bodies[b].state));
  for (Observer* observer : observers_) {
    const Checkpoint::Part* part = from.record(observer->kept_as());
    if (part == nullptr) continue;
    Archive archive = Archive::reader(bytes_of(part->state), Archive::Form::named);
    observer->state(archive);
    archive.finish();
  }
}

}  // namespace abut
