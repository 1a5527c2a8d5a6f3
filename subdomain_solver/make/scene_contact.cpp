#include "subdomain_solver/make/scene_contact.hpp"

#include <algorithm>
#include <set>

#include "base/fields.hpp"
#include "base/yaml_fields.hpp"
#include "subdomain_solver/make/interface_sides.hpp"

namespace abut {

namespace {

/// Of an interface's transmission, which the coordinator reads whole.
struct KinematicSpec {
  std::string kinematic;
  void fields(Fields& f) {
    f.optional("kinematic", kinematic, "", "side that finds the contact");
    f.ignore_rest();
  }
};

/// Of a scheme and of a port, what tells whether a node can be shared.
struct StepSpec {
  double step = 0.0;
  void fields(Fields& f) {
    f.optional("step", step, "s", "of the scheme");
    f.ignore_rest();
  }
};
struct SharedSpec {
  bool tied = false;
  void fields(Fields& f) {
    f.optional("tied", tied, "", "its node is shared");
    f.ignore_rest();
  }
};

struct OverlapKeys {  // of an overlap
  bool doubled = false, motions = false, unstable = false;
  void fields(Fields& f) {
    f.word("material", doubled, {"halves", "doubled"}, "of both");
    f.word("exchange", motions, {"forces", "motions"}, "what passes");
    f.optional("unstable", unstable, "", "for comparisons");
    f.ignore_rest();
  }
};

struct Stepping {
  bool known = false, in_drifts = false;
  double step = 0.0;
  bool operator==(const Stepping&) const = default;
};

Stepping stepping_of(const Document& scene, const std::string& body) {
  const std::string path = "bodies." + body + ".integrator";
  for (const char* scheme : {"central_difference", "newmark", "hht_alpha", "generalized_alpha"}) {
    const std::string own = path + "." + scheme;
    if (scene.has(own)) return {true, own.ends_with("difference"), read<StepSpec>(scene, own).step};
  }
  return {};
}

bool shares(const Document& scene, const std::string& body, const std::string& port) {
  const std::string path = "bodies." + body + ".ports." + port;
  return scene.has(path) && read<SharedSpec>(scene, path).tied;
}

/// Bodies that share the node of a body's port.
std::vector<std::string> sharers(const Document& scene, const std::string& body,
                                 const std::string& port) {
  std::vector<std::string> out;
  if (!shares(scene, body, port) || !stepping_of(scene, body).known) return out;
  for (const std::string& name : scene.keys_with("interfaces", "sides", body + "." + port)) {
    const std::string path = "interfaces." + name;
    if (!scene.has(path + ".tied")) continue;
    for (const std::string& side : read<InterfaceSides>(scene, path).sides) {
      const std::size_t dot = side.find('.');
      if (side == body + "." + port || dot == std::string::npos) continue;
      const std::string other = side.substr(0, dot);
      if (stepping_of(scene, other).known && shares(scene, other, side.substr(dot + 1)))
        out.push_back(other);
    }
  }
  return out;
}

std::string kinematic_of(const Document& scene, const std::string& interface) {
  const std::string path = interface + ".transmission.unilateral";
  KinematicSpec spec;
  if (scene.has(path + ".kinematic")) spec = read<KinematicSpec>(scene, path);
  if (spec.kinematic == "auto") spec.kinematic.clear();
  return spec.kinematic;
}

}  // namespace

std::vector<SceneContact> contacts_of(const Document& scene, const std::string& body,
                                      const std::string& port) {
  std::vector<SceneContact> out;
  for (const std::string& name : scene.keys_with("interfaces", "sides", body + "." + port)) {
    const std::string path = "interfaces." + name;
    if (!scene.has(path + ".contact")) continue;
    const InterfaceSides interface = read<InterfaceSides>(scene, path);
    for (const std::size_t s : {0u, 1u}) {
      if (interface.sides[s] != body + "." + port) continue;
      const std::string& other = interface.sides[1 - s];
      const std::size_t dot = other.find('.');
      if (dot == std::string::npos) continue;
      out.push_back({name, other.substr(0, dot), other.substr(dot + 1),
                     scene.chooses(path + ".contact.rows", "point_to_surface"),
                     kinematic_of(scene, path)});
    }
  }
  return out;
}

std::optional<SceneOverlap> overlap_of(const Document& scene, const std::string& body,
                                       const std::string& port) {
  const std::string side = body + "." + port;
  for (const std::string& name : scene.keys_with("interfaces", "sides", side)) {
    const std::string path = "interfaces." + name;
    if (!scene.has(path + ".tied.overlap")) continue;
    const InterfaceSides interface = read<InterfaceSides>(scene, path);
    const std::string& other = interface.sides[interface.sides[0] == side ? 1 : 0];
    const std::size_t dot = other.find('.');
    if (dot == std::string::npos) continue;
    const OverlapKeys keys = read<OverlapKeys>(scene, path + ".tied.overlap");
    return SceneOverlap{name,
                        other.substr(0, dot),
                        other.substr(dot + 1),
                        interface.sides[0] == side,
                        !keys.doubled && !keys.motions,
                        keys.motions,
                        keys.unstable};
  }
  return std::nullopt;
}

bool joins(const Document& scene, const std::string& body, const std::string& port) {
  const std::vector<std::string> names = scene.keys_with("interfaces", "sides", body + "." + port);
  return std::ranges::any_of(names, [&scene](const std::string& name) {
    return scene.has("interfaces." + name + ".tied");
  });
}

bool row_steps_apart(const Document& scene, const std::string& body, const std::string& port) {
  if (sharers(scene, body, port).empty()) return false;
  // Along the row: a node of a body that joins another one by a force is joined so too.
  std::vector<std::string> row = {body};
  std::set<std::string> known = {body};
  while (!row.empty()) {
    const std::string here = row.back();
    row.pop_back();
    for (const std::string& end : scene.keys("bodies." + here + ".ports")) {
      for (const std::string& other : sharers(scene, here, end)) {
        if (stepping_of(scene, here) != stepping_of(scene, other)) return true;
        if (known.insert(other).second) row.push_back(other);
      }
    }
  }
  return false;
}

bool touches(const Document& scene, const std::string& body, const std::string& port) {
  const bool everything = scene.has("contact.everything") && !joins(scene, body, port);
  return everything || !contacts_of(scene, body, port).empty();
}

}  // namespace abut
