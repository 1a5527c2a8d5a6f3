#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/build_info.hpp"
#include "base/denormals.hpp"
#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/log.hpp"
#include "base/unit_words.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/command_line.hpp"
#include "coordinator/controller.hpp"
#include "coordinator/estimate.hpp"
#include "coordinator/external_body.hpp"
#include "coordinator/external_verb.hpp"
#include "coordinator/frame_check.hpp"
#include "coordinator/init/init_files.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/json_schema.hpp"
#include "coordinator/launch.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/record/closed_form_table.hpp"
#include "coordinator/record/csv_history.hpp"
#include "coordinator/record/event_log.hpp"
#include "coordinator/record/expectations.hpp"
#include "coordinator/record/measure_recorder.hpp"
#include "coordinator/record/progress_line.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "coordinator/record/summary.hpp"
#include "coordinator/record/vtk_fields.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/split/split_scene.hpp"
#include "coordinator/tied_estimate.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr int exit_expectation = 1, exit_input = 2, exit_world = 3;

/// The bodies of a run and, when they live in other processes, what keeps those alive.
struct Placement {
  std::unique_ptr<Launch> launch;  // null: this process
  std::vector<std::unique_ptr<Subdomain>> bodies;

  /// Null: an external body that is not here.
  std::vector<const Description*> descriptions() const {
    std::vector<const Description*> all;
    for (const std::unique_ptr<Subdomain>& body : bodies)
      all.push_back(body != nullptr ? &body->describe() : nullptr);
    return all;
  }
  bool whole() const {
    return std::all_of(bodies.begin(), bodies.end(),
                       [](const std::unique_ptr<Subdomain>& body) { return body != nullptr; });
  }
  std::vector<Subdomain*> pointers() const {
    std::vector<Subdomain*> all;
    for (const std::unique_ptr<Subdomain>& body : bodies) all.push_back(body.get());
    return all;
  }
};

std::map<std::string, std::string> versions() {
  return {{"abut", build_version()},
          {"commit", std::string(build_info.commit)},
          {"protocol", fmt::format("{}", protocol_version)},
          {"compiler", __VERSION__}};
}

Placement place(const Scene& scene, const Document& document, bool local,
                const std::atomic<bool>& interrupted) {
  Placement placement;
  if (local) {
    refuse_external_bodies(scene, document);
    placement.bodies = launch_local(scene, document, &interrupted);
    return placement;
  }
  LaunchOptions options;
  options.interrupted = &interrupted;
  const Specification text{document.name(), document.text(), document.overrides_elsewhere(), ""};
  placement.launch = std::make_unique<Launch>(scene, text, options);
  placement.bodies = placement.launch->take_bodies();
  return placement;
}

/// Every expectation names a measure that a run of this scene reports.
void validate_expectations(const Scene& scene, const std::vector<const Description*>& bodies,
                           const Document& document) {
  MeasureScope scope;
  scope.dim = bodies.front()->dim;
  for (const RecordedBody& body : recorded_bodies(bodies)) scope.bodies.push_back(body.name);
  for (const auto& [name, interface] : scene.interfaces) {
    scope.interfaces.push_back(name);
    scope.ports.insert(scope.ports.end(), interface.sides.begin(), interface.sides.end());
  }
  if (scene.everything() != nullptr) scope.interfaces.emplace_back(everything_name);
  scope.filtered = scene.output.force_filter.has_value();
  scope.steady = scene.output.steady_after.has_value();
  scope.exact = exact_interfaces(scene);
  scope.told = told_measures(bodies);
  InputErrors errors;
  for (std::size_t i = 0; i < scene.meta.expect.size(); ++i) {
    try {
      require_measure(scene.meta.expect[i].measure, scope);
    } catch (const InputError& error) {
      errors.add({error.what_is_wrong, document.where(fmt::format("meta.expect[{}].measure", i)),
                  error.remedy});
    }
  }
  errors.raise();
}

/// Every interface can be joined as the scene says; tells what ties will pay for.
std::vector<Estimate::Ties> validate_coupling(const Scene& scene, const Placement& placement,
                                              const Document& document) {
  try {
    const Bodies bodies(placement.pointers(), scene.time.window);
    std::vector<Joint> joints = make_joints(scene, bodies);
    make_broad_phase(scene, joints, bodies);
    return estimate_ties(scene, joints, bodies);
  } catch (const InputError& error) {
    throw InputError(error.what_is_wrong, document.where(error.where), error.remedy);
  }
}

/// Numbers with units beside others that have none: of what, the scene must say.
void check_units(const Document& document) {
  const UnitsRead& read = document.units_read();
  if (document.declares_units() || read.with.empty() || read.without.empty()) return;
  std::string with = read.with;
  const bool named = !document.has(with) && document.says(with);  // a material, whose keys it has
  while (named && !document.has(with)) with.resize(with.rfind('.'));
  throw InputError(
      fmt::format("is a number without a unit, but {} {}", with,
                  named ? "stands for numbers with units" : "has one"),
      document.where(read.without),
      "Give it a unit, or say what numbers without one are in: units: SI, or units: mm t s.");
}

/// Scene and bodies are read by readers of their own: what both refuse is told at once.
Scene read_all_keys(const Document& document) {
  InputErrors errors;
  Scene scene = read_scene(document, errors);
  errors.gather([&] { check_body_keys(scene, document); });
  errors.raise();
  check_units(document);
  return scene;
}

/// Of the fields that a scene wants, by body.
std::vector<FieldSize> field_sizes(const Scene& scene, const Placement& placement) {
  std::vector<FieldSize> sizes(placement.bodies.size());
  for (std::size_t b = 0; scene.output.field_output && b < sizes.size(); ++b) {
    Subdomain* body = placement.bodies[b].get();
    if (body == nullptr || body->describe().fields.empty()) continue;
    const Grid grid = body->grid();
    sizes[b] = {grid.nodes(), grid.cells()};
  }
  return sizes;
}

/// What is known of a scene beside its keys.
struct Validated {
  std::optional<ClosedForm> form;
  Estimate estimate;
};

/// All that can be said of a scene with the bodies that are there. `processes`: what they send goes
/// in frames.
Validated validate_all(const Scene& scene, const Document& document, const Placement& placement,
                       bool processes) {
  const std::vector<const Description*> bodies = placement.descriptions();
  validate_bodies(scene, bodies, document);
  if (processes)
    check_frames(scene, bodies, field_sizes(scene, placement), Limits{}.frame_bytes, document);
  std::vector<Estimate::Ties> ties;
  if (placement.whole()) {
    ties = validate_coupling(scene, placement, document);
    validate_expectations(scene, bodies, document);
  }
  check_speeds(scene, document);
  Validated valid{make_closed_form(scene, bodies, document), {}};
  std::optional<double> contact;
  if (valid.form) contact = valid.form->contact_time();
  valid.estimate = estimate(scene, bodies, contact);
  valid.estimate.ties = std::move(ties);
  return valid;
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

/// The result for people; 0, or 1 when an expectation or the run failed.
int report(const Scene& scene, const ClosedForm* form, const Measures& measures, const RunEnd& end,
           const std::string& status, const fs::path& directory, bool quiet,
           const UnitSystem& units) {
  const std::vector<ExpectationResult> results = evaluate(scene.meta.expect, measures);
  bool pass = status == "completed";
  for (const ExpectationResult& result : results) pass = pass && result.pass;
  if (!quiet || (!pass && status != "interrupted")) {
    fmt::print("\n{}\n\n", scene.meta.title);  // apart from the log lines above
    if (status == "completed") fmt::print("{}", against_closed_form(form, measures, end, units));
    // A run cut short misses expectations for that reason alone.
    if (status == "completed" && !results.empty()) fmt::print("{}\n", to_table(results));
    fmt::print("{} after {:.3f} s: {} windows, {} of them in contact, {} exchanges\n", status,
               end.wall_seconds, end.windows, end.contact_windows, end.exchanges);
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

RunEnd conduct(const Scene& scene, const Placement& placement,
               const std::vector<Observer*>& observers, const std::atomic<bool>& interrupted,
               const fs::path& directory) {
  try {
    return Controller(scene, placement.pointers(), observers, &interrupted).run();
  } catch (const RunError& error) {
    throw with_place_of_files(error, directory);
  } catch (const InputError& error) {  // of a body: what it was given does not go together
    throw with_place_of_files(error, directory);
  }
}

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
    log_info(fmt::format("{}: {}", body->name, body->model));

  held.clear();
  write_whole(directory / "scene.resolved.yaml", resolved_text(scene, document));
  const ClosedForm* form = valid.form ? &*valid.form : nullptr;
  MeasureRecorder recorder(form, scene.output.force_filter, scene.output.steady_after);
  CsvHistory history(directory, form, document.units());
  EventLog events(directory);
  Summary summary(directory,
                  {scene.meta.title, versions(), scene.meta.expect, began, valid.estimate,
                   document.units().is_si() ? std::map<std::string, std::string>()
                                            : unit_words(document.units())},
                  recorder, form);
  ProgressLine progress(clock, isatty(STDERR_FILENO) == 1 && !command.quiet);
  std::vector<Observer*> observers{&recorder, &history, &events, &progress, &summary};
  std::optional<VtkFields> fields;
  if (const std::optional<FieldOutputSpec>& wanted = scene.output.field_output)
    observers.push_back(&fields.emplace(directory, placement.pointers(), wanted->every));

  const RunEnd end = conduct(scene, placement, observers, interrupted, directory);
  // Bodies in the middle of a solve hear no orderly end; they are ended when the launch goes.
  if (placement.launch && end.status != "interrupted") placement.launch->finish();
  const int code = report(scene, form, recorder.measures(), end, summary.status(), directory,
                          command.quiet, document.units());
  return interrupt_exit_code() != 0 ? interrupt_exit_code() : code;
}

int check_verb(const CheckCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  check_processes(scene, document);
  const Placement here{nullptr, launch_local(scene, document)};
  const Validated valid = validate_all(scene, document, here, true);
  fmt::print("{}: valid\n{}", command.scene, to_text(valid.estimate, command.verbose));
  return 0;
}

/// Where a divided scene goes when the command line does not say.
fs::path split_directory(const SplitCommand& command) {
  if (!command.out.empty()) return command.out;
  return fmt::format("{}_split_{}", fs::path(command.scene).stem().string(), command.bodies);
}

using NewFiles = std::vector<std::pair<fs::path, std::string>>;

/// In the order of the list; nothing where a file is in the way. `option`: that names the place.
void write_new(const NewFiles& files, bool force, const char* option) {
  for (const auto& [path, text] : files) {
    if (!force && fs::exists(fs::symlink_status(path)))
      throw InputError("is there already", path.string(),
                       fmt::format("Give another {}, or --force.", option));
  }
  for (const auto& [path, text] : files) {
    const fs::path directory = path.parent_path();
    std::error_code error;
    if (!directory.empty()) fs::create_directories(directory, error);
    if (error)
      throw InputError(fmt::format("cannot be made: {}", error.message()), directory.string(),
                       "Give a folder that can be written to.");
    write_whole(path, text);
  }
}

int split_verb(const SplitCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  const fs::path directory = split_directory(command);
  const SplitScene split = split_scene(document, scene, {command.bodies, command.body, directory});
  const fs::path written = directory / fs::path(command.scene).filename();
  NewFiles files;
  for (const auto& [name, text] : split.meshes) files.emplace_back(directory / name, text);
  files.emplace_back(written, split.scene);  // the last one: it needs the others
  write_new(files, command.force, "--out");
  for (const std::string& part : split.parts) fmt::print("{}\n", part);
  for (const auto& [measure, why] : split.left_out)
    fmt::print("left out: what is expected of {}: {}\n", measure, why);
  fmt::print("written: {}\n", written.string());
  return check_verb({written.string(), {}, false});
}

int init_verb(const InitCommand& command) {
  const InitFiles made = init_files({command.name, command.from, command.meshes});
  write_new(made.files, command.force, "name");
  for (const std::string& line : made.words) fmt::print("{}\n", line);
  for (const auto& [path, text] : made.files) fmt::print("written: {}\n", path.string());
  fmt::print("next: abut run {}\n", made.files.front().first.string());
  return 0;
}

int reference_verb(const ReferenceCommand& command) {
  Reference reference;
  reference.add<Scene>("The scene", "");
  document_body_keys(reference);
  if (command.json_schema) {
    fmt::print("{}", json_schema(reference));
  } else if (command.keys) {
    fmt::print("{}", reference.key_paths());
  } else if (!command.key.empty()) {
    fmt::print("{}", reference.part(command.key));
  } else {
    fmt::print(
        "# Keys of a scene file\n\nPrinted by `abut reference`. Units are named in SI; any other "
        "consistent set (mm, ms, kg, kN, GPa)\ndoes as well: no constant is built in. A choice is "
        "written `{{name: {{its keys}}}}`, or as the name alone when all its\nkeys have "
        "defaults, and a list of one as its value alone. What alternatives of a choice have in "
        "common stands once: `{{fe,modal}}` are "
        "these two, `*` is each of them.\n`abut reference KEY` prints a part, as "
        "`abut reference bodies.b.material`.\n\n"
        "`abut reference --json-schema > abut.schema.json` writes the same as a JSON Schema. With "
        "it an editor that has a YAML\nlanguage server completes and checks a scene whose first "
        "line is `# yaml-language-server: $schema=abut.schema.json`.\n\n{}",
        reference.markdown());
  }
  return 0;
}

struct Verbs {
  int operator()(const RunCommand& command) const { return run_verb(command); }
  int operator()(const CheckCommand& command) const { return check_verb(command); }
  int operator()(const SplitCommand& command) const { return split_verb(command); }
  int operator()(const InitCommand& command) const { return init_verb(command); }
  int operator()(const ReferenceCommand& command) const { return reference_verb(command); }
  int operator()(const ExternalCommand& command) const {
    become_external_verb(command.verb, command.arguments);
  }
  int operator()(const PrintCommand& command) const {
    std::fputs(command.text.c_str(), command.exit_code == 0 ? stdout : stderr);
    return command.exit_code;
  }
};

int fail(const std::exception& error, int code) {
  // Not fmt::print, which throws where nobody takes the message.
  std::fputs(fmt::format("error: {}\n", error.what()).c_str(), stderr);
  return interrupt_exit_code() != 0 ? interrupt_exit_code() : code;
}

/// What was printed has arrived: a full disk tells so here at the latest.
int delivered(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const char* why = errno != 0 ? std::strerror(errno) : "nobody takes it";
  throw RunError(fmt::format("cannot be written: {}", why), "standard output",
                 "Check that the output goes to a file or program that takes it.");
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const abut::FlushedDenormals flushed;  // also of threads that bodies start
  std::signal(SIGXFSZ, SIG_IGN);         // a file at the limit of its size is an error of writing
  try {
    return abut::delivered(std::visit(abut::Verbs{}, abut::parse_command_line(argc, argv)));
  } catch (const abut::InputErrorList& errors) {
    int code = abut::exit_input;
    const std::size_t most = std::min<std::size_t>(errors.all.size(), 20);  // that anybody reads
    for (std::size_t i = 0; i < most; ++i) code = abut::fail(errors.all[i], abut::exit_input);
    if (most < errors.all.size())
      std::fputs(fmt::format("and {} more\n", errors.all.size() - most).c_str(), stderr);
    return code;
  } catch (const abut::InputError& error) {
    return abut::fail(error, abut::exit_input);
  } catch (const std::bad_alloc&) {
    return abut::fail(abut::RunError("the memory is used up", "", "Give coarser meshes."),
                      abut::exit_world);
  } catch (const std::exception& error) {  // RunError, and what the library throws: memory, files
    return abut::fail(error, abut::exit_world);
  }
}
