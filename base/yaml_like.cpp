#include "base/yaml_like.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_document.hpp"
#include "base/yaml_text.hpp"
#include "base/yaml_tree.hpp"
#include "base/yaml_values.hpp"

namespace abut {
namespace {

constexpr std::array<std::string_view, 8> like_choices = {
    "launch",   "model",      "model.*.mesh",  "model.*.contact",
    "material", "integrator", "contact_layer", "equations.linear"};

constexpr const char* name_another = "Name another body of the scene.";

using Pair = std::pair<YAML::Node, YAML::Node>;  // key and value
using Index = std::map<std::string, Pair>;

Index index_of(const YAML::Node& map) {
  Index entries;
  for (const auto& pair : map) entries.emplace(pair.first.Scalar(), Pair(pair.first, pair.second));
  return entries;
}

std::optional<YAML::Node> find(const YAML::Node& map, const std::string& key) {
  if (!map.IsMap()) return std::nullopt;
  for (const auto& pair : map)
    if (pair.first.Scalar() == key) return pair.second;
  return std::nullopt;
}

/// Keys of a body that none has from another one.
bool is_own(const std::string& key) { return key == "like" || key == "copies"; }

/// `path`: keys of a body.
bool chooses_one(const std::vector<std::string>& path) {
  return std::ranges::any_of(like_choices, [&path](std::string_view choice) {
    return std::ranges::equal(path, split_path(choice), [](const auto& key, const auto& step) {
      return step == "*" || step == key;
    });
  });
}

/// Bodies, while they are written out.
class Bodies {
 public:
  Bodies(const YAML::Node& bodies, const Where& where) : where_(where), written_(index_of(bodies)) {
    for (const auto& pair : bodies) names_.push_back(pair.first.Scalar());
  }

  YAML::Node whole() {
    InputErrors errors;
    for (const std::string& name : names_) errors.gather([&] { check_name(name); });
    errors.raise();
    YAML::Node all(YAML::NodeType::Map);
    for (const std::string& name : names_)
      all.force_insert(written_.at(name).first, whole_body(name));
    return all;
  }

 private:
  std::optional<YAML::Node> like_of(const std::string& name) const {
    return find(written_.at(name).second, "like");
  }
  std::string place_of(const std::string& name) const {
    return where_(fmt::format("bodies.{}.like", name));
  }

  void check_name(const std::string& name) const {
    const std::optional<YAML::Node> like = like_of(name);
    if (!like) return;
    if (!like->IsScalar())
      throw InputError(fmt::format("must be the name of a body, but is {}", describe(*like)),
                       place_of(name), name_another);
    if (like->Scalar() == name)
      throw InputError("is the body itself", place_of(name), name_another);
    if (!written_.contains(like->Scalar()))
      throw InputError(fmt::format("is {}, but there is no such body", like->Scalar()),
                       place_of(name), suggestion(like->Scalar(), names_, "Choose one of"));
  }

  YAML::Node whole_body(const std::string& name) {
    std::vector<std::string> chain = {name};  // each like the next, up to one that is known
    std::set<std::string> seen = {name};
    while (!done_.contains(chain.back())) {
      const std::optional<YAML::Node> like = like_of(chain.back());
      if (!like) {
        done_.emplace(chain.back(), written_.at(chain.back()).second);
      } else {
        if (!seen.insert(like->Scalar()).second) refuse_circle(chain, like->Scalar());
        chain.push_back(like->Scalar());
      }
    }
    for (std::size_t i = chain.size() - 1; i-- > 0;) {
      std::vector<std::string> path;
      const YAML::Node& like = done_.at(chain[i + 1]);
      const YAML::Node whole = merged(like, written_.at(chain[i]).second, path);
      count(whole);
      done_.emplace(chain[i], whole);
    }
    return done_.at(name);
  }

  /// What is shared is read once for every body that has it.
  void count(const YAML::Node& node) {
    if (++values_ > max_values)
      throw InputError("holds too many values, written out", where_("bodies"),
                       "Give large data in files of their own, such as meshes.");
    for (const auto& item : node) count(node.IsMap() ? item.second : item);
  }

  [[noreturn]] void refuse_circle(const std::vector<std::string>& chain,
                                  const std::string& again) const {
    const auto first = std::ranges::find(chain, again);
    throw InputError(
        fmt::format("leads round in a circle: {}, {}", fmt::join(first, chain.end(), ", "), again),
        place_of(again), "Write one of these bodies out.");
  }

  /// A body's own value at a path over the one that it has from another. Of copies: the library
  /// keeps what is shared by joining all that its owners hold.
  YAML::Node merged(const YAML::Node& inherited, const YAML::Node& own,
                    std::vector<std::string>& path) {
    if (!inherited.IsMap() || !own.IsMap()) return YAML::Clone(own);
    const Index mine = index_of(own), theirs = index_of(inherited);
    const bool other = mine.size() == 1 && !theirs.contains(mine.begin()->first);
    if (other && chooses_one(path)) return YAML::Clone(own);
    YAML::Node out(YAML::NodeType::Map);
    for (const auto& pair : inherited) {
      const std::string& key = pair.first.Scalar();
      if (path.empty() && is_own(key)) continue;
      const auto found = mine.find(key);
      if (found == mine.end()) {
        out.force_insert(YAML::Clone(pair.first), YAML::Clone(pair.second));
      } else if (!found->second.second.IsNull()) {
        path.push_back(key);
        out.force_insert(YAML::Clone(pair.first), merged(pair.second, found->second.second, path));
        path.pop_back();
      }
    }
    for (const auto& pair : own) {
      const std::string& key = pair.first.Scalar();
      if (path.empty() && key == "copies" && pair.second.IsNull()) continue;  // none, in words
      if (!theirs.contains(key) || (path.empty() && is_own(key)))
        out.force_insert(YAML::Clone(pair.first), YAML::Clone(pair.second));
    }
    return out;
  }

  const Where& where_;
  Index written_;
  std::vector<std::string> names_;
  std::map<std::string, YAML::Node> done_;
  std::size_t values_ = 0;
};

}  // namespace

std::span<const std::string_view> body_choices() { return like_choices; }

bool has_likes(const YAML::Node& scene) {
  const std::optional<YAML::Node> bodies = find(scene, "bodies");
  if (!bodies || !bodies->IsMap()) return false;
  return std::any_of(bodies->begin(), bodies->end(),
                     [](const auto& pair) { return find(pair.second, "like").has_value(); });
}

YAML::Node with_likes(const YAML::Node& scene, const Where& where) {
  YAML::Node out(YAML::NodeType::Map);
  for (const auto& pair : scene) {
    const bool bodies = pair.first.Scalar() == "bodies";
    out.force_insert(pair.first, bodies ? Bodies(pair.second, where).whole() : pair.second);
  }
  return out;
}

std::string origin_of(const YamlTree& scene, std::string_view path) {
  std::vector<std::string> steps = split_path(path);
  if (steps.size() < 3 || steps[0] != "bodies") return steps.size() < 2 ? "" : steps[1];
  const std::string own = steps[1];
  std::string origin = own;
  std::size_t most = 0;
  for (std::set<std::string> seen; seen.insert(steps[1]).second;) {
    const std::vector<Found> way = scene.walk(steps);
    if (way.size() < 2) break;
    if (way.size() > most || steps[1] == own) {
      most = way.size();
      origin = steps[1];
    }
    const std::optional<Found> like = child(way[1].node, "like");
    if (!like || !like->node.IsScalar()) break;
    steps[1] = like->node.Scalar();
  }
  return origin;
}

}  // namespace abut
