#include "coordinator/verbs/check.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/unit_words.hpp"
#include "coordinator/body_table.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/prediction.hpp"
#include "coordinator/probed_run.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/trust.hpp"
#include "coordinator/unit_doubts.hpp"
#include "coordinator/verbs/placed_scene.hpp"
#include "coordinator/wanted_fit.hpp"

namespace abut {

namespace {

constexpr double mebibyte = 1024.0;       // in kB
constexpr double coordinator_mib = 12.0;  // of a coordinator that has no kernels yet, measured

/// A line of /proc/<pid>/status [MiB]: VmHWM, the most there was, or VmRSS; 0: the process is gone.
double memory_of(const std::string& process, const std::string& line) {
  std::ifstream status("/proc/" + process + "/status");
  for (std::string text; std::getline(status, text);)
    if (text.starts_with(line + ":")) return std::stod(text.substr(line.size() + 1)) / mebibyte;
  return 0.0;
}

/// Whether something presses for good: weight, loads, statics, or what is moved as the scene says.
bool lasting(const Scene& scene, const Document& document,
             const std::vector<const Description*>& bodies) {
  const auto loaded = [&document](const auto& body) {
    const std::string path = "bodies." + body.first;
    for (const char* key : {".body_force", ".loads", ".constraints", ".model.rigid_tool.way",
                            ".model.rigid_tool.turn"})
      if (document.has(path + key)) return true;
    return false;
  };
  return std::ranges::any_of(scene.bodies, loaded) ||
         std::ranges::any_of(bodies, [](const Description* b) { return b->quasi_static; });
}

ContactOutlook outlook_of(const Scene& scene, const Document& document, const Estimate& estimate,
                          const std::vector<const Description*>& bodies) {
  ContactOutlook outlook;
  outlook.possible = scene.everything() != nullptr;
  for (const auto& [name, interface] : scene.interfaces) {
    outlook.tied = outlook.tied || interface.tied.has_value();
    outlook.possible = outlook.possible || !interface.tied;
  }
  outlook.lasting = lasting(scene, document, bodies);
  outlook.sweeps = static_cast<int>(estimate.sweeps);
  return outlook;
}

/// Why a run cannot be tried; empty: it can.
std::string why_no_probe(const Scene& scene) {
  for (const auto& [name, body] : scene.bodies) {
    if (body.external) return fmt::format("body '{}' is of another program", name);
    if (std::holds_alternative<ConnectLaunch>(body.launch))
      return fmt::format("body '{}' is started by somebody else", name);
  }
  return "";
}

/// Runs the scene for a moment, as `abut run` would, and tells what all of it will take.
std::string predicted(const Scene& scene, const Document& document, const Estimate& estimate,
                      double seconds) {
  const std::atomic<bool>& interrupted = watch_for_interrupts().asked;
  std::atomic<bool> stop = false;
  const double before = memory_of("self", "VmRSS");
  const auto began = std::chrono::steady_clock::now();
  const Placement placement = place(scene, document, false, stop);
  const std::chrono::duration<double> startup = std::chrono::steady_clock::now() - began;
  const std::vector<const Description*> bodies = placement.descriptions();
  const ContactOutlook outlook = outlook_of(scene, document, estimate, bodies);
  const ProbedRun probe = probe_run(scene, placement.pointers(), seconds, stop, interrupted,
                                    outlook.possible && !outlook.tied);
  if (interrupt_exit_code() != 0) return "";
  double memory = coordinator_mib + std::max(0.0, memory_of("self", "VmRSS") - before);
  const std::vector<std::int64_t> processes = placement.launch->process_ids();
  for (const std::int64_t id : processes) memory += memory_of(std::to_string(id), "VmHWM");
  if (!probe.failure.empty())
    return fmt::format("  time       the run fails at {:.4g} {}: {}\n", probe.reached,
                       document.units().word("s"), probe.failure);
  const std::optional<Prediction> prediction =
      predict(probe, scene.time.end, startup.count(), outlook);
  if (!prediction)
    return fmt::format(
        "  time       not predicted: no window has ended in {:.2g} s; give a longer --probe\n",
        probe.wall);
  std::vector<std::string> names;
  for (const Description* body : bodies) names.push_back(body->name);
  return to_text(*prediction, probe, scene.time.end, memory, processes.size() + 1) +
         fmt::format("  dear       {}\n", dear_words(probe, names));
}

std::string prediction_text(const Scene& scene, const Document& document, const Estimate& estimate,
                            double seconds) {
  const std::string why = why_no_probe(scene);
  if (!why.empty()) return fmt::format("  time       not predicted: {}\n", why);
  try {
    return predicted(scene, document, estimate, seconds);
  } catch (const RunError& error) {  // the scene is valid all the same
    return fmt::format("  time       not predicted: {}\n", error.what());
  }
}

/// Builds the bodies of a scene, or of a stage that follows one, here, and prints what the run will
/// be.
Estimate print_outlook(const std::string& what, const Scene& scene, const Document& document,
                       bool verbose, bool follows) {
  Placement here{nullptr, {}};
  Estimate estimate;
  in_units_of(scene, [&] {
    here.bodies = launch_local(scene, document);
    estimate = validate_all(scene, document, here, true).estimate;
  });
  if (!follows) check_nothing_before(scene);
  const std::vector<const Description*> bodies = here.descriptions();
  const std::vector<std::optional<BodyFacts>> facts = local_facts(scene, document);
  fmt::print("{}: valid\n{}", what,
             quantities_in(declared_units(scene.units), to_text(estimate, verbose)));
  fmt::print("{}", in_words_of(document.units(), body_table(bodies, facts)));
  for (const InputError& doubt : unit_doubts(bodies, facts, document))
    fmt::print("warning: {}\n", doubt.what());
  return estimate;
}

/// What follows the scene; true: something does.
bool print_stages(const Document& document, bool verbose) {
  std::optional<Document> stage = document.next_stage();
  if (!stage) return false;
  for (; stage; stage = stage->next_stage()) {
    const Scene scene = read_scene(*stage);
    print_outlook(fmt::format("{}, from {:.6g} {}", stage->name(), scene.time.begin,
                              document.units().word("s")),
                  scene, *stage, verbose, true);
  }
  return true;
}

}  // namespace

int check_verb(const CheckCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  check_processes(scene, document);
  check_programs(scene, document);
  const Estimate estimate = print_outlook(command.scene, scene, document, command.verbose, false);
  const bool staged = print_stages(document, command.verbose);
  if (command.probe <= 0.0) return 0;
  if (isatty(STDOUT_FILENO) == 1) std::fflush(stdout);  // the probe takes a moment
  fmt::print("{}", prediction_text(scene, document, estimate, command.probe));
  if (staged)
    fmt::print(
        "  stages     time and memory are those of the first one: the others begin where it "
        "ends, and are not tried\n");
  return interrupt_exit_code();
}

}  // namespace abut
