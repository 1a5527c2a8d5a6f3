#include "coordinator/verbs/run.hpp"

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/unit_words.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/metered_body.hpp"
#include "coordinator/record/closed_form_table.hpp"
#include "coordinator/record/csv_history.hpp"
#include "coordinator/record/event_log.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/record/measure_recorder.hpp"
#include "coordinator/record/progress_line.hpp"
#include "coordinator/record/run_table.hpp"
#include "coordinator/record/summary.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/record/vtk_fields.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/verbs/placed_scene.hpp"

namespace abut {

namespace {

namespace fs = std::filesystem;

constexpr int exit_expectation = 1;

std::map<std::string, std::string> versions() {
  return {{"abut", build_version()},
          {"commit", std::string(build_info.commit)},
          {"protocol", fmt::format("{}", protocol_version)},
          {"compiler", __VERSION__}};
}

std::string resolved_text(const Scene& scene, const Document& document) {
  std::string text = "# Every value that this run used.\n";
  for (const auto& [what, version] : versions()) text += fmt::format("# {}: {}\n", what, version);
  text += fmt::format("# scene: {}\n", document.name());
  for (const std::string& override_text : document.overrides())
    text += fmt::format("# --set {}\n", override_text);
  ResolvedYaml resolved(document.units());
  resolved.add("", scene);
  resolve_body_keys(scene, document, resolved);
  return text + resolved.text();
}

/// The contact and the bodies beside the exact solution; empty when the scene names none.
std::string against_closed_form(const ClosedForm* form, const Measures& measures, const RunEnd& end,
                                const UnitSystem& units) {
  if (form == nullptr) return "";
  return in_words_of(units, closed_form_table(*form, end.time, measures)) + "\n";
}

using Processes = std::vector<std::vector<std::size_t>>;  // bodies of each

/// Bodies that others start have one each.
Processes processes_of(const Scene& scene) {
  Processes processes;
  for (const SolverProcess& process : solver_processes(scene)) processes.push_back(process.bodies);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (std::holds_alternative<ConnectLaunch>(scene.bodies[b].second.launch))
      processes.push_back({b});
  return processes;
}

/// The result for people; 0, or 1 when an expectation or the run failed.
int report(const Scene& scene, const ClosedForm* form, const Measures& measures, const RunEnd& end,
           const RunTable& table, const std::vector<double>& waited, const std::string& status,
           const fs::path& directory, const RunCommand& command, const UnitSystem& units) {
  const std::vector<ExpectationResult> results = evaluate(scene.meta.expect, measures);
  bool pass = status == "completed";
  for (const ExpectationResult& result : results) pass = pass && result.pass;
  if (!command.quiet || (!pass && status != "interrupted")) {
    fmt::print("\n{}\n\n", scene.meta.title);  // apart from the log lines above
    if (status == "completed") fmt::print("{}", against_closed_form(form, measures, end, units));
    fmt::print("{}", in_words_of(units, table.text(measures)));
    // A run cut short misses expectations for that reason alone.
    if (status == "completed" && !results.empty()) fmt::print("{}\n", to_table(results));
    fmt::print("{} after {:.3f} s: {} windows, {} of them in contact, {} exchanges\n", status,
               end.wall_seconds, end.windows, end.contact_windows, end.exchanges);
    fmt::print("{}", table.times(waited, command.local ? Processes() : processes_of(scene)));
    if (end.state_hash) fmt::print("state  {:016x}\n", *end.state_hash);
    fmt::print("files  {0}\nplots  abut report {0}\n", directory.string());
    if (scene.output.field_output) fmt::print("fields {}/fields.pvd\n", directory.string());
  }
  return pass ? 0 : exit_expectation;
}

/// The same error, which says where the run's files are as well.
template <class Error>
Error with_place_of_files(const Error& error, const fs::path& directory) {
  std::string remedy = error.remedy;
  if (remedy.ends_with('.')) remedy.pop_back();
  return Error(error.what_is_wrong, error.where,
               fmt::format("{}. The run up to there is in {}", remedy, directory.string()));
}

RunEnd conduct(const Scene& scene, const std::vector<std::unique_ptr<Subdomain>>& bodies,
               const std::vector<Observer*>& observers, const std::atomic<bool>& interrupted,
               const fs::path& directory) {
  std::vector<Subdomain*> pointers;
  for (const std::unique_ptr<Subdomain>& body : bodies) pointers.push_back(body.get());
  try {
    return Controller(scene, std::move(pointers), observers, &interrupted).run();
  } catch (const RunError& error) {
    throw with_place_of_files(error, directory);
  } catch (const InputError& error) {  // of a body: what it was given does not go together
    throw with_place_of_files(error, directory);
  }
}

}  // namespace

int run_verb(const RunCommand& command) {
  const SystemClock clock;
  const Clock::Time began = clock.now();
  start_log("abut", command.quiet ? LogLevel::error : LogLevel::info);
  const std::atomic<bool>& interrupted = watch_for_interrupts();
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  if (!command.local) check_processes(scene, document);
  // Held until the last file is written.
  RunDirectory held(
      command.out.empty() ? default_run_directory(command.scene) : fs::path(command.out),
      command.force);
  const fs::path& directory = held.path();

  Placement placement;
  Validated valid;
  try {
    placement = place(scene, document, command.local, interrupted);
    valid = validate_all(scene, document, placement, !command.local);
  } catch (...) {  // a run that never begins leaves nothing behind
    held.abandon();
    throw;
  }
  for (const Description* body : placement.descriptions())
    log_info(
        fmt::format("{}: {}", body->name, quantities_in(declared_units(scene.units), body->model)));

  held.clear();
  write_whole(directory / "scene.resolved.yaml", resolved_text(scene, document));
  const ClosedForm* form = valid.form ? &*valid.form : nullptr;
  BodyMeter meter(placement.bodies.size());
  const std::vector<std::unique_ptr<Subdomain>> bodies = metered(placement.pointers(), meter);
  MeasureRecorder recorder(form, scene.output.force_filter, scene.output.steady_after);
  CsvHistory history(directory, form, document.units());
  EventLog events(directory);
  Summary summary(directory,
                  {scene.meta.title, versions(), scene.meta.expect, began, valid.estimate,
                   declared_units(scene.units), &meter.waited_seconds()},
                  recorder, form);
  ProgressLine progress(clock, isatty(STDERR_FILENO) == 1 && !command.quiet, meter.waited_seconds(),
                        document.units().word("s"));
  RunTable table;
  std::vector<Observer*> observers{&recorder, &history, &events, &progress, &table, &summary};
  std::optional<VtkFields> fields;
  if (const std::optional<FieldOutputSpec>& wanted = scene.output.field_output)
    observers.push_back(&fields.emplace(directory, placement.pointers(), wanted->every));

  const RunEnd end = conduct(scene, bodies, observers, interrupted, directory);
  // Bodies in the middle of a solve hear no orderly end; they are ended when the launch goes.
  if (placement.launch && end.status != "interrupted") placement.launch->finish();
  const int code = report(scene, form, recorder.measures(), end, table, meter.waited_seconds(),
                          summary.status(), directory, command, document.units());
  return interrupt_exit_code() != 0 ? interrupt_exit_code() : code;
}

}  // namespace abut
