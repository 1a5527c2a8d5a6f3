#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/unit/solver_cases.hpp"

// Every kind of body of one part, under every scheme, law and formulation, for tests that loop.

namespace abut {

constexpr double substep = 0.05;  // [s] of all that have one

/// A way to make a body; null: the combination is refused.
struct Maker {
  std::string name;
  std::function<std::unique_ptr<Subdomain>()> make;
};

inline Maker text_maker(const std::string& name, const std::string& text) {
  return {name, [text]() -> std::unique_ptr<Subdomain> {
            try {
              return make_body(Document::from_text("test", "bodies: {it: {" + text + "}}"),
                               "bodies.it");
            } catch (const InputError&) {
              return nullptr;
            }
          }};
}

inline std::string integrator_text(const std::string& scheme) {
  return fmt::format("integrator: {{{}: {{step: {}}}}}", scheme, substep);
}

/// A bar, square or cube of two cells along each edge, clamped, and pushed at the other side.
inline std::string solid_text(int dim, const std::string& model, const std::string& law,
                              const std::string& scheme) {
  const char* meshes[] = {"bar: {length: 1.0, elements: 4, area: 1.0, grading: 1.2}",
                          "rectangle: {lengths: [1.0, 1.0], elements: [2, 2]}",
                          "box: {lengths: [1.0, 1.0, 1.0], elements: [2, 2, 2]}"};
  const bool rigid = model.starts_with("rigid");
  return fmt::format(
      "model: {{{}dimension: {}, mesh: {{{}}}}}}}, material: {{{}}}, {}, {}"
      "ports: {{face: {{side: right}}}}, loads: {{pull: {{on: right, traction: [{}'0.02 * t']}}}}",
      model, dim, meshes[index(dim) - 1], law_in(dim, law), integrator_text(scheme),
      rigid ? "" : "constraints: {clamp: {on: left, fixed: true}}, ",
      dim == 1   ? ""
      : dim == 2 ? "'0.01', "
                 : "'0.01', '0', ");
}

inline std::vector<Maker> solids() {
  const std::string elastic = "youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0";
  const std::vector<std::string> laws = {
      "linear_elastic: {" + elastic + "}",
      "saint_venant_kirchhoff: {" + elastic + "}",
      "neo_hookean: {" + elastic + "}",
      "hencky: {" + elastic + "}",
      "mooney_rivlin: {c10: 0.2, c01: 0.05, bulk_modulus: 1.0, density: 1.0}",
      "j2_plasticity: {" + elastic + ", yield_stress: 0.01, hardening: 0.5}"};
  const char* schemes[] = {"central_difference", "newmark", "hht_alpha", "generalized_alpha",
                           "quasi_static"};
  std::vector<Maker> all;
  for (int dim : {1, 2, 3}) {
    for (const std::string& law : laws) {
      for (const std::string scheme : schemes) {
        for (const char* formulation :
             {"", "formulation: one_point, ", "formulation: mean_dilatation, "}) {
          const std::string model = std::string("fe: {") + formulation;
          all.push_back(text_maker(fmt::format("{} {} {} {}", dim, model, law, scheme),
                                   solid_text(dim, model, law, scheme)));
        }
      }
    }
    for (const char* scheme : schemes)
      all.push_back(text_maker(fmt::format("modal {} {}", dim, scheme),
                               solid_text(dim, "modal: {modes: 3, ", laws[0], scheme)));
    all.push_back(text_maker(fmt::format("rigid {}", dim),
                             solid_text(dim, "rigid: {", laws[0], "rigid_motion")));
  }
  return all;
}

inline std::vector<Maker> bars() {
  std::vector<Maker> all;
  for (const SolverCase& c : all_cases(substep))
    all.push_back({c.name, [c] { return build(case_bar(c, 0.02)); }});
  for (const SolverCase& c : all_cases(substep)) {
    const std::string text = case_bar(c, 0.02).text();
    const std::string more =
        "    loads: {pull: {on: right, traction: ['0.2 * t']}, push: {on: left, pressure: '0.1'}, "
        "wind: {acceleration: ['0.01 * x * t']}}\n";
    all.push_back({"loaded " + c.name, [text, more] {
                     return make_body(Document::from_text("test", "bodies:\n" + text + more),
                                      "bodies.bar");
                   }});
  }
  for (const std::string& scheme :
       {explicit_scheme(substep, 6), implicit_scheme("newmark", substep)}) {
    BarText bar = case_bar({"", scheme, "", {"left", "right"}}, 0.02);
    bar.tied = "left right";
    all.push_back({"tied " + scheme, [bar] { return build(bar); }});
  }
  for (const char* contact : {"penalty: {stiffness: 10.0}", "lagrange_multiplier: {}"}) {
    for (const char* scheme : {"central_difference", "newmark", "backward_euler"}) {
      for (const char* lengths : {"reference", "current"}) {
        const std::string text = fmt::format(
            "model: {{bar_pair: {{left: {{length: 4.0, area: 1.0, elements: 4, position: -4.0, "
            "velocity: 0.1}}, right: {{length: 4.0, area: 1.0, elements: 4, position: 0.02, "
            "velocity: -0.1}}, contact: {{{}}}, lengths: {}}}}}, material: {{linear_elastic: "
            "{{youngs_modulus: 1.0, density: 1.0}}}}, {}",
            contact, lengths, integrator_text(scheme));
        all.push_back(text_maker(fmt::format("pair {} {} {}", contact, scheme, lengths), text));
      }
    }
  }
  all.push_back({"wall", [] { return build_wall(0.5, "left"); }});
  return all;
}

}  // namespace abut
