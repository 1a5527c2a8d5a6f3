// Goal: every kind of body under every scheme, law and formulation comes back to a saved state bit
// for bit, and so does another one from a checkpoint: with data on its ports, in plastic flow,
// after shortened last substeps. Oracle: equal hashes and traces.

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/unit/solver_cases.hpp"

namespace abut {
namespace {

constexpr double substep = 0.05;
constexpr double instants[] = {0.0, 0.33, 0.61};  // no multiples of the substep

/// A way to make a body; null: the combination is refused.
struct Maker {
  std::string name;
  std::function<std::unique_ptr<Subdomain>()> make;
};

Maker text_maker(const std::string& name, const std::string& text) {
  return {name, [text]() -> std::unique_ptr<Subdomain> {
            try {
              return make_body(Document::from_text("test", "bodies: {it: {" + text + "}}"),
                               "bodies.it");
            } catch (const InputError&) {
              return nullptr;
            }
          }};
}

std::string integrator_text(const std::string& scheme) {
  return fmt::format("integrator: {{{}: {{step: {}}}}}", scheme, substep);
}

/// A bar, square or cube of two cells along each edge, clamped, and pushed at the other side.
std::string solid_text(int dim, const std::string& model, const std::string& law,
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

std::vector<Maker> solids() {
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

std::vector<Maker> bars() {
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

/// What partners do in one of the two windows.
Advance pressed(const Subdomain& body, int w, bool obstructed) {
  Advance request = free_request(body, instants[w], instants[w + 1], 2);
  request.window.index = w;
  const Description& d = body.describe();
  for (std::size_t p = 0; p < request.boundary.size(); ++p) {
    BoundaryData& data = request.boundary[p];
    const std::size_t width = d.ports[p].geometry.points.size();
    const std::vector<double> times = {instants[w], instants[w + 1]};
    if (obstructed) {
      data.obstacles.resize(1);
      data.obstacles[0].motion.time = times;
      data.obstacles[0].motion.u = {-0.01 * w * outward(body, p),
                                    -0.01 * (w + 1) * outward(body, p)};
    } else if (d.can.motion) {
      data.motion.time = times;
      data.motion.u = {0.01 * w, 0.01 * (w + 1)};
      data.motion.v = data.motion.a = {0.1, 0.0};
    } else if (d.can.force) {
      Waveform& force = data.forces.emplace_back(static_cast<int>(width));
      force.time = times;
      const double points = d.ports[p].geometry.count();
      for (std::size_t k = 0; k < 2 * width; ++k)
        force.f.push_back(0.01 * static_cast<double>(1 + w + k / width) / points);
    }
    if (d.can.impulse) data.impulse.assign(width, 0.001);
  }
  return request;
}

void meet_all(Subdomain& body, bool obstructed) {
  for (std::size_t p = 0; obstructed && p < body.describe().ports.size(); ++p)
    meet_point(body, p, body.describe().ports[p].tied);
}

void rewind(const Maker& maker, bool obstructed) {
  const std::unique_ptr<Subdomain> body = maker.make(), twin = maker.make();
  meet_all(*body, obstructed);
  meet_all(*twin, obstructed);
  Response first, second, third;
  step(*body, pressed(*body, 0, obstructed), first);
  const std::uint64_t saved = body->state_hash();
  const std::vector<std::byte> checkpoint = body->checkpoint();
  body->save();
  const Advance next = pressed(*body, 1, obstructed);
  step(*body, next, first);
  const std::uint64_t hash = body->state_hash();
  body->restore();
  EXPECT_EQ(body->state_hash(), saved);
  step(*body, free_request(*body, instants[1], 1.0), second);  // must leave no trace
  body->restore();
  step(*body, next, second);
  EXPECT_EQ(body->state_hash(), hash);
  step(*twin, free_request(*twin, 0.0, 0.1), third);  // nor here
  twin->resume(checkpoint);
  EXPECT_EQ(twin->state_hash(), saved);
  step(*twin, next, third);
  EXPECT_EQ(twin->state_hash(), hash);
  for (std::size_t p = 0; p < first.ports.size(); ++p) {
    EXPECT_EQ(first.ports[p].trace.u, second.ports[p].trace.u);
    EXPECT_EQ(first.ports[p].trace.f, second.ports[p].trace.f);
    EXPECT_EQ(first.ports[p].trace.v, third.ports[p].trace.v);
    EXPECT_EQ(first.ports[p].trace.f, third.ports[p].trace.f);
    EXPECT_EQ(first.ports[p].work, second.ports[p].work);
    EXPECT_EQ(first.ports[p].lower, third.ports[p].lower);
  }
  EXPECT_EQ(first.records[1].energy.total(), third.records[1].energy.total());
  EXPECT_EQ(first.records[1].energy.external_work, third.records[1].energy.external_work);
  EXPECT_EQ(first.records[1].columns, third.records[1].columns);
  EXPECT_EQ(body->measure(), twin->measure());
}

/// Rewinds all that are not refused; tells how many these are.
int rewind_all(const std::vector<Maker>& makers) {
  int rewound = 0;
  for (const Maker& maker : makers) {
    SCOPED_TRACE(maker.name);
    const std::unique_ptr<Subdomain> body = maker.make();
    if (!body) continue;
    ++rewound;
    rewind(maker, false);
    if (body->describe().can.obstacle) rewind(maker, true);
  }
  return rewound;
}

TEST(EveryRewind, OfBarsPairsAndWalls) { EXPECT_GE(rewind_all(bars()), 50); }

TEST(EveryRewind, OfSolidsRigidAndModalBodies) { EXPECT_GE(rewind_all(solids()), 150); }

}  // namespace
}  // namespace abut
