#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}

namespace abut {

class YamlTree;

struct NextStage {
  std::string name, text;
};

/// The scene that follows a scene with `stages`: its keys, those of the first stage over them (maps
/// key by key, anything else as a whole, a choice of another name instead), begin where this one
/// ends, without the event that ends this one (time.until), and the stages after that one. Of
/// bodies that move in it and stood in statics before, initial.after_statics is true. Nothing: no
/// stage follows.
std::optional<NextStage> next_stage(const YAML::Node& scene);

/// Where a file has what the scene of one of its stages has.
class StageOrigin {
 public:
  /// `scene`: of the file, whose name this is.
  StageOrigin(const YAML::Node& scene, std::string file);
  /// A stage that follows those that were added before.
  void add(std::string stage) { stages_.push_back(std::move(stage)); }
  /// "scene.yaml:30: bodies.left (stage blow)": in the latest stage that has most of the path, or
  /// in the scene itself. `shown`: the path, for people.
  std::string place_of(std::span<const std::string> path, std::string_view shown) const;

 private:
  std::shared_ptr<const YamlTree> scene_;
  std::string file_;
  std::vector<std::string> stages_;
};

}  // namespace abut
