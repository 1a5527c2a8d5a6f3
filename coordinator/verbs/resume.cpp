#include "coordinator/verbs/resume.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/scene_changes.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/verbs/recorded_run.hpp"

namespace abut {

namespace {

namespace fs = std::filesystem;

void check_time(const Checkpoint& from, const Scene& scene, const fs::path& directory) {
  if (from.time < scene.time.end - 1.0e-9 * scene.time.window) return;
  throw InputError(
      fmt::format("has come to {:.6g} s, and its end is {:.6g} s", from.time, scene.time.end),
      directory.string(), "Give a later end: --end TIME.");
}

}  // namespace

int resume_verb(const ResumeCommand& command) {
  const Clock::Time began = SystemClock().now();
  start_log("abut", command.quiet ? LogLevel::error : LogLevel::info);
  const Interrupts interrupts = watch_for_interrupts();
  RunDirectory held = RunDirectory::of_run(command.directory);
  std::vector<std::string> warnings;
  const Checkpoint from = read_checkpoint(held.path(), warnings);
  for (const std::string& warning : warnings) log_warning(warning);

  std::vector<std::string> overrides = command.overrides;
  if (!command.end.empty()) overrides.push_back("time.end=" + command.end);
  const std::string text = (held.path() / "scene.resolved.yaml").string();
  const Document document = Document::load(command.scene.empty() ? text : command.scene, overrides);
  const Scene scene = read_all_keys(document);
  if (!command.local) check_processes(scene, document);
  const std::string resolved = resolved_text(scene, document);
  check_changes(from.scene, resolved, overrides);
  check_time(from, scene, held.path());

  Placement placement = place(scene, document, command.local, interrupts.at_once);
  const Validated valid = validate_all(scene, document, placement, !command.local);
  const RunPlan plan{document, scene, held.path(), resolved, command.local, command.quiet, began};
  log_info(fmt::format("goes on from {:.6g} s, window {}", from.time, from.windows));
  held.go_on();
  write_whole(held.path() / "scene.resolved.yaml", resolved);
  return record_run(plan, placement, valid, interrupts, &from);
}

}  // namespace abut
