#include "subdomain_solver/make/scene_contact.hpp"

#include <algorithm>
#include <array>

#include "base/fields.hpp"
#include "base/yaml_fields.hpp"

namespace abut {

namespace {

/// Of an interface what tells who meets; the rest is the coordinator's.
struct SidesSpec {
  std::array<std::string, 2> sides;
  void fields(Fields& f) {
    f.required("sides", sides, "", "two ports that meet, as body.port");
    f.ignore_rest();
  }
};

}  // namespace

bool touches(const Document& scene, const std::string& body, const std::string& port) {
  const std::vector<std::string> names = scene.keys("interfaces");
  return std::ranges::any_of(names, [&](const std::string& name) {
    const std::string path = "interfaces." + name;
    if (!scene.has(path + ".contact") || !scene.has(path + ".sides")) return false;
    const SidesSpec interface = read<SidesSpec>(scene, path);
    return std::ranges::find(interface.sides, body + "." + port) != interface.sides.end();
  });
}

}  // namespace abut
