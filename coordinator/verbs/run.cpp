#include "coordinator/verbs/run.hpp"

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "base/log.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/verbs/recorded_run.hpp"

namespace abut {

namespace fs = std::filesystem;

int run_verb(const RunCommand& command) {
  const Clock::Time began = SystemClock().now();
  start_log("abut", command.quiet ? LogLevel::error : LogLevel::info);
  const Interrupts interrupts = watch_for_interrupts();
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  if (!command.local) check_processes(scene, document);
  // Held until the last file is written.
  RunDirectory held(
      command.out.empty() ? default_run_directory(command.scene) : fs::path(command.out),
      command.force);

  Placement placement;
  Validated valid;
  try {
    placement = place(scene, document, command.local, interrupts.at_once);
    valid = validate_all(scene, document, placement, !command.local);
  } catch (...) {  // a run that never begins leaves nothing behind
    held.abandon();
    throw;
  }
  for (const Description* body : placement.descriptions())
    log_info(fmt::format("{}: {}", body->name, body->model));

  held.clear();
  const RunPlan plan{document,      scene,         held.path(), resolved_text(scene, document),
                     command.local, command.quiet, began};
  write_whole(held.path() / "scene.resolved.yaml", plan.resolved);
  return record_run(plan, placement, valid, interrupts, nullptr);
}

}  // namespace abut
