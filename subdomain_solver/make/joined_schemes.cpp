#include "subdomain_solver/make/joined_schemes.hpp"

#include <set>
#include <string>

#include "base/yaml_fields.hpp"
#include "base/yaml_resolved.hpp"
#include "subdomain_solver/make/body_spec.hpp"
#include "subdomain_solver/make/interface_sides.hpp"

namespace abut {

namespace {

struct Scheme {
  std::optional<BodySpec::Integrator> integrator;
  void fields(Fields& f) {
    f.choice("integrator", integrator, "in time");
    f.ignore_rest();
  }
};

}  // namespace

bool joined_bodies_step_alike(const Document& scene) {
  if (!scene.has("interfaces")) return true;
  std::set<std::string> ways;
  for (const std::string& name : scene.keys("interfaces")) {
    const std::string path = "interfaces." + name;
    if (!scene.has(path + ".tied")) continue;
    for (const std::string& side : read<InterfaceSides>(scene, path).sides) {
      const std::string body = "bodies." + side.substr(0, side.find('.'));
      if (scene.has(body)) ways.insert(to_yaml(read<Scheme>(scene, body)));
    }
  }
  return ways.size() <= 1;
}

}  // namespace abut
