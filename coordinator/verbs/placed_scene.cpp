#include "coordinator/verbs/placed_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/unit_words.hpp"
#include "coordinator/couple.hpp"
#include "coordinator/external_body.hpp"
#include "coordinator/frame_check.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/record/measure_names.hpp"
#include "coordinator/record/recorded_bodies.hpp"
#include "coordinator/tied_estimate.hpp"

namespace abut {

namespace {

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
    Bodies bodies(placement.pointers(), scene.time.window);
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

/// Of bodies that are not known yet the run will tell.
void validate_measures(const Scene& scene, std::span<const Description* const> bodies,
                       const Document& document) {
  if (!scene.output.measures || std::ranges::find(bodies, nullptr) != bodies.end()) return;
  const std::vector<std::string> told = told_measures(bodies);
  const std::vector<std::string>& of = scene.output.measures->of;
  for (std::size_t i = 0; i < of.size(); ++i)
    if (std::ranges::find(told, of[i]) == told.end())
      throw InputError(fmt::format("names '{}', which no body tells", of[i]),
                       document.where(fmt::format("output.measures.of[{}]", i)),
                       told.empty() ? "Leave it out: no body of this scene tells measures."
                                    : nearest_measures(of[i], told));
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

}  // namespace

Placement place(const Scene& scene, const Document& document, bool local,
                const std::atomic<bool>& interrupted, const std::optional<Awaited>& awaited) {
  Placement placement;
  if (local) {
    refuse_external_bodies(scene, document);
    placement.bodies = launch_local(scene, document, &interrupted);
    return placement;
  }
  LaunchOptions options;
  options.interrupted = &interrupted;
  options.awaited = awaited;
  const Specification text{document.name(), document.text(), document.overrides_elsewhere(), ""};
  placement.launch = std::make_unique<Launch>(scene, text, options);
  placement.bodies = placement.launch->take_bodies();
  return placement;
}

namespace {

/// Programs that are named from the folder of this process are so wherever the run goes on; a name
/// without a slash is looked for on the PATH.
void name_whole_programs(Scene& scene) {
  for (auto& [name, entry] : scene.bodies) {
    std::string* program = nullptr;
    if (SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch)) program = &spawn->program;
    if (GroupLaunch* group = std::get_if<GroupLaunch>(&entry.launch)) program = &group->program;
    if (program != nullptr && program->find('/') != program->npos)
      *program = std::filesystem::absolute(*program).lexically_normal().string();
  }
}

}  // namespace

Scene read_all_keys(const Document& document) {
  InputErrors errors;
  Scene scene = read_scene(document, errors);
  errors.gather([&] { check_body_keys(scene, document); });
  errors.raise();
  check_units(document);
  if (const std::optional<Document> stage = document.next_stage()) read_all_keys(*stage);
  name_whole_programs(scene);
  return scene;
}

void in_units_of(const Scene& scene, const std::function<void()>& set_up) {
  const std::map<std::string, std::string> words = declared_units(scene.units);
  const auto told = [&words](const InputError& error) {
    return InputError(quantities_in(words, error.what_is_wrong), error.where,
                      quantities_in(words, error.remedy));
  };
  try {
    set_up();
  } catch (const InputErrorList& errors) {
    std::vector<InputError> all;
    std::ranges::transform(errors.all, std::back_inserter(all), told);
    throw InputErrorList(std::move(all));
  } catch (const InputError& error) {
    throw told(error);
  }
}

Validated validate_all(const Scene& scene, const Document& document, const Placement& placement,
                       bool processes) {
  const std::vector<const Description*> bodies = placement.descriptions();
  validate_bodies(scene, bodies, document);
  validate_measures(scene, bodies, document);
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

void validate_stages(const Document& document) {
  for (std::optional<Document> stage = document.next_stage(); stage; stage = stage->next_stage()) {
    const Scene scene = read_scene(*stage);
    in_units_of(scene, [&] {
      Placement here{nullptr, launch_local(scene, *stage)};
      validate_all(scene, *stage, here, true);
    });
  }
}

}  // namespace abut
