#include "base/yaml_stages.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "base/yaml_document.hpp"
#include "base/yaml_like.hpp"
#include "base/yaml_tree.hpp"

namespace abut {
namespace {

/// Beside those of bodies, as body_choices() has them.
constexpr std::array<std::string_view, 3> stage_choices = {"schwarz.accelerator",
                                                           "output.checkpoint", "time.until"};

bool fits(const std::vector<std::string>& path, std::string_view pattern) {
  return std::ranges::equal(path, split_path(pattern), [](const auto& step, const auto& part) {
    return part == "*" || step == part;
  });
}

bool is_stage_choice(const std::vector<std::string>& path) {
  const auto here = [&path](std::string_view choice) { return fits(path, choice); };
  if (std::ranges::any_of(stage_choices, here)) return true;
  return std::ranges::any_of(body_choices(), [&path](std::string_view choice) {
    return fits(path, "bodies.*." + std::string(choice));
  });
}

/// A body that solves no equations any more has no settings of them: the stage before had.
bool is_explicit(const YAML::Node& body) {
  const std::optional<Found> integrator = child(body, "integrator");
  return integrator && child(integrator->node, "central_difference");
}

/// A body of another rung that has no equations to solve, and no surface without mass.
bool is_reduced(const YAML::Node& body) {
  const std::optional<Found> model = child(body, "model");
  return model && (child(model->node, "rigid") || child(model->node, "modal"));
}

/// A body that goes on as another one moves and is displaced as that one: its place alone stays.
YAML::Node placed(const YAML::Node& initial) {
  if (!initial.IsMap()) return initial;
  YAML::Node out(YAML::NodeType::Map);
  for (const auto& pair : initial) {
    const std::string& key = pair.first.Scalar();
    if (key == "velocity" || key.ends_with("_field")) continue;
    out.force_insert(pair.first, pair.second);
  }
  return out;
}

bool is_static(const YAML::Node& body) {
  const std::optional<Found> integrator = child(body, "integrator");
  return integrator && child(integrator->node, "quasi_static");
}

/// Bodies that move now and stood in statics before are told so: overlaps are pressed in there.
void mark_after_statics(const YAML::Node& scene, YAML::Node& out) {
  const std::optional<Found> bodies = child(scene, "bodies");
  if (!bodies || !bodies->node.IsMap()) return;
  for (const auto& pair : bodies->node) {
    const std::optional<Found> now = child(out["bodies"], pair.first.Scalar());
    if (!now || !now->node.IsMap() || !is_static(pair.second) || is_static(now->node)) continue;
    YAML::Node body = now->node;
    if (!body["initial"].IsMap()) body["initial"] = YAML::Node(YAML::NodeType::Map);
    body["initial"]["after_statics"] = true;
  }
}

YAML::Node merged(const YAML::Node& before, const YAML::Node& own, std::vector<std::string>& path) {
  if (!before.IsMap() || !own.IsMap()) return own;
  const bool other = own.size() == 1 && !child(before, own.begin()->first.Scalar());
  if (other && is_stage_choice(path)) return own;
  YAML::Node out(YAML::NodeType::Map);
  for (const auto& pair : before) {
    const std::string& key = pair.first.Scalar();
    if (path.empty() && key == "stages") continue;
    const std::optional<Found> mine = child(own, key);
    if (mine && mine->node.IsNull()) continue;
    if (!mine && path.size() == 2 && key == "equations" && is_explicit(own)) continue;
    if (!mine && path.size() == 2 && (key == "equations" || key == "contact_layer") &&
        is_reduced(own))
      continue;
    const bool taken_over =
        path.size() == 2 && path[0] == "bodies" && key == "initial" && child(own, "model");
    const YAML::Node theirs = taken_over ? placed(pair.second) : pair.second;
    path.push_back(key);
    out.force_insert(pair.first, mine ? merged(theirs, mine->node, path) : theirs);
    path.pop_back();
  }
  for (const auto& pair : own)
    if (!child(before, pair.first.Scalar())) out.force_insert(pair.first, pair.second);
  return out;
}

}  // namespace

std::optional<NextStage> next_stage(const YAML::Node& scene) {
  const std::optional<Found> stages = child(scene, "stages");
  if (!stages || !stages->node.IsMap() || stages->node.size() == 0) return std::nullopt;
  YAML::Node first, rest(YAML::NodeType::Map);
  std::string name;
  for (const auto& pair : stages->node) {
    if (name.empty()) {
      name = pair.first.Scalar();
      first.reset(pair.second);
    } else {
      rest.force_insert(pair.first, pair.second);
    }
  }
  std::vector<std::string> path;
  // A copy: what is shared with the scene at hand must not change there.
  YAML::Node out = YAML::Clone(merged(scene, first, path));
  if (const std::optional<Found> time = child(scene, "time"))
    if (const std::optional<Found> end = child(time->node, "end"); end && out["time"].IsMap())
      out["time"]["begin"] = YAML::Clone(end->node);
  // An event ends the stage that waits for it, and no other one.
  const std::optional<Found> own = child(first, "time");
  if (out["time"].IsMap() && !(own && child(own->node, "until"))) out["time"].remove("until");
  mark_after_statics(scene, out);
  if (rest.size() > 0) out["stages"] = YAML::Clone(rest);
  return NextStage{name, YAML::Dump(out)};
}

StageOrigin::StageOrigin(const YAML::Node& scene, std::string file)
    : scene_(std::make_shared<YamlTree>(scene)), file_(std::move(file)) {}

std::string StageOrigin::place_of(std::span<const std::string> path, std::string_view shown) const {
  std::size_t most = 0;
  int line = 0;
  const auto look = [&](std::vector<std::string> steps) {
    const std::size_t above = steps.size();
    steps.insert(steps.end(), path.begin(), path.end());
    const std::vector<Found> way = scene_->walk(steps);
    if (way.size() <= above + most) return;
    most = way.size() - above;
    line = way.back().line;
  };
  for (auto stage = stages_.rbegin(); stage != stages_.rend(); ++stage) look({"stages", *stage});
  look({});
  const std::string where = line > 0 ? fmt::format("{}:{}", file_, line) : file_;
  return fmt::format("{}: {} (stage {})", where, shown, stages_.back());
}

}  // namespace abut
