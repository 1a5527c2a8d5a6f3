// A random scene as a scene file and its meshes.

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tests/random/random_scene.hpp"

namespace abut {

namespace {

using Kind = RandomBody::Kind;

std::string list(const Eigen::Vector3d& x, int dim) {
  std::vector<std::string> words;
  for (int i = 0; i < dim; ++i) words.push_back(fmt::format("{:.17e}", x(i)));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

/// Turned and scaled places of a mesh's nodes.
std::string map_of(const Eigen::Matrix3d& m, int dim) {
  std::vector<std::string> rows;
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < dim; ++i) {
    std::string row;
    for (int j = 0; j < dim; ++j)
      row += fmt::format("{}({:.17e}) * {}", j == 0 ? "" : " + ", m(i, j), axes[j]);
    rows.push_back("\"" + row + "\"");
  }
  return fmt::format("map: [{}]", fmt::join(rows, ", "));
}

std::string material_of(const RandomBody& body, const View& view) {
  const double pressure = view.mass / view.length;  // as of a force per area: kg / (m s^2)
  std::string more;
  if (body.law == "j2_plasticity")
    more = fmt::format(", yield_stress: {:.17e}, hardening: {:.17e}", body.yield * pressure,
                       0.02 * body.modulus * pressure);
  return fmt::format("{}: {{youngs_modulus: {:.17e}, poissons_ratio: {:.17e}, density: {:.17e}{}}}",
                     body.law, body.modulus * pressure, body.ratio,
                     body.density * view.mass / (view.length * view.length * view.length), more);
}

std::string body_text(const RandomScene& scene, const RandomBody& body, const View& view) {
  const int dim = scene.dim;
  const char* const model = body.kind == Kind::rigid  ? "rigid"
                            : body.kind == Kind::tool ? "rigid_tool"
                                                      : "fe";
  const Shape& shape = body.shape;
  const std::string mesh =
      shape.generator.empty() ? fmt::format("gmsh: {{file: {}.msh}}", body.name) : shape.generator;
  const Eigen::Matrix3d turn = view.length * view.turn * body.turn;
  std::string way;
  if (body.kind == Kind::tool && !body.velocity.isZero()) {
    const Eigen::Vector3d v = view.length * view.turn * body.velocity;
    std::vector<std::string> rows;
    for (int i = 0; i < dim; ++i) rows.push_back(fmt::format("\"({:.17e}) * t\"", v(i)));
    way = fmt::format("    way: [{}]\n", fmt::join(rows, ", "));
  }
  std::string keys = fmt::format("dimension: {}, {}, mesh: {{{}}}", dim, map_of(turn, dim), mesh);
  if (dim == 2 && view.length != 1.0 && body.kind != Kind::tool)
    keys += fmt::format(", thickness: {:.17e}", view.length);
  std::string out = fmt::format("  {}:\n    model: {{{}: {{{}{}}}}}\n", body.name, model, keys,
                                way.empty() ? "" : ", " + way.substr(4, way.size() - 5));
  if (body.kind != Kind::tool) {
    out += fmt::format("    material: {{{}}}\n", material_of(body, view));
    out += fmt::format("    integrator: {{{}: {{step: {:.17e}{}}}}}\n", body.scheme, body.step,
                       body.scheme == "central_difference" ? ", above_limit: clamp" : "");
    if (!scene.gravity.isZero())
      out +=
          fmt::format("    body_force: {}\n", list(view.length * view.turn * scene.gravity, dim));
  }
  const Eigen::Vector3d place = view.length * (view.turn * (body.place + view.shift));
  out += fmt::format("    initial: {{position: {}", list(place, dim));
  if (body.moves_by_itself())
    out += ", velocity: " + list(view.length * view.turn * body.velocity, dim);
  out += "}\n";
  if (body.kind == Kind::held) out += "    constraints: {held: {on: bottom, fixed: true}}\n";
  return out + fmt::format("    ports: {{face: {{side: {}}}}}\n", body.port);
}

bool may_meet(const RandomBody& a, const RandomBody& b) {
  return a.kind != Kind::tool || b.kind != Kind::tool;
}

std::string interfaces_of(const RandomScene& scene, const View& view) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
      if (!may_meet(scene.bodies[i], scene.bodies[j])) continue;
      std::string sides[2] = {scene.bodies[i].name + ".face", scene.bodies[j].name + ".face"};
      const std::string finder =
          view.finder < 0 ? ""
                          : fmt::format(", transmission: {{unilateral: {{kinematic: {}}}}}",
                                        sides[view.finder]);
      if (view.reversed) std::swap(sides[0], sides[1]);
      all.push_back(
          fmt::format("  pair_{}_{}: {{sides: [{}, {}], contact: {{friction: {:.17e}}}{}}}\n", i, j,
                      sides[0], sides[1], scene.friction, finder));
    }
  if (view.reversed) std::ranges::reverse(all);
  return fmt::format("interfaces:\n{}", fmt::join(all, ""));
}

}  // namespace

std::string RandomScene::words() const {
  std::vector<std::string> each;
  for (const RandomBody& body : bodies) {
    const std::string element = body.shape.element;
    const char* const kinds[] = {"", "held ", "rigid ", "tool "};
    std::string word = kinds[static_cast<int>(body.kind)] + body.shape.kind + " " + element;
    if (!body.scheme.empty() && body.kind != Kind::rigid)
      word += fmt::format(" {} {}", body.law, body.scheme);
    each.push_back(word);
  }
  return fmt::format("{}D {:.2g} m/s, {}{}{}: {}", dim, speed,
                     everything ? "everything" : "written",
                     friction > 0.0 ? fmt::format(", friction {:.2g}", friction) : "",
                     gravity.isZero() ? "" : ", gravity", fmt::join(each, "; "));
}

std::string RandomScene::text(const View& view) const {
  std::string out = fmt::format(
      "meta: {{title: random scene {}}}\ntime: {{begin: 0.0, end: {:.17e}, window: {:.17e}}}\n"
      "bodies:\n",
      seed, end, window);
  std::vector<std::string> texts;
  for (const RandomBody& body : bodies) texts.push_back(body_text(*this, body, view));
  if (view.reversed) std::ranges::reverse(texts);
  out += fmt::format("{}", fmt::join(texts, ""));
  if (everything)
    out += fmt::format("contact: {{everything: {{friction: {:.17e}}}}}\n", friction);
  else
    out += interfaces_of(*this, view);
  if (view.fields_every > 0)
    out += fmt::format("output: {{fields: {{every: {}}}}}\n", view.fields_every);
  return out;
}

void RandomScene::write(const std::filesystem::path& folder, const View& view) const {
  std::ofstream(folder / "scene.yaml") << text(view);
  for (const RandomBody& body : bodies)
    if (body.shape.generator.empty())
      std::ofstream(folder / (body.name + ".msh")) << body.shape.gmsh();
}

}  // namespace abut
