#pragma once

#include <optional>
#include <string>

namespace YAML {
class Node;
}

namespace abut {

struct NextStage {
  std::string name, text;
};

/// The scene that follows a scene with `stages`: its keys, those of the first stage over them (maps
/// key by key, anything else as a whole, a choice of another name instead), begin where this one
/// ends, without the event that ends this one (time.until), and the stages after that one. Of
/// bodies that move in it and stood in statics before, initial.after_statics is true. Nothing: no
/// stage follows.
std::optional<NextStage> next_stage(const YAML::Node& scene);

}  // namespace abut
