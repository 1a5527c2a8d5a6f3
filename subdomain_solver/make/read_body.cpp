#include "subdomain_solver/make/read_body.hpp"

#include "base/yaml_fields.hpp"
#include "subdomain_solver/make/scene_contact.hpp"

namespace abut {

BodySpec read_body(const Document& scene, const std::string& path) {
  BodySpec spec;
  const std::string name = path.substr(path.rfind('.') + 1);
  for (const std::string& port : scene.keys(path + ".ports"))
    spec.steps_apart = spec.steps_apart || row_steps_apart(scene, name, port);
  read_fields(scene, path, [&spec](Fields& f) { spec.fields(f); });
  return spec;
}

}  // namespace abut
