#include "coordinator/verbs/resume.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/log.hpp"
#include "coordinator/record/checkpoint_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/scene_changes.hpp"
#include "coordinator/verbs/recorded_run.hpp"

namespace abut {

namespace {

/// Stages to come are those that the run began with: what has begun is the scene's own by now.
void check_names(const std::string& before, const Document& now) {
  const std::vector<std::string> kept =
      Document::from_text("the checkpoint", before).keys("stages");
  InputErrors errors;
  for (const std::string& name : now.keys("stages"))
    if (std::ranges::find(kept, name) == kept.end())
      errors.add({"is no stage to come", now.where(join_path("stages", name)),
                  kept.empty() ? "None follows: give keys of the present one without stages.NAME."
                               : fmt::format("Give one of: {}; or keys of the present one, without "
                                             "stages.NAME.",
                                             fmt::join(kept, ", "))});
  errors.raise();
}

/// Of a body that has another model in the stage that follows, motion is kept in another form.
void check_swapped(const std::string& before, const Document& now, const Document& next) {
  const std::vector<std::string> kept =
      swapped_bodies(Document::from_text("the checkpoint", before));
  const std::vector<std::string> wanted = swapped_bodies(now);
  InputErrors errors;
  for (const std::string& name : now.keys("bodies")) {
    const bool was = std::ranges::find(kept, name) != kept.end();
    if (was == (std::ranges::find(wanted, name) != wanted.end())) continue;
    errors.add({was ? "is that of the stage before: the state was kept for another one"
                    : "is another than in the stage before: the state was kept for the same one",
                next.where(join_path(join_path("bodies", name), "model")),
                "Resume from before the stage's end, or run the scene anew."});
  }
  errors.raise();
}

/// The scene that goes on: that of the checkpoint, or one that may take its place.
Document scene_of(const ResumeCommand& command, const Checkpoint& from) {
  std::vector<std::string> overrides = command.overrides;
  const bool another_end = std::ranges::any_of(
      overrides, [](const std::string& text) { return text.starts_with("time.end="); });
  if (!command.end.empty()) {
    if (another_end)
      throw InputError("is given twice", "--end and --set time.end", "Give one of them.");
    overrides.push_back("time.end=" + command.end);
  }
  Document document =
      command.scene.empty()
          ? Document::from_text(command.directory + "/scene.resolved.yaml", from.scene, overrides)
          : Document::load(command.scene, overrides);
  check_names(from.scene, document);
  check_changes(from.scene, resolved_text(read_all_keys(document), document), overrides);
  if ((another_end || !command.end.empty()) && document.has("stages"))
    throw InputError("cannot be another, as stages follow, which have their own ends",
                     command.end.empty() ? "--set time.end" : "--end",
                     "Leave it out; a signal (TERM) ends the run, and leaves a checkpoint.");
  if (!from.stage_ends) return document;
  std::optional<Document> next = document.next_stage();
  if (!next)
    throw InputError("has no stage any more that could follow", command.directory,
                     "Resume with the stages that the run began with.");
  check_swapped(from.scene, document, *next);
  return std::move(*next);
}

/// A run may have been ended after its last window, before it had told of its end.
bool has_ended(const std::string& directory) {
  std::ifstream file(std::filesystem::path(directory) / "summary.json");
  const nlohmann::json summary = nlohmann::json::parse(file, nullptr, false);
  return summary.is_object() && summary.contains("status") && summary["status"] == "completed";
}

bool at_end(const Checkpoint& from, const Scene& scene) {
  return from.time >= scene.time.end - 1.0e-9 * scene.time.window;
}

/// Where no window follows, measures of the last step (areas that stick) are not known: the way to
/// the end is gone once more.
void go_back(Checkpoint& from, const Scene& scene, const std::string& directory) {
  if (from.stage_ends || !at_end(from, scene)) return;
  if (std::optional<Checkpoint> earlier = read_earlier_checkpoint(directory))
    if (earlier->scene == from.scene && !earlier->stage_ends) from = std::move(*earlier);
  if (at_end(from, scene))
    log_warning("the run ends where it is resumed: measures of its last step are not known");
}

/// Nothing reads the scene beside the results again: who edits it must hear that.
void tell_of_edits(const Checkpoint& from, const std::string& directory) {
  const std::filesystem::path scene = std::filesystem::path(directory) / "scene.resolved.yaml";
  std::error_code none;
  const auto kept = last_write_time(std::filesystem::path(directory) / latest_checkpoint, none);
  if (none) return;
  const auto edited = last_write_time(scene, none);
  if (none || edited <= kept) return;
  std::ifstream file(scene);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text == from.scene) return;
  log_warning(
      fmt::format("{} has changed since the checkpoint was kept, and is not read: the run "
                  "goes on with the scene of the checkpoint. Give changes by --set "
                  "KEY=VALUE, or the scene by --scene FILE",
                  scene.string()));
}

void check_end(const Checkpoint& from, const Scene& scene, const std::string& directory) {
  if (!at_end(from, scene) || !has_ended(directory)) return;
  throw InputError(fmt::format("is complete: it has come to its end, {:.6g} s", from.time),
                   directory, "Give a later end: --end TIME.");
}

}  // namespace

int resume_verb(const ResumeCommand& command) {
  const RunOptions options{command.local, command.quiet,       command.insecure, command.trace,
                           command.grace, SystemClock().now(), command.awaited};
  start_log("abut", command.quiet ? LogLevel::error : LogLevel::info);
  const Interrupts interrupts = watch_for_interrupts();
  RunDirectory held = RunDirectory::of_run(command.directory);
  std::vector<std::string> warnings;
  Checkpoint from = read_checkpoint(held.path(), warnings);
  for (const std::string& warning : warnings) log_warning(warning);
  if (command.scene.empty()) tell_of_edits(from, command.directory);
  Document document = scene_of(command, from);
  RunPlan plan = plan_run(std::move(document), options, interrupts,
                          from.stage_ends ? std::optional(from.time) : std::nullopt);
  check_end(from, plan.scene, command.directory);
  go_back(from, plan.scene, command.directory);
  log_info(fmt::format("goes on from {:.6g} s, window {}", from.time, from.windows));
  held.go_on();
  return record_run(std::move(plan), options, held, interrupts, std::move(from));
}

}  // namespace abut
