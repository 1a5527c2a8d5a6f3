// A random scene as a scene file and its meshes.

#include <algorithm>
#include <fstream>
#include <tuple>

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

std::string material_of(const RandomBody& body, int dim, const View& view) {
  const double pressure = view.mass / view.length;  // as of a force per area: kg / (m s^2)
  std::string more;
  if (body.law == "j2_plasticity")
    more = fmt::format(", yield_stress: {:.17e}, hardening: {:.17e}", body.yield * pressure,
                       0.02 * body.modulus * pressure);
  if (dim == 1 && body.law == "linear_elastic")
    return fmt::format("{}: {{youngs_modulus: {:.17e}, density: {:.17e}}}", body.law,
                       body.modulus * pressure,
                       body.density * view.mass / (view.length * view.length * view.length));
  return fmt::format("{}: {{youngs_modulus: {:.17e}, poissons_ratio: {:.17e}, density: {:.17e}{}}}",
                     body.law, body.modulus * pressure, body.ratio,
                     body.density * view.mass / (view.length * view.length * view.length), more);
}

/// Of a tool that goes its way, turns, or both.
std::string drive_of(const RandomBody& body, int dim, const View& view) {
  std::string out;
  if (!body.velocity.isZero()) {
    const Eigen::Vector3d v = view.length * view.turn * body.velocity;
    std::vector<std::string> rows;
    for (int i = 0; i < dim; ++i) rows.push_back(fmt::format("\"({:.17e}) * t\"", v(i)));
    out = fmt::format(", way: [{}]", fmt::join(rows, ", "));
  }
  if (body.spin.isZero()) return out;
  const Eigen::Vector3d place = view.length * (view.turn * (body.place + view.shift));
  const double rate = dim == 2 ? body.spin(2) : body.spin.norm();
  const std::string axis =
      dim == 2 ? "" : ", axis: " + list(view.turn * body.spin.normalized(), dim);
  return out + fmt::format(", turn: {{about: {}{}, angle: \"({:.17e}) * t\"}}", list(place, dim),
                           axis, rate);
}

/// [m/s] about the body's place, as it is in space.
std::string spin_of(const RandomBody& body, int dim, const View& view) {
  const Eigen::Vector3d at = view.length * (view.turn * (body.place + view.shift));
  const Eigen::Vector3d w = view.turn * body.spin;
  const char* const axes[] = {"x", "y", "z"};
  std::vector<std::string> rows;
  for (int i = 0; i < dim; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;  // (w x r)_i = w_j r_k - w_k r_j
    std::string row;
    for (const auto& [of, by, sign] : {std::tuple(j, k, 1.0), std::tuple(k, j, -1.0)})
      if (by < dim)
        row += fmt::format("{}({:.17e}) * ({} - ({:.17e}))", row.empty() ? "" : " + ", sign * w(of),
                           axes[by], at(by));
    rows.push_back("\"" + row + "\"");
  }
  return fmt::format(", velocity_field: [{}]", fmt::join(rows, ", "));
}

std::string ports_of(const RandomBody& body) {
  std::string out = fmt::format("face: {{side: {}}}", body.port);
  for (const auto& [name, facets] : body.shape.cuts)
    out += fmt::format(", {0}: {{side: {0}}}", name);
  return fmt::format("    ports: {{{}}}\n", out);
}

std::string mesh_of(const RandomBody& body, int dim, const View& view) {
  const Shape& shape = body.shape;
  if (dim == 1)
    return fmt::format("mesh: {{bar: {{length: {:.17e}, elements: {}, area: {:.17e}}}}}",
                       view.length * shape.size(), shape.cells.size(),
                       view.length * view.length * body.area);
  const std::string mesh =
      shape.generator.empty() ? fmt::format("gmsh: {{file: {}.msh}}", body.name) : shape.generator;
  const Eigen::Matrix3d turn = view.length * view.turn * body.turn;
  std::string out = fmt::format("{}, mesh: {{{}}}", map_of(turn, dim), mesh);
  if (dim == 2 && view.length != 1.0 && body.kind != Kind::tool)
    out += fmt::format(", thickness: {:.17e}", view.length);
  return out;
}

/// Ends of bars, that are tied or touch.
std::string ends_of(const RandomScene& scene, const RandomBody& body) {
  std::vector<std::string> all;
  for (const int end : {0, 1}) {
    const char* const name = end == 0 ? "left" : "right";
    const bool first = body.name == scene.bodies.front().name;
    if (body.kind == Kind::tool && (end == 0) == first) continue;  // a wall looks at the bars
    const bool tied = std::ranges::any_of(scene.ties, [&](const RandomTie& tie) {
      return scene.bodies[tie.bodies[1 - end]].name == body.name;
    });
    all.push_back(fmt::format("{0}: {{side: {0}{1}}}", name, tied ? ", tied: true" : ""));
  }
  return fmt::format("    ports: {{{}}}\n", fmt::join(all, ", "));
}

std::string initial_of(const RandomBody& body, int dim, const View& view) {
  const Eigen::Vector3d place = view.length * (view.turn * (body.place + view.shift));
  std::string out = fmt::format("    initial: {{position: {}", list(place, dim));
  if (body.moves_by_itself())
    out += ", velocity: " + list(view.length * view.turn * body.velocity, dim);
  if (body.moves_by_itself() && !body.spin.isZero()) out += spin_of(body, dim, view);
  return out + "}\n";
}

std::string body_text(const RandomScene& scene, const RandomBody& body, const View& view) {
  const int dim = scene.dim;
  if (dim == 1 && body.kind == Kind::tool)
    return fmt::format("  {}:\n    model: {{rigid_wall: {{}}}}\n{}{}", body.name,
                       initial_of(body, dim, view), ends_of(scene, body));
  const char* const model = body.kind == Kind::rigid  ? "rigid"
                            : body.kind == Kind::tool ? "rigid_tool"
                                                      : "fe";
  std::string out = fmt::format("  {}:\n    model: {{{}: {{dimension: {}, {}{}}}}}\n", body.name,
                                model, dim, mesh_of(body, dim, view),
                                body.kind == Kind::tool ? drive_of(body, dim, view) : "");
  if (body.kind != Kind::tool) {
    const bool explicit_solid = dim > 1 && body.scheme == "central_difference";
    out += fmt::format("    material: {{{}}}\n", material_of(body, dim, view));
    out += fmt::format("    integrator: {{{}: {{step: {:.17e}{}}}}}\n", body.scheme, body.step,
                       explicit_solid ? ", above_limit: clamp" : "");
    if (!scene.gravity.isZero())
      out +=
          fmt::format("    body_force: {}\n", list(view.length * view.turn * scene.gravity, dim));
  }
  out += initial_of(body, dim, view);
  if (body.kind == Kind::held) out += "    constraints: {held: {on: bottom, fixed: true}}\n";
  return out + (dim == 1 ? ends_of(scene, body) : ports_of(body));
}

/// Parts of one body have their outsides apart but for the edges at which they are tied.
bool may_meet(const RandomBody& a, const RandomBody& b) {
  return (a.kind != Kind::tool || b.kind != Kind::tool) && (a.whole < 0 || a.whole != b.whole);
}

/// Ends of bars touch the next one, or are tied to it.
bool may_meet(const RandomScene& scene, std::size_t i, std::size_t j) {
  if (scene.dim > 1) return may_meet(scene.bodies[i], scene.bodies[j]);
  return j == i + 1 && std::ranges::none_of(scene.ties, [&](const RandomTie& tie) {
           return tie.bodies[0] == static_cast<int>(i);
         });
}

std::vector<std::string> ties_of(const RandomScene& scene, const View& view) {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < scene.ties.size(); ++k) {
    const RandomTie& tie = scene.ties[k];
    std::string sides[2];
    for (const int s : {0, 1}) sides[s] = scene.bodies[tie.bodies[s]].name + "." + tie.ports[s];
    if (view.interfaces_reversed) std::swap(sides[0], sides[1]);
    all.push_back(
        fmt::format("  joint_{}: {{sides: [{}, {}], tied: {{}}}}\n", k, sides[0], sides[1]));
  }
  return all;
}

std::string interfaces_of(const RandomScene& scene, const View& view) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    for (std::size_t j = i + 1; j < scene.bodies.size(); ++j) {
      if (!may_meet(scene, i, j)) continue;
      const bool bars = scene.dim == 1;
      std::string sides[2] = {scene.bodies[i].name + (bars ? ".right" : ".face"),
                              scene.bodies[j].name + (bars ? ".left" : ".face")};
      const std::string finder =
          view.finder < 0 ? ""
                          : fmt::format(", transmission: {{unilateral: {{kinematic: {}}}}}",
                                        sides[view.finder]);
      if (view.interfaces_reversed) std::swap(sides[0], sides[1]);
      all.push_back(fmt::format(
          "  pair_{}_{}: {{sides: [{}, {}], contact: {{{}}}{}}}\n", i, j, sides[0], sides[1],
          bars ? "" : fmt::format("friction: {:.17e}", scene.friction), finder));
    }
  for (const std::string& tie : ties_of(scene, view)) all.push_back(tie);
  if (view.interfaces_reversed) std::ranges::reverse(all);
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
    if (body.whole >= 0) word += fmt::format(" of {}", body.whole);
    if (!body.spin.isZero()) word += " turns";
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
  if (view.bodies_reversed) std::ranges::reverse(texts);
  out += fmt::format("{}", fmt::join(texts, ""));
  if (everything) out += fmt::format("contact: {{everything: {{friction: {:.17e}}}}}\n", friction);
  if (everything && !ties.empty()) {
    std::vector<std::string> all = ties_of(*this, view);
    if (view.interfaces_reversed) std::ranges::reverse(all);
    out += fmt::format("interfaces:\n{}", fmt::join(all, ""));
  }
  if (!everything) out += interfaces_of(*this, view);
  if (view.fields_every > 0)
    out += fmt::format("output: {{fields: {{every: {}}}}}\n", view.fields_every);
  return out;
}

void RandomScene::write(const std::filesystem::path& folder, const View& view) const {
  std::ofstream(folder / "scene.yaml") << text(view);
  for (const RandomBody& body : bodies)
    if (body.shape.generator.empty() && dim > 1)
      std::ofstream(folder / (body.name + ".msh")) << body.shape.gmsh();
}

}  // namespace abut
