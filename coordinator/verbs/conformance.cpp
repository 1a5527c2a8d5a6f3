#include "coordinator/verbs/conformance.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/log.hpp"
#include "coordinator/conformance/clauses.hpp"
#include "coordinator/conformance/wire_clauses.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/solver_processes.hpp"
#include "coordinator/trust.hpp"
#include "coordinator/verbs/placed_scene.hpp"

namespace abut {

namespace {

/// A scene of the body alone, where no scene is given.
Document document_of(const ConformanceCommand& command) {
  const std::string_view what = command.what;
  if (command.names_scene()) return Document::load(command.what, command.overrides);
  const bool endpoint = what.find("://") != std::string_view::npos;
  const std::string launch =
      endpoint ? "{connect: {}}" : fmt::format("{{spawn: {{program: \"{}\"}}}}", what);
  const std::string listen = endpoint ? fmt::format("endpoint: \"{}\", ", what) : "";
  return Document::from_text(
      "command line",
      fmt::format("time: {{end: {0:.17g}, window: {0:.17g}}}\n"
                  "bodies:\n  {1}:\n    launch: {2}\n    model: {{external: {3}}}\n"
                  "network: {{{4}request_deadline: {5:.17g}}}\n",
                  command.window, command.body, launch, command.keys, listen, command.deadline),
      command.overrides);
}

/// Why a new process goes on otherwise from what the body kept; empty: to the same bits.
std::string kept(BodyTrial& trial, const Scene& scene, const Document& document, std::size_t b,
                 const std::atomic<bool>& interrupted) {
  const auto somebody_elses = [](const auto& body) {
    return std::holds_alternative<ConnectLaunch>(body.second.launch);
  };
  if (std::ranges::any_of(scene.bodies, somebody_elses)) return "somebody else starts the process";
  const std::vector<std::byte> bytes = trial.body().checkpoint();
  const double from = trial.now();
  const Response one = trial.window(trial.length());
  const Placement other = place(scene, document, false, interrupted);
  BodyTrial again(*other.bodies[b], from, scene.time.window);
  other.bodies[b]->resume(bytes);
  const std::string difference = first_difference(one, again.window(again.length()), trial.about());
  other.launch->finish();
  if (difference.empty()) return "";
  throw BrokenClause("a window after it ends otherwise: " + difference,
                     "A checkpoint holds all that a step changes.");
}

/// The program of a body that this one starts; empty: somebody else does.
std::string program_of(const BodyEntry& entry) {
  if (may_run_elsewhere(entry)) return "";
  const SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch);
  const GroupLaunch* group = std::get_if<GroupLaunch>(&entry.launch);
  const std::string program = spawn != nullptr ? spawn->program : group->program;
  return program.empty() ? solver_beside_this_program() : program;
}

/// The wire, of every program once: with its first body.
void hold_wire(BodyTrial& trial, const Scene& scene, const Document& document, std::size_t b,
               const Wanted& wanted, std::set<std::string>& held, std::vector<Verdict>& verdicts) {
  const std::vector<std::string> names = names_of_wire_clauses();
  if (std::ranges::none_of(names, [&wanted](const auto& name) { return wants(wanted, name); }))
    return;
  const auto& [name, entry] = scene.bodies[b];
  const std::string program = program_of(entry);
  if (program.empty()) verdicts.push_back({"wire", "", true, "its process is not started here"});
  if (program.empty() || !held.insert(program).second) return;
  WireTrial::Solver solver{program,
                           name,
                           {document.name(), document.text(), document.overrides_elsewhere(),
                            "bodies." + name, entry.context},
                           Milliseconds(std::lround(1.0e3 * scene.network.request_deadline))};
  WireTrial::Pushed pushed{scene.time.begin, trial.step(), 4, 0, 0.0};
  try {
    for (int p = 0; p < static_cast<int>(trial.about().ports.size()) && pushed.force == 0.0; ++p) {
      pushed.port = p;
      pushed.force = trial.light_force(p);
    }
  } catch (const RunError&) {
    pushed.force = 0.0;  // a body that is gone, or answers no probe: its clauses have said so
  }
  hold_wire(solver, pushed, wanted, verdicts);
}

bool tell(const Description& body, const std::vector<Verdict>& verdicts) {
  fmt::print("{}: {}\n", body.name, body.model);
  bool all = true;
  for (const Verdict& verdict : verdicts) {
    const char* word = !verdict.kept ? "BROKEN" : verdict.words.empty() ? "kept" : "not asked";
    fmt::print("  {:12} {:10} {}\n", verdict.clause, word,
               verdict.kept && verdict.words.empty() ? verdict.says : verdict.words);
    all = all && verdict.kept;
  }
  return all;
}

/// Throws InputError.
void require_known(const Wanted& wanted) {
  std::vector<std::string> names = names_of_wire_clauses();
  names.emplace_back("checkpoint");
  for (const std::span<const Clause> clauses :
       {clauses_of_windows(), clauses_of_kernels(), clauses_of_speeds(), clauses_of_forces(),
        clauses_of_motion()})
    for (const Clause& clause : clauses) names.emplace_back(clause.name);
  for (const std::string& name : wanted)
    if (!wants(names, name))
      throw InputError(fmt::format("is no clause: {}", name), "--only",
                       fmt::format("Choose among {}.", fmt::join(names, ", ")));
}

/// What bodies that are alike in it need not be asked twice.
std::string kind_of(const Description& body) {
  std::string kind = fmt::format("{}|{}|{}|{}", body.model, body.dofs, body.mass, body.step);
  for (const Port& port : body.ports)
    kind += fmt::format("|{} of {}", port.name, port.geometry.count());
  return kind;
}

}  // namespace

int conformance_verb(const ConformanceCommand& command) {
  start_log("abut", LogLevel::error);
  require_known(command.only);
  const Interrupts interrupts = watch_for_interrupts();
  const Document document = document_of(command);
  const Scene scene = read_all_keys(document);
  if (command.names_scene()) check_programs(scene, document);  // else its user has just named it
  check_endpoint(scene, document, false);
  const Placement placement = place(scene, document, false, interrupts.asked);
  bool all = true;
  std::set<std::string> programs;
  std::map<std::string, std::string> bodies;  // by their kinds
  for (std::size_t b = 0; b < placement.bodies.size(); ++b) {
    const Description& body = placement.bodies[b]->describe();
    const auto [first, is_new] = bodies.emplace(kind_of(body), body.name);
    if (!is_new) {
      fmt::print("{}: as {}\n", body.name, first->second);
      continue;
    }
    BodyTrial trial(*placement.bodies[b], scene.time.begin, scene.time.window);
    std::vector<Verdict> verdicts;
    hold(clauses_of_windows(), command.only, trial, verdicts);
    // Before long flights: a body that loads have carried far off answers light forces by what is
    // rounded.
    hold(clauses_of_kernels(), command.only, trial, verdicts);
    hold(clauses_of_speeds(), command.only, trial, verdicts);
    hold(clauses_of_forces(), command.only, trial, verdicts);
    hold(clauses_of_motion(), command.only, trial, verdicts);
    if (wants(command.only, "checkpoint"))
      verdicts.push_back(judged("checkpoint",
                                "a new process goes on from a checkpoint to the same bits",
                                [&] { return kept(trial, scene, document, b, interrupts.asked); }));
    hold_wire(trial, scene, document, b, command.only, programs, verdicts);
    all = tell(body, verdicts) && all;
  }
  if (all) placement.launch->finish();
  return all ? 0 : 1;
}

}  // namespace abut
