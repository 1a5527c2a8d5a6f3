#include "coordinator/verbs/recorded_run.hpp"

#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/log.hpp"
#include "base/printable.hpp"
#include "base/shell_word.hpp"
#include "base/unit_words.hpp"
#include "base/yaml_differences.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/metered_body.hpp"
#include "coordinator/port_roles.hpp"
#include "coordinator/record/closed_form_table.hpp"
#include "coordinator/record/csv_history.hpp"
#include "coordinator/record/event_log.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/record/measure_history.hpp"
#include "coordinator/record/measure_recorder.hpp"
#include "coordinator/record/progress_file.hpp"
#include "coordinator/record/progress_line.hpp"
#include "coordinator/record/run_table.hpp"
#include "coordinator/record/span_file.hpp"
#include "coordinator/record/summary.hpp"
#include "coordinator/record/vtk_fields.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/trust.hpp"
#include "coordinator/verbs/checkpoints.hpp"
#include "messaging/lost_body.hpp"

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

/// The contact and the bodies beside the exact solution; empty when the scene names none.
std::string against_closed_form(const ClosedForm* form, const Measures& measures, const RunEnd& end,
                                const UnitSystem& units) {
  if (form == nullptr) return "";
  return in_words_of(units, closed_form_table(*form, end.time, measures)) + "\n";
}

using Processes = std::vector<std::vector<std::size_t>>;  // bodies of each

Processes processes_of(const Scene& scene) {
  Processes processes;
  for (const SolverProcess& process : all_processes(scene)) processes.push_back(process.bodies);
  return processes;
}

/// Those that this program has started.
std::vector<ProgressFile::Process> started(const RunPlan& plan) {
  std::vector<ProgressFile::Process> all;
  if (!plan.placement.launch) return all;
  const std::vector<SolverProcess> processes = solver_processes(plan.scene);
  const std::vector<std::int64_t> ids = plan.placement.launch->process_ids();
  for (std::size_t p = 0; p < std::min(ids.size(), processes.size()); ++p)
    all.push_back({ids[p], processes[p].bodies});
  return all;
}

ProgressFile::Heading progress_heading(const RunPlan& plan, const RunOptions& options, bool more) {
  return {plan.scene.meta.title, declared_units(plan.scene.units), options.local, started(plan),
          more};
}

/// Tells the file of spans who the bodies are, and the controller who listens.
void trace(SpanFile* spans, const RunPlan& plan, const RunOptions& options,
           Controller& controller) {
  if (spans == nullptr) return;
  std::vector<std::string> names;
  for (const Description* body : plan.placement.descriptions()) names.push_back(body->name);
  std::vector<int> of(names.size(), -1);
  if (!options.local) {
    const Processes processes = processes_of(plan.scene);
    for (std::size_t p = 0; p < processes.size(); ++p)
      for (const std::size_t b : processes[p]) of[b] = static_cast<int>(p);
  }
  spans->begin(names, of);
  controller.tell_spans([spans](const Span& span) { spans->tell(span); });
}

/// The result for people; 0, or 1 when an expectation or the run failed.
int report(const RunPlan& plan, const RunOptions& options, const fs::path& directory,
           const Measures& measures, const RunEnd& end, const RunTable& table,
           const std::vector<double>& waited, const std::string& status,
           std::optional<double> kept) {
  const Scene& scene = plan.scene;
  const UnitSystem& units = plan.document.units();
  const std::vector<ExpectationResult> results = evaluate(scene.meta.expect, measures);
  bool pass = status == "completed";
  for (const ExpectationResult& result : results) pass = pass && result.pass;
  if (!options.quiet || (!pass && status != "interrupted")) {
    fmt::print("\n{}\n\n", printable(scene.meta.title));  // apart from the log lines above
    if (status == "completed")
      fmt::print("{}", against_closed_form(plan.valid.form ? &*plan.valid.form : nullptr, measures,
                                           end, units));
    fmt::print("{}", in_words_of(units, table.text(measures)));
    // A run cut short misses expectations for that reason alone.
    if (status == "completed" && !results.empty()) fmt::print("{}\n", to_table(results));
    fmt::print("{} after {:.3f} s: {} windows, {} of them in contact, {} exchanges\n", status,
               end.wall_seconds, end.windows, end.contact_windows, end.exchanges);
    fmt::print("{}", table.times(waited, options.local ? Processes() : processes_of(scene)));
    if (end.state_hash) fmt::print("state  {:016x}\n", *end.state_hash);
    fmt::print("files  {}\nplots  abut report {}\n", directory.string(),
               shell_word(directory.string()));
    if (options.trace) fmt::print("trace  {}/trace.json\n", directory.string());
    if (scene.output.field_output) fmt::print("fields {}/fields.pvd\n", directory.string());
    if (kept && status != "completed")
      fmt::print("go on  abut resume {}, from {:.6g} s\n", shell_word(directory.string()), *kept);
    if (!kept && status == "interrupted")
      fmt::print(
          "go on  nothing is kept to go on from: the window under way had not ended after {} s "
          "or at a second signal; give --grace more, or the scene output: {{checkpoint: ...}}\n",
          options.grace);
  }
  return pass ? 0 : exit_expectation;
}

/// The same error, which says where the run's files are as well, and how to go on.
template <class Error>
Error with_place_of_files(const Error& error, const fs::path& directory, std::optional<double> kept,
                          std::string_view otherwise = "") {
  std::string remedy = error.remedy;
  if (remedy.ends_with('.')) remedy.pop_back();
  remedy += fmt::format(". The run up to there is in {}", directory.string());
  if (kept)
    remedy += fmt::format("; abut resume {} goes on from {:.6g} s", shell_word(directory.string()),
                          *kept);
  else
    remedy += otherwise;
  return Error(error.what_is_wrong, error.where, remedy);
}

/// Of a stage that cannot begin, or a state that does not fit, files tell as well.
void take_up(const Checkpoint& from, Checkpoints& checkpoints, Controller& controller) {
  try {
    checkpoints.resume(from, controller);
  } catch (const std::exception& error) {
    controller.give_up(error);
    throw;
  }
}

/// To the end, from the begin or a checkpoint.
RunEnd conduct(Controller& controller, Checkpoints& checkpoints, const Checkpoint* from,
               const fs::path& directory) {
  controller.between_windows = [&](const Pause& pause) { checkpoints.look(pause, controller); };
  try {
    if (from != nullptr) take_up(*from, checkpoints, controller);
    return controller.run();
  } catch (const LostBody& error) {
    throw with_place_of_files(error, directory, checkpoints.latest(),
                              "; no checkpoint was kept before it was lost: output: {checkpoint: "
                              "...} says how often one is");
  } catch (const RunError& error) {
    throw with_place_of_files(error, directory, checkpoints.latest());
  } catch (const InputError& error) {  // of a body: what it was given does not go together
    throw with_place_of_files(error, directory, checkpoints.latest());
  }
}

/// Where a file that observers write begins; of one that a checkpoint knows, it goes on.
TextFile::Opening opening_of(const Checkpoint* from, std::string_view kept_as) {
  const bool there = from != nullptr && from->record(kept_as) != nullptr;
  return there ? TextFile::Opening::goes_on : TextFile::Opening::made;
}

/// What a stage has come to.
struct StageEnd {
  int code = 0;
  bool completed = false;
};

/// One stage. `more`: another one follows, and tells of the end.
StageEnd record_stage(RunPlan& plan, const RunOptions& options, const fs::path& directory,
                      const Interrupts& interrupts, const Checkpoint* from, bool more,
                      SpanFile* spans) {
  const Scene& scene = plan.scene;
  Placement& placement = plan.placement;
  const UnitSystem& units = plan.document.units();
  const SystemClock clock;
  const ClosedForm* form = plan.valid.form ? &*plan.valid.form : nullptr;
  BodyMeter meter(placement.bodies.size());
  const std::vector<std::unique_ptr<Subdomain>> bodies =
      metered(placement.pointers(), meter, spans);
  MeasureRecorder recorder(form, scene.output.force_filter, scene.output.steady_after);
  CsvHistory history(directory, form, units, opening_of(from, "history"));
  EventLog events(directory, opening_of(from, "events"));
  Summary summary(directory,
                  {scene.meta.title, versions(), scene.meta.expect, options.began,
                   plan.valid.estimate, declared_units(scene.units), &meter.waited_seconds()},
                  recorder, form);
  ProgressLine progress(clock, isatty(STDERR_FILENO) == 1 && !options.quiet, meter.waited_seconds(),
                        units.word("s"));
  ProgressFile to_monitor(directory, progress_heading(plan, options, more), meter, clock);
  RunTable table;
  std::vector<Observer*> observers{&recorder, &history, &events, &progress, &table};
  std::optional<VtkFields> fields;
  if (const std::optional<FieldOutputSpec>& wanted = scene.output.field_output)
    observers.push_back(&fields.emplace(directory, placement.pointers(), wanted->every,
                                        opening_of(from, "fields")));
  std::optional<MeasureHistory> measured;
  if (const std::optional<MeasuresOutputSpec>& wanted = scene.output.measures)
    observers.push_back(&measured.emplace(directory, placement.pointers(), wanted->of,
                                          wanted->every, units,
                                          opening_of(from, "measure_history")));
  if (spans != nullptr) observers.push_back(spans);
  // A summary says "completed" when all other files are.
  observers.insert(observers.end(), {&summary, &to_monitor});
  std::vector<Subdomain*> pointers;
  for (const std::unique_ptr<Subdomain>& body : bodies) pointers.push_back(body.get());
  Controller controller(scene, pointers, observers, &interrupts.asked);
  trace(spans, plan, options, controller);
  Checkpoints checkpoints({directory, scene.output.checkpoint, more,
                           resolved_text(scene, plan.document), swapped_bodies(plan.document)},
                          pointers, observers, clock);
  grant_patience(options.grace, !options.quiet);
  const RunEnd end = conduct(controller, checkpoints, from, directory);
  // Bodies in the middle of a solve hear no orderly end; they are ended when the launch goes.
  if (placement.launch && end.status != "interrupted") placement.launch->finish();
  const bool completed = summary.status() == "completed";
  if (more && completed) return {0, true};
  const int code = report(plan, options, directory, recorder.measures(), end, table,
                          meter.waited_seconds(), summary.status(), checkpoints.latest());
  return {interrupt_exit_code() != 0 ? interrupt_exit_code() : code, completed};
}

/// Bodies that are lost again where they were lost before are not waited for without end.
class Restarts {
 public:
  bool allowed(double time) {
    constexpr int most_without_progress = 3;
    count_ = last_ && *last_ == time ? count_ + 1 : 1;
    last_ = time;
    return count_ <= most_without_progress;
  }

 private:
  std::optional<double> last_;  // [s] of the checkpoint
  int count_ = 0;
};

}  // namespace

namespace {

/// The scene that a run keeps lies in another folder, and its stages mean the same mesh files.
ResolvedYaml::Placed placed_by(const Document& document) {
  return [folder = fs::absolute(document.name()).parent_path()](const std::string& key,
                                                                const std::string& text) {
    static const std::regex files(
        R"(stages\.[^.]+\.bodies\.[^.]+\.model\.[^.]+\.mesh\.[^.]+\.file)");
    return std::regex_match(key, files) ? (folder / text).string() : text;
  };
}

}  // namespace

/// With all that a scene leaves to defaults: where a run goes on, its scene says them all, but what
/// a stage to come repeats stays as it was written.
std::vector<std::string> swapped_bodies(const Document& document) {
  const std::optional<Document> next = document.next_stage();
  std::vector<std::string> names;
  if (!next) return names;
  const auto keys_of_bodies = [](const Document& stage) {
    ResolvedYaml resolved(stage.units());
    resolve_body_keys(read_scene(stage), stage, resolved);
    return resolved.text();
  };
  const std::vector<Difference> changed =
      differences(keys_of_bodies(document), keys_of_bodies(*next));
  for (const std::string& name : document.keys("bodies")) {
    const std::string model = join_path(join_path("bodies", name), "model");
    const auto below = [&model](const Difference& change) {
      return change.key == model || change.key.starts_with(model + ".");
    };
    if (std::ranges::any_of(changed, below)) names.push_back(name);
  }
  return names;
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
  if (document.has("stages")) resolved.copy("stages", document, placed_by(document));
  return text + resolved.text();
}

RunPlan plan_run(Document document, const RunOptions& options, const Interrupts& interrupts,
                 std::optional<double> begin) {
  RunPlan plan{std::move(document), {}, {}, {}};
  plan.scene = read_all_keys(plan.document);
  plan.scene.time.begin = begin.value_or(plan.scene.time.begin);
  if (options.awaited) {
    assign_roles(plan.scene, plan.document, true);
    check_awaited(*options.awaited, options.insecure);
  } else if (!options.local) {
    check_processes(plan.scene, plan.document);
    check_programs(plan.scene, plan.document);
    check_endpoint(plan.scene, plan.document, options.insecure);
  }
  in_units_of(plan.scene, [&] {
    plan.placement =
        place(plan.scene, plan.document, options.local, interrupts.at_once, options.awaited);
    plan.valid = validate_all(plan.scene, plan.document, plan.placement, !options.local);
  });
  return plan;
}

int record_run(RunPlan plan, const RunOptions& options, RunDirectory& held,
               const Interrupts& interrupts, std::optional<Checkpoint> from) {
  std::vector<std::string> warnings;
  Restarts restarts;
  std::optional<SpanFile> spans;
  if (options.trace) spans.emplace(held.new_trace());
  for (;;) {
    std::optional<Document> next = plan.document.next_stage();
    bool lost = false;
    try {
      const StageEnd end =
          record_stage(plan, options, held.path(), interrupts, from ? &*from : nullptr,
                       next.has_value(), spans ? &*spans : nullptr);
      if (!end.completed || !next) return end.code;
    } catch (const LostBody& error) {
      const bool restarts_it = plan.scene.network.on_lost_body == OnLostBody::restart;
      if (!restarts_it || interrupts.asked || !held.has_checkpoint()) throw;
      from = read_checkpoint(held.path(), warnings);
      if (!restarts.allowed(from->time)) throw;
      log_warning(
          fmt::format("{}: all bodies go on from {:.6g} s", error.what_is_wrong, from->time));
      // Lost at the very end of a stage: that one is over.
      lost = !from->stage_ends || from->scene != resolved_text(plan.scene, plan.document);
    }
    plan.placement = {};  // ends the processes before others of their names begin
    if (!lost) from = read_checkpoint(held.path(), warnings);
    if (!lost) log_info(fmt::format("next stage, from {:.6g} s", from->time));
    held.go_on();
    const double begin = from->stage_ends ? from->time : plan.scene.time.begin;
    plan = plan_run(lost ? std::move(plan.document) : std::move(*next), options, interrupts, begin);
  }
}

}  // namespace abut
