#include "coordinator/verbs/run.hpp"

#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/log.hpp"
#include "base/unit_words.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/verbs/recorded_run.hpp"
#include "coordinator/wanted_fit.hpp"

namespace abut {

namespace fs = std::filesystem;

int run_verb(const RunCommand& command) {
  const RunOptions options{command.local, command.quiet,       command.insecure, command.trace,
                           command.grace, SystemClock().now(), command.awaited};
  start_log("abut", command.quiet ? LogLevel::error : LogLevel::info);
  const Interrupts interrupts = watch_for_interrupts();
  Document document = Document::load(command.scene, command.overrides);
  // Held until the last file is written.
  RunDirectory held(
      command.out.empty() ? default_run_directory(command.scene) : fs::path(command.out),
      command.force);
  std::optional<RunPlan> plan;
  try {
    plan = plan_run(std::move(document), options, interrupts);
    validate_stages(plan->document);
    check_nothing_before(plan->scene);
    for (const Description* body : plan->placement.descriptions())
      log_info(fmt::format("{}: {}", body->name,
                           quantities_in(declared_units(plan->scene.units), body->model)));
    held.clear();
    write_whole(held.path() / "scene.resolved.yaml", resolved_text(plan->scene, plan->document));
  } catch (...) {  // a run that never begins leaves nothing behind
    held.abandon();
    throw;
  }
  return record_run(std::move(*plan), options, held, interrupts, std::nullopt);
}

}  // namespace abut
