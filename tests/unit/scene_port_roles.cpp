// Goal: a body is told of its ports what the scene's interfaces make of them, and needs no other
// text. Oracles: the scene as written; both sides of a joint are told the same.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/yaml_fields.hpp"
#include "coordinator/scene.hpp"
#include "subdomain_solver/fe/file_digest.hpp"
#include "subdomain_solver/make/read_body.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scenes.hpp"

namespace abut::scene_port_roles_tests {
namespace {

constexpr const char* kicks = "central_difference: {step: 0.01}";

struct BodyText {
  std::string integrator = kicks;
  bool shares = false;  // its ends have tied: true
  std::string more = {};
  std::string model = "fe: {dimension: 1, mesh: {bar: {length: 1.0, elements: 9, area: 1.0}}}";
  std::string law = "linear_elastic: {youngs_modulus: 1.0, density: 1.0}";
};

/// Bodies a, b, ... with ports left and right, and what the interfaces say.
Scene scene_of(const std::vector<BodyText>& bodies, const std::string& interfaces,
               const std::string& more = "") {
  std::string text = "meta: {title: test}\ntime: {begin: 0.0, end: 1.0, window: 0.1}\nbodies:\n";
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const BodyText& body = bodies[b];
    const std::string tied = body.shares ? ", tied: true" : "";
    text += fmt::format(
        "  {0}:\n    model: {{{1}}}\n    material: {{{5}}}\n    integrator: {{{2}}}\n    ports: "
        "{{left: {{side: left{3}}}, right: {{side: right{3}}}}}\n{4}",
        static_cast<char>('a' + b), body.model, body.integrator, tied, body.more, body.law);
  }
  return read_scene(
      Document::from_text("test", text + "interfaces: {" + interfaces + "}\n" + more));
}

const BodyContext& told(const Scene& scene, const std::string& body) {
  for (const auto& [name, entry] : scene.bodies)
    if (name == body) return entry.context;
  throw InputError("no body", body, "");
}

bool alike(const Scene& scene, const std::string& body, const std::string& port) {
  return told(scene, body).role(port).alike;
}

TEST(PortRoles, ContactTouchesTiesDoNotAndOtherPortsAreAsTheSceneSays) {
  const std::string joints =
      "hit: {sides: [a.right, b.left], contact: {}}, joint: {sides: "
      "[b.right, c.left], tied: {}}";
  for (const bool everything : {false, true}) {
    const std::string more = everything ? "contact: {everything: {}}\n" : "";
    const Scene scene = scene_of({{}, {}, {}}, joints, more);
    for (const auto& [body, port, touches, tied] : {std::tuple("a", "left", everything, false),
                                                    {"a", "right", true, false},
                                                    {"b", "left", true, false},
                                                    {"b", "right", false, true},
                                                    {"c", "left", false, true},
                                                    {"c", "right", everything, false}}) {
      SCOPED_TRACE(fmt::format("{}.{} {}", body, port, everything));
      EXPECT_EQ(told(scene, body).role(port).touches, touches);
      EXPECT_EQ(told(scene, body).role(port).tied, tied);
    }
  }
}

TEST(PortRoles, NameThePartnersInTheOrderOfTheInterfaces) {
  const Scene scene =
      scene_of({{}, {}, {}},
               "one: {sides: [a.right, b.left], contact: {rows: point_to_surface}, transmission: "
               "{unilateral: {kinematic: b.left}}}, two: {sides: [c.left, a.right], contact: {}}");
  const PortRole a = told(scene, "a").role("right");
  ASSERT_EQ(a.partners.size(), 2u);
  EXPECT_EQ(a.partners[0].interface + a.partners[0].body + a.partners[0].port, "onebleft");
  EXPECT_EQ(a.partners[1].interface + a.partners[1].body + a.partners[1].port, "twocleft");
  EXPECT_TRUE(a.partners[0].points && a.partners[0].finds);
  EXPECT_FALSE(a.partners[1].points || a.partners[1].finds);
  const PortRole b = told(scene, "b").role("left");
  EXPECT_TRUE(b.partners.at(0).points);
  EXPECT_FALSE(b.partners.at(0).finds);  // the body itself does
}

/// Nodes that are shared: one step and explicit or implicit alike, whatever the weights. Along a
/// row all are told the same, whoever is the odd one.
TEST(PortRoles, OfSharedNodesTellWhetherTheWholeRowStepsAlike) {
  const std::string n1 = "newmark: {step: 0.01}", n2 = "newmark: {step: 0.02}",
                    h1 = "hht_alpha: {step: 0.01}", e2 = "central_difference: {step: 0.02}";
  const std::vector<std::pair<std::vector<std::string>, bool>> rows = {
      {{kicks, kicks}, true},        {{n1, n1}, true},          {{n1, h1}, true},
      {{kicks, e2}, false},          {{n1, n2}, false},         {{kicks, n1}, false},
      {{kicks, kicks, kicks}, true}, {{n1, h1, n1}, true},      {{kicks, kicks, e2}, false},
      {{kicks, e2, kicks}, false},   {{n2, n1, n1, n1}, false}, {{n1, n1, n1, h1}, true}};
  for (const auto& [integrators, expected] : rows) {
    std::vector<BodyText> bodies;
    std::string ties;
    for (std::size_t b = 0; b < integrators.size(); ++b) {
      bodies.push_back({.integrator = integrators[b], .shares = true});
      if (b == 0) continue;
      const char left = static_cast<char>('a' + b - 1), right = static_cast<char>('a' + b);
      ties += fmt::format("j{}: {{sides: [{}.right, {}.left], tied: {{}}}}, ", b, left, right);
    }
    SCOPED_TRACE(ties + integrators.front() + integrators.back());
    const Scene scene = scene_of(bodies, ties);
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      EXPECT_EQ(alike(scene, std::string(1, static_cast<char>('a' + b - 1)), "right"), expected);
      EXPECT_EQ(alike(scene, std::string(1, static_cast<char>('a' + b)), "left"), expected);
    }
    // The free ends join nothing.
    EXPECT_TRUE(alike(scene, "a", "left"));
    EXPECT_FALSE(told(scene, "a").role("left").tied);
  }
}

/// A body that may take a step below the scene's has none that others could have, whatever it is.
/// Bars of linear material cannot: the key is refused there.
TEST(PortRoles, OfSharedNodesAreNotAlikeWhereAStepMayBeClamped) {
  const std::string clamped = "central_difference: {step: 0.01, above_limit: clamp}";
  const std::string rubber =
      "neo_hookean: {youngs_modulus: 1.0, poissons_ratio: 0.3, density: 1.0}";
  const std::string tie = "j: {sides: [a.right, b.left], tied: {}}";
  for (const auto& [a, b, expected] : {std::tuple(std::string(kicks), std::string(kicks), true),
                                       {clamped, std::string(kicks), false},
                                       {std::string(kicks), clamped, false},
                                       {clamped, clamped, false}}) {
    const Scene scene = scene_of({{.integrator = a, .shares = true, .law = rubber},
                                  {.integrator = b, .shares = true, .law = rubber}},
                                 tie);
    EXPECT_EQ(alike(scene, "a", "right"), expected) << a << b;
    EXPECT_EQ(alike(scene, "b", "left"), expected) << a << b;
  }
}

/// Surfaces: the same scheme, step and weights, in each net of ties by itself.
TEST(PortRoles, OfTiedSurfacesTellWhetherTheirNetIntegratesAlike) {
  const std::string d1 = "newmark: {step: 0.01, gamma: 0.6, beta: 0.31}",
                    d2 = "newmark: {step: 0.01, gamma: 0.7, beta: 0.37}";
  const auto told_alike = [&](const std::vector<std::string>& integrators) {
    std::vector<BodyText> bodies;
    for (const std::string& integrator : integrators)
      bodies.push_back({.integrator = integrator,
                        .model = "fe: {dimension: 2, mesh: {rectangle: {lengths: [1.0, 1.0], "
                                 "elements: [2, 2]}}}"});
    const Scene scene = scene_of(bodies,
                                 "ab: {sides: [a.right, b.left], tied: {}}, bc: {sides: "
                                 "[b.right, c.left], tied: {}}, de: {sides: [d.right, "
                                 "e.left], tied: {}}");
    std::vector<bool> out = {alike(scene, "a", "right"), alike(scene, "b", "left"),
                             alike(scene, "b", "right"), alike(scene, "c", "left"),
                             alike(scene, "d", "right"), alike(scene, "e", "left")};
    return out;
  };
  EXPECT_EQ(told_alike({d1, d1, d1, d2, d2}), std::vector<bool>(6, true));
  EXPECT_EQ(told_alike({d1, d1, d2, d2, d2}),
            (std::vector<bool>{false, false, false, false, true, true}));
  EXPECT_EQ(told_alike({d1, d1, d1, d2, d1}),
            (std::vector<bool>{true, true, true, true, false, false}));
}

/// Partners' keys come where a body needs the partner's mesh, and read as the scene's own do.
TEST(PortRoles, BringThePartnersKeysWhereItsMeshIsNeeded) {
  const std::string plate =
      "fe: {dimension: 2, mesh: {rectangle: {lengths: [0.3, 0.7], elements: "
      "[2, 2]}}}";
  const std::string law =
      "linear_elastic: {youngs_modulus: 0.1, poissons_ratio: 0.3, density: "
      "0.7}";
  BodyText one{.model = plate, .law = law}, adjusted = one;
  adjusted.more = "    initial: {position: [0.1, 0.2], adjust: true}\n";
  const Scene scene = scene_of({adjusted, one, one, one},
                               "hit: {sides: [a.right, b.left], contact: {}}, seam: {sides: "
                               "[c.right, d.left], tied: {overlap: {exchange: motions}}}");
  EXPECT_TRUE(told(scene, "b").role("left").partners.at(0).keys.empty());
  EXPECT_FALSE(told(scene, "b").role("left").partners.at(0).overlap);
  const Document nothing = Document::from_text("test", "meta: {}\n");
  for (const auto& [body, port] : {std::pair("a", "right"), {"c", "right"}, {"d", "left"}}) {
    const PortPartner partner = told(scene, body).role(port).partners.at(0);
    const std::optional<BodySpec> read = read_partner(partner, nothing);
    ASSERT_TRUE(read) << body;
    EXPECT_EQ(std::get<RectangleSpec>(read->shape()->mesh).lengths,
              (std::vector<double>{0.3, 0.7}));
    EXPECT_EQ(std::get<LinearElasticSpec>(*read->material).density, 0.7);
  }
  const std::optional<OverlapRole> first = told(scene, "c").role("right").partners[0].overlap;
  const std::optional<OverlapRole> second = told(scene, "d").role("left").partners[0].overlap;
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->first && !second->first);
  EXPECT_TRUE(first->motions && second->motions && !first->halves && !second->halves);
}

/// A body that reads its partner's mesh from a file reads the one that lies beside the scene.
TEST(PortRoles, ThePartnersMeshIsTheFileBesideTheScene) {
  const std::string file = std::string(ABUT_SOURCE_DIR) + "/configs/meshes/block.msh";
  const std::string rest =
      "material: {linear_elastic: {youngs_modulus: 1.0, poissons_ratio: 0.3, "
      "density: 1.0}}, integrator: {newmark: {step: 0.1}}, ports: {cut: "
      "{side: left}}";
  const Document scene = Document::from_text(
      "test",
      "bodies: {a: {model: {fe: {dimension: 3, mesh: {box: {lengths: [1.0, 1.0, 1.0], "
      "elements: [1, 1, 1]}}}}, " +
          rest + "}}\n");
  PortPartner partner;
  partner.interface = "seam";
  partner.body = "b";
  partner.port = "cut";
  partner.tied = true;
  partner.overlap.emplace();
  partner.keys = "bodies: {b: {model: {fe: {dimension: 3, mesh: {gmsh: {file: " + file + "}}}}, " +
                 rest + "}}";
  const auto built = [&](std::uint64_t digest) {
    partner.mesh_digest = digest;
    return refusal([&] {
      make_body(scene, "bodies.a",
                {.ports = {{.port = "cut", .tied = true, .partners = {partner}}}});
    });
  };
  const std::string words = "is another file than the one beside the scene";
  EXPECT_NE(built(1).find(words), std::string::npos) << built(1);
  EXPECT_NE(built(1).find("bodies.b.model.fe.mesh.gmsh.file"), std::string::npos) << built(1);
  EXPECT_EQ(built(0).find(words), std::string::npos) << built(0);
  EXPECT_EQ(built(digest_of_file(file)).find(words), std::string::npos);
}

/// A program of somebody else is told of the ports that interfaces name, and its partners of it.
TEST(PortRoles, AreToldToBodiesOfOtherProgramsToo) {
  const Scene scene = read_scene(Document::from_text(
      "test",
      "meta: {title: test}\ntime: {begin: 0.0, end: 1.0, window: 0.1}\nbodies:\n  a: {model: "
      "{external: {left: nonsense}}, launch: {connect: {}}}\n  b: {model: {rigid_wall: {}}, "
      "initial: "
      "{position: [0.0]}, ports: {face: {side: left}}}\ninterfaces: {hit: {sides: [a.tip, b.face], "
      "contact: {}}}\n"));
  EXPECT_TRUE(told(scene, "a").role("tip").touches);
  EXPECT_FALSE(told(scene, "a").role("tip").partners.at(0).external);
  EXPECT_FALSE(told(scene, "a").role("tail").touches);
  EXPECT_TRUE(told(scene, "b").role("face").partners.at(0).external);
}

}  // namespace
}  // namespace abut::scene_port_roles_tests
