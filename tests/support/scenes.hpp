#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "subdomain_solver/make/body_spec.hpp"

namespace abut {

inline std::string number(double x) { return fmt::format("{:.17e}", x); }

/// A scene that begins at time 0, of bodies in lines of their own; `rest`: its other sections.
inline std::string scene_text(double end, double window, const std::string& bodies,
                              const std::string& rest = "") {
  return fmt::format(
      "meta: {{title: test}}\ntime: {{begin: 0.0, end: {}, window: {}}}\nbodies:\n{}{}",
      number(end), number(window), bodies, rest);
}

// The schemes that tests go through, as scenes write them; the step is filled in.
inline std::string explicit_scheme(double step, int terms = 1) {
  const std::string more = terms > 1 ? fmt::format(", dispersion_terms: {}", terms) : "";
  return fmt::format("central_difference: {{step: {}{}}}", number(step), more);
}
inline std::string implicit_scheme(const std::string& name, double step) {
  return fmt::format("{}: {{step: {}}}", name, number(step));
}

/// The law of a linear bar.
inline std::string bar_law(double modulus = 1.0, double density = 1.0) {
  return fmt::format("linear_elastic: {{youngs_modulus: {}, density: {}}}", number(modulus),
                     number(density));
}

/// A bar as a scene file writes it. Defaults are the left bar of configs/two_bars.yaml. Ports are
/// named after their sides.
struct BarText {
  std::string name = "left";
  double length = 0.25, area = 1.0e-6;  // [m] [m^2]
  int elements = 200;
  double modulus = 1.0e9, density = 1000.0;  // [Pa] [kg/m^3]
  std::string integrator = explicit_scheme(1.0e-7, 6);
  std::string layer = "massless: {stiffness_factor: 1.4}";      // or empty
  double position = -0.27, velocity = 100.0, body_force = 0.0;  // [m] [m/s] [m/s^2]
  std::vector<std::string> sides = {"right"};
  std::string fixed = {};  // side held at rest, or empty
  std::string tied = {};   // sides among them that are joints
  bool solid = false;      // by the model of solids: its elements differ by a rounding
  std::string law = {};    // in place of modulus and density
  std::string start = {};  // other keys of initial
  std::string more = {};   // keys of the body, in lines of their own

  std::string text() const {
    std::string ports;
    bool contact = false;
    for (const std::string& side : sides) {
      const bool joint = tied.find(side) != std::string::npos;
      contact = contact || !joint;
      ports += fmt::format("{0}: {{side: {0}{1}}}, ", side, joint ? ", tied: true" : "");
    }
    std::string out = fmt::format("  {}:\n", name);
    out += fmt::format(
        "    model: {{fe: {{dimension: 1, mesh: {{bar: {{length: {}, elements: {}, area: "
        "{}{}}}}}}}}}\n"
        "    material: {{{}}}\n    integrator: {{{}}}\n",
        number(length), elements, number(area),
        solid ? ", grading: " + number(1.0 + std::numeric_limits<double>::epsilon()) : "",
        law.empty() ? bar_law(modulus, density) : law, integrator);
    // What has no effect is refused.
    if (contact && !solid && !layer.empty())
      out += fmt::format("    contact_layer: {{{}}}\n", layer);
    out += fmt::format("    initial: {{position: [{}]", number(position));
    if (velocity != 0.0) out += fmt::format(", velocity: [{}]", number(velocity));
    if (!start.empty()) out += ", " + start;
    out += "}\n";
    if (body_force != 0.0) out += fmt::format("    body_force: [{}]\n", number(body_force));
    if (!fixed.empty()) out += fmt::format("    supports: {{{}: fixed}}\n", fixed);
    if (!sides.empty()) out += fmt::format("    ports: {{{}}}\n", ports);
    return out + more;
  }

  double spacing() const { return length / elements; }
  double wave_speed() const { return std::sqrt(modulus / density); }
  double impedance() const { return density * wave_speed() * area; }
  double mass() const { return density * area * length; }
};

/// A bar of unit area, modulus and density.
inline BarText unit_bar(const std::string& name, double length, int elements,
                        const std::string& integrator, double position = 0.0,
                        double velocity = 0.0) {
  BarText bar;
  bar.name = name;
  bar.length = length;
  bar.elements = elements;
  bar.area = bar.modulus = bar.density = 1.0;
  bar.integrator = integrator;
  bar.layer = "massless: {}";
  bar.position = position;
  bar.velocity = velocity;
  return bar;
}

/// The body itself of such a text, in this process.
inline std::unique_ptr<Subdomain> build(const std::string& name, const std::string& text) {
  return make_body(Document::from_text("test", "bodies:\n" + text), "bodies." + name);
}
inline std::unique_ptr<Subdomain> build(const BarText& bar) { return build(bar.name, bar.text()); }

/// A wall in one dimension that turns this side to bars, with a port of the side's name.
inline std::string wall_text(double position, const std::string& side,
                             const std::string& name = "wall") {
  return fmt::format(
      "  {0}: {{model: {{rigid_wall: {{}}}}, initial: {{position: [{1}]}}, "
      "ports: {{{2}: {{side: {2}}}}}}}\n",
      name, number(position), side);
}

inline std::unique_ptr<Subdomain> build_wall(double position, const std::string& side) {
  return build("wall", wall_text(position, side));
}

/// Two surfaces that touch; `more`: keys of the interface after a comma.
inline std::string touching(const std::string& name, const std::string& one,
                            const std::string& other, const std::string& more = "") {
  return fmt::format("  {}: {{sides: [{}, {}], contact: {{}}{}}}\n", name, one, other, more);
}

/// Two sides that are joined; `keys`: of tied.
inline std::string joined(const std::string& name, const std::string& one, const std::string& other,
                          const std::string& keys = "") {
  return fmt::format("  {}: {{sides: [{}, {}], tied: {{{}}}}}\n", name, one, other, keys);
}

/// A law as a scene writes it for a body of this dimension: a linear bar has no constant of
/// breadth.
inline std::string law_in(int dim, std::string law) {
  const std::size_t at = law.find("poissons_ratio: ");
  if (dim == 1 && law.starts_with("linear_elastic") && at != std::string::npos)
    law.erase(at, law.find(", ", at) + 2 - at);
  return law;
}

/// A request for one window with nothing imposed.
inline Advance free_request(const Subdomain& body, double begin, double end, int records = 1) {
  Advance request;
  request.window = {0, begin, end};
  request.records = records;
  request.boundary.resize(body.describe().ports.size());
  return request;
}

}  // namespace abut
