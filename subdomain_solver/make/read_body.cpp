#include "subdomain_solver/make/read_body.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "subdomain_solver/make/mesh.hpp"

namespace abut {

namespace {

/// Of a scene's file, with a slash at its end; empty: the folder of the process.
std::string folder_of(const Document& scene) {
  return scene.name().substr(0, scene.name().rfind('/') + 1);
}

}  // namespace

BodySpec read_body(const Document& scene, const std::string& path, const BodyContext& context) {
  BodySpec spec;
  spec.context = context;
  read_fields(scene, path, [&spec](Fields& f) { spec.fields(f); });
  return spec;
}

BodySpec placed_body(const Document& scene, const std::string& path, const BodyContext& context) {
  BodySpec spec = read_body(scene, path, context);
  spec.place_files(folder_of(scene));
  return spec;
}

std::optional<BodySpec> read_keys(const Document& scene, const std::string& path) {
  BodySpec spec;
  try {
    read_fields(scene, path, [&spec](Fields& f) { spec.keys(f); });
  } catch (const InputError&) {
    return std::nullopt;
  }
  return spec;
}

std::optional<BodySpec> read_partner(const PortPartner& partner, const Document& scene) {
  if (partner.keys.empty()) return std::nullopt;
  BodyContext context;
  context.mesh_digest = partner.mesh_digest;
  try {
    return placed_body(Document::from_text(scene.name(), partner.keys), "bodies." + partner.body,
                       context);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::uint64_t mesh_digest(BodySpec spec, const Document& scene) {
  spec.place_files(folder_of(scene));
  const SolidShapeSpec* shape = spec.shape();
  if (shape == nullptr) return 0;
  const auto digest = [](const auto& mesh) -> std::uint64_t {
    if constexpr (requires { mesh.file; }) {
      return digest_of(mesh);
    } else {
      return 0;
    }
  };
  try {
    return std::visit(digest, shape->mesh);
  } catch (const InputError&) {
    return 0;
  }
}

}  // namespace abut
