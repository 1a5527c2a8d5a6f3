// Goal: messages whose shapes do not fit the body, its partners or the request are refused by the
// name of the field.
// Oracle: the words of the error.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "tests/transport/shape_dice.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut::refused_shapes_test {
namespace {

/// A plane body of three points with one partner of four, and messages that fit it.
struct Plane {
  Plane() {
    body.dim = 2;
    Port port;
    port.name = "edge";
    port.geometry.dim = 2;
    port.geometry.points = {0, 0, 1, 0, 2, 0};
    port.geometry.normals = {0, 1, 0, 1, 0, 1};
    port.geometry.facets = {0, 1, 1, 2};
    port.geometry.offsets = {0, 2, 4};
    body.ports.push_back(port);
    partner = port.geometry;
    partner.points = {0, 1, 1, 1, 2, 1, 3, 1};
    partner.normals.assign(8, 0.0);
    met = {{size_of(partner)}};
    asked.window = {0, 0.0, 1.0};
    asked.boundary.resize(1);
    asked.boundary[0].forces = {flat(6)};
    asked.boundary[0].obstacles = {Obstacle{flat(4), {}}};
    asked.boundary[0].obstacles[0].motion.points = {1, 3};
    asked.want.resize(1);
    asked.want[0].points = {0, 2};
    reply.ports.resize(1);
    reply.ports[0].trace = flat(4);
    reply.ports[0].trace.points = {0, 2};
    reply.ports[0].reactions = {Reaction{flat(4)}};
    reply.ports[0].reactions[0].force.points = {1, 3};
    reply.records.resize(1);
  }
  static Waveform flat(int width) {
    Waveform made(width);
    made.time = {0.0, 1.0};
    for (std::vector<double>* field : {&made.u, &made.v, &made.a, &made.f})
      field->assign(2 * index(width), 0.5);
    return made;
  }

  Description body;
  PortGeometry partner;
  Partners met;
  Advance asked;
  Response reply;
};

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const CodecError& error) {
    return error.what();
  }
  return "accepted";
}

std::string request_refused(const std::function<void(v1::Advance&)>& spoil) {
  const Plane plane;
  v1::Advance wire;
  encode(plane.asked, wire);
  spoil(wire);
  Advance got;
  return refusal([&] { decode(wire, plane.body, plane.met, got); });
}

std::string reply_refused(const std::function<void(v1::PortResponse&)>& spoil) {
  const Plane plane;
  v1::Advanced wire;
  encode(plane.reply, plane.asked, wire);
  spoil(*wire.mutable_ports(0));
  Response got;
  return refusal([&] { decode(wire, plane.body, plane.asked, got); });
}

TEST(Shapes, RequestsThatDoNotFitAreRefusedByFieldName) {
  EXPECT_EQ(request_refused([](v1::Advance&) {}), "accepted");
  const auto motion = [](v1::Advance& a) {
    return a.mutable_boundary(0)->mutable_obstacles(0)->mutable_motion();
  };
  EXPECT_EQ(request_refused(
                [](v1::Advance& a) { a.mutable_boundary(0)->mutable_forces(0)->set_width(4); }),
            "advance.boundary[0].forces[0].width is 4, but 3 points of dimension 2 are 6 numbers");
  EXPECT_EQ(
      request_refused([](v1::Advance& a) { a.mutable_boundary(0)->mutable_forces(0)->clear_f(); }),
      "advance.boundary[0].forces[0].f is missing");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->set_points(1, 4); }),
            "advance.boundary[0].obstacles[0].motion.points names point 4, but the surface has 4");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->set_points(0, -1); }),
            "advance.boundary[0].obstacles[0].motion.points names point -1, but the surface has 4");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->set_points(1, 1); }),
            "advance.boundary[0].obstacles[0].motion.points does not ascend at entry 1");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->add_points(2); }),
            "advance.boundary[0].obstacles[0].motion.points does not ascend at entry 2");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->clear_points(); }),
            "advance.boundary[0].obstacles[0].motion.width is 4, but 4 points of dimension 2 are 8 "
            "numbers");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { motion(a)->mutable_u()->RemoveLast(); }),
            "advance.boundary[0].obstacles[0].motion.u has 7 numbers where 8 belong");
  EXPECT_EQ(request_refused([](v1::Advance& a) { a.mutable_boundary(0)->add_obstacles(); }),
            "advance.boundary[0].obstacles[1] is of nobody: the port has met 1 partners");
  EXPECT_EQ(request_refused([](v1::Advance& a) { a.mutable_boundary(0)->add_impulse(1.0); }),
            "advance.boundary[0].impulse has 1 numbers where 6 belong");
  const auto slid = [](v1::Advance& a, int entry) {
    a.mutable_boundary(0)->mutable_obstacles(0)->add_slid(entry);
  };
  EXPECT_EQ(request_refused([&](v1::Advance& a) { slid(a, -1); }),
            "advance.boundary[0].obstacles[0].slid does not ascend at entry 0");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { slid(a, 3), slid(a, 3); }),
            "advance.boundary[0].obstacles[0].slid does not ascend at entry 1");
  const auto balanced = [](v1::Advance& a) {
    v1::Waveform& to = *a.mutable_boundary(0)->mutable_balanced();
    to = a.boundary(0).forces(0);
    return &to;
  };
  EXPECT_EQ(request_refused([&](v1::Advance& a) { balanced(a); }), "accepted");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { balanced(a)->Clear(); }),
            "advance.boundary[0].balanced is present but empty");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { balanced(a)->clear_f(); }),
            "advance.boundary[0].balanced.f is missing");
  EXPECT_EQ(request_refused([&](v1::Advance& a) { balanced(a)->set_width(4); }),
            "advance.boundary[0].balanced.width is 4, but 3 points of dimension 2 are 6 numbers");
  EXPECT_EQ(request_refused([&](v1::Advance& a) {
              v1::Waveform& to = *balanced(a);
              for (const int point : {0, 1, 2}) to.add_points(point);
            }),
            "advance.boundary[0].balanced.points is not of all points");
  EXPECT_EQ(request_refused([](v1::Advance& a) { a.add_want(); }),
            "advance.want has more entries than the body's 1 ports");
  EXPECT_EQ(request_refused([](v1::Advance& a) { a.mutable_want(0)->set_points(0, 3); }),
            "advance.want[0].points names point 3, but the surface has 3");
}

TEST(Shapes, RepliesThatDoNotFitAreRefusedByFieldName) {
  EXPECT_EQ(reply_refused([](v1::PortResponse&) {}), "accepted");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.mutable_trace()->set_points(0, 1); }),
            "advanced.ports[0].trace.points is not the list that was wanted");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.mutable_trace()->clear_a(); }),
            "advanced.ports[0].trace.a is missing");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.mutable_trace()->set_time(1, 0.5); }),
            "advanced.ports[0].trace.time is from 0 to 0.5 s in a window from 0 to 1 s");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.clear_reactions(); }),
            "advanced.ports[0].reactions[0].force is missing");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.add_reactions(); }),
            "advanced.ports[0].reactions has more entries than the 1 obstacles");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) {
              p.mutable_reactions(0)->mutable_force()->set_points(0, 0);
            }),
            "advanced.ports[0].reactions[0].force.points is not that of the obstacle");
  EXPECT_EQ(reply_refused(
                [](v1::PortResponse& p) { p.mutable_reactions(0)->mutable_force()->set_width(3); }),
            "advanced.ports[0].reactions[0].force.width is 3, but 2 points of dimension 2 are 4 "
            "numbers");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.add_lower(1.0); }),
            "advanced.ports[0].lower has 1 numbers where 2 belong");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) { p.mutable_reactions(0)->add_slid(0); }),
            "advanced.ports[0].reactions[0].slid has entry 0, but 0 are all of substeps and "
            "points");
  EXPECT_EQ(reply_refused([](v1::PortResponse& p) {
              p.add_lower(0.0);
              p.add_lower(0.0);
            }),
            "advanced.ports[0].upper has 0 numbers where 2 belong");
}

TEST(Shapes, SurfacesThatDoNotFitAreRefusedByFieldName) {
  const Plane plane;
  const auto meet_refused = [&plane](const std::function<void(v1::Meet&)>& spoil) {
    v1::Meet wire;
    encode({0, 1, &plane.partner}, {}, wire);
    spoil(wire);
    ReceivedMeeting got;
    return refusal([&] { decode(wire, plane.body, plane.met, got); });
  };
  EXPECT_EQ(meet_refused([](v1::Meet&) {}), "accepted");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.set_port(1); }), "meet.port is 1, but there are 1");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.clear_surface(); }),
            "meet.surface is missing, and so is kernel");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.set_partner(0); }),
            "meet.partner is 0, where 1 is next");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.set_first(0); }),
            "meet.first is of a part, which has no surface");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->set_dim(1); }),
            "meet.surface.dim is 1, but the port's is 2");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->add_points(0.0); }),
            "meet.surface.points is no whole number of points");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->clear_normals(); }),
            "meet.surface.normals has 0 numbers where 8 belong");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->set_facets(0, 4); }),
            "meet.surface.facets names point 4");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->set_offsets(2, 3); }),
            "meet.surface.offsets ends at 3, but facets has 4 entries");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->set_offsets(1, 0); }),
            "meet.surface.offsets does not increase at entry 1");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->clear_offsets(); }),
            "meet.surface.offsets does not begin at 0");
  EXPECT_EQ(meet_refused([](v1::Meet& m) { m.mutable_surface()->set_spacing(-1.0); }),
            "meet.surface.spacing is negative: -1");
}

TEST(Shapes, KernelsThatDoNotFitAreRefusedByFieldName) {
  const Plane plane;
  const auto kernel_refused = [&plane](const std::function<void(v1::Meet&)>& spoil) {
    v1::Meet wire;
    const PortKernel kernel = Dice(1).kernel(8, 8, 2);
    encode({0, 0, nullptr, {}, &kernel}, {}, wire);
    spoil(wire);
    ReceivedMeeting got;
    return refusal([&] { decode(wire, plane.body, plane.met, got); });
  };
  EXPECT_EQ(kernel_refused([](v1::Meet&) {}), "accepted");
  EXPECT_EQ(kernel_refused([](v1::Meet& y) { y.set_partner(1); }),
            "meet.partner is 1, but there are 1");
  EXPECT_EQ(kernel_refused([](v1::Meet& y) { y.mutable_kernel()->set_width(6); }),
            "meet.kernel.width is 6, but the surface's is 8");
  EXPECT_EQ(kernel_refused([](v1::Meet& y) { y.mutable_kernel()->set_patterns(1); }),
            "meet.kernel.patterns is 1, not 8");
  EXPECT_EQ(kernel_refused([](v1::Meet& y) { y.mutable_kernel()->add_displacement(1.0); }),
            "meet.kernel.displacement has 129 numbers, no whole number of substeps of 64");

  const Probing probing{0, std::vector<double>(6, 1.0), 0.1, 2};
  const auto probe_refused = [&](const std::function<void(v1::Probe&)>& spoil) {
    v1::Probe wire;
    encode(probing, wire);
    spoil(wire);
    Probing got;
    return refusal([&] { decode(wire, plane.body, got); });
  };
  EXPECT_EQ(probe_refused([](v1::Probe&) {}), "accepted");
  EXPECT_EQ(probe_refused([](v1::Probe& p) { p.add_patterns(1.0); }),
            "probe.patterns has 7 numbers, no whole number of patterns of 6");
  EXPECT_EQ(probe_refused([](v1::Probe& p) { p.set_count(0); }),
            "probe of 0 steps of 0.1 s is out of range");
  PortKernel got;
  v1::PortKernel wire;
  encode(Dice(1).kernel(1, 6, 3), wire);
  EXPECT_EQ(refusal([&] { decode(wire, plane.body, probing, got); }),
            "kernel.displacement has 3 substeps where 2 were asked for");
}

}  // namespace
}  // namespace abut::refused_shapes_test
