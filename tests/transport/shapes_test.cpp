// Goal: messages of surfaces of any shape arrive as they were sent, and those whose shapes do not
// fit the body, its partners or the request are refused by the name of the field.
// Oracle: what arrived encodes to the bytes that were sent; the words of the error.
#include <google/protobuf/stubs/logging.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <string>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Numbers, shapes and choices from one seed.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  int upto(int most) { return static_cast<int>(random_() % index(most + 1)); }
  bool coin() { return upto(1) == 1; }
  ForceSupport any_support() { return static_cast<ForceSupport>(upto(2)); }
  double value() { return static_cast<double>(random_() >> 11) * 0x1.0p-53 - 0.5; }
  std::vector<double> values(std::size_t count) {
    std::vector<double> all(count);
    for (double& one : all) one = value();
    return all;
  }
  /// Some points of a surface, or none: all of them.
  std::vector<std::int32_t> points(int count) {
    std::vector<std::int32_t> some;
    for (int i = 0; i < count; ++i)
      if (coin()) some.push_back(i);
    return some;
  }

  PortGeometry surface(int dim) {
    PortGeometry made;
    made.dim = dim;
    made.points = values(index(1 + upto(5)) * index(dim));
    made.normals = values(made.points.size());
    made.spacing = 0.5 + value();
    made.transit = 0.5 + value();
    made.embedded = upto(made.count());
    if (dim == 1) return made;
    made.offsets = {0};
    for (int facet = upto(4); facet > 0; --facet) {
      for (int node = 0; node <= dim; ++node) made.facets.push_back(upto(made.count() - 1));
      made.offsets.push_back(static_cast<std::int32_t>(made.facets.size()));
    }
    return made;
  }
  Waveform wave(const SurfaceSize& shape, const std::vector<std::int32_t>& listed,
                const TimeWindow& window) {
    Waveform made((listed.empty() ? shape.points : static_cast<int>(listed.size())) * shape.dim);
    made.points = listed;
    made.support = any_support();
    const int steps = 1 + upto(3);
    for (int i = 0; i <= steps; ++i)
      made.time.push_back(i == steps ? window.end : window.begin + window.length() * i / steps);
    const std::size_t count = made.time.size() * index(made.width);
    for (std::vector<double>* field : {&made.u, &made.v, &made.a, &made.f}) *field = values(count);
    return made;
  }
  PortKernel kernel(int patterns, int width, int count) {
    PortKernel made;
    made.step = 0.5 + value();
    made.support = any_support();
    made.patterns = patterns;
    made.width = width;
    made.displacement = values(index(count) * made.per_step());
    if (coin()) made.compliance = values(made.per_step());
    if (coin()) made.begin = values(made.displacement.size());
    return made;
  }

 private:
  std::mt19937_64 random_;
};

/// A body with some ports, the surfaces that they have met, and one exchange between them.
struct Talk {
  explicit Talk(std::uint64_t seed) : dice(seed) {
    body.name = "wide";
    body.model = "any";
    body.dim = 1 + dice.upto(2);
    body.mass = dice.coin() ? infinity : 2.0;
    body.stable_step = infinity;
    body.can = {dice.coin(), dice.coin(), dice.coin(), dice.coin(),
                dice.coin(), dice.coin(), dice.coin()};
    body.columns = {"clamp [N]"};
    for (int p = dice.upto(2); p >= 0; --p)
      body.ports.push_back({"port" + std::to_string(p), dice.surface(body.dim), dice.coin()});
    met.resize(body.ports.size());
    for (std::size_t p = 0; p < met.size(); ++p)
      for (int k = dice.upto(3); k > 0; --k) {
        surfaces.push_back({static_cast<int>(p), dice.surface(body.dim), {dice.coin()}});
        met[p].push_back(size_of(surfaces.back().surface));
      }
    make_request();
    make_reply();
  }

  void make_request() {
    request.window = {7, 0.25, 0.5};
    request.records = 1 + dice.upto(2);
    request.sampling = dice.coin() ? Sampling::substeps : Sampling::records;
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      const SurfaceSize shape = size_of(body.ports[p].geometry);
      const auto any = [&](const SurfaceSize& of) {
        return dice.wave(of, dice.points(of.points), request.window);
      };
      BoundaryData& data = request.boundary.emplace_back();
      if (dice.coin()) data.motion = any(shape);
      for (int k = dice.upto(3); k > 0; --k)
        data.forces.push_back(dice.coin() ? any(shape) : Waveform());
      for (const SurfaceSize& partner : met[p]) {
        data.obstacles.push_back({dice.coin() ? any(partner) : Waveform(), {}});
        if (!data.obstacles.back().empty()) data.obstacles.back().slid = dice.points(20);
      }
      if (dice.coin()) data.balanced = dice.wave(shape, {}, request.window);
      if (dice.coin()) data.impedance = {1.0 + dice.value(), dice.coin()};
      if (dice.coin()) data.impulse = dice.values(index(shape.width()));
      Want& want = request.want.emplace_back();
      want = {dice.coin(), dice.coin(), dice.coin(), dice.coin(), dice.points(shape.points)};
    }
    if (dice.coin()) request.want.clear();
  }

  void make_reply() {
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      PortResponse& port = reply.ports.emplace_back();
      const std::vector<std::int32_t> listed =
          request.want.empty() ? std::vector<std::int32_t>() : request.want[p].points;
      if (dice.upto(3) > 0)
        port.trace = dice.wave(size_of(body.ports[p].geometry), listed, request.window);
      for (std::size_t k = 0; k < met[p].size(); ++k) {
        const Waveform& motion = request.boundary[p].obstacles[k].motion;
        port.reactions.emplace_back();
        if (!motion.empty())
          port.reactions[k].force = dice.wave(met[p][k], motion.points, request.window);
      }
      port.lower = dice.values(index(request.records * body.dim));
      port.upper = dice.values(index(request.records * body.dim));
      port.speed_bound = dice.coin() ? infinity : dice.value();
      port.acceleration_bound = dice.value();
      port.work = dice.value();
      if (dice.coin()) port.recoil = Recoil{dice.value(), 0.5 + dice.value()};
    }
    for (int r = 0; r < request.records; ++r) {
      BodyRecord& record = reply.records.emplace_back();
      record.time = dice.value();
      record.energy = {dice.value(), dice.value(), dice.value(), dice.value()};
      record.momentum = dice.values(index(body.dim));
      record.columns = {dice.value()};
    }
    reply.steps = dice.upto(9);
    for (std::size_t p = 0; p < body.ports.size(); ++p)
      for (Reaction& reaction : reply.ports[p].reactions)
        if (!reaction.force.empty() && reply.steps > 1)
          reaction.slid = dice.points((reply.steps - 1) * body.ports[p].geometry.count());
  }

  struct Surface {  // that a port has met
    int port;
    PortGeometry surface;
    ContactLaw law;
  };

  Dice dice;
  Description body;
  std::vector<Surface> surfaces;
  Partners met;
  Advance request;
  Response reply;
};

/// Only the wanted fields of a trace travel.
void drop_unwanted(const Advance& request, Response& reply) {
  for (std::size_t p = 0; p < request.want.size(); ++p) {
    Waveform& trace = reply.ports[p].trace;
    if (!request.want[p].u) trace.u.clear();
    if (!request.want[p].v) trace.v.clear();
    if (!request.want[p].a) trace.a.clear();
    if (!request.want[p].f) trace.f.clear();
  }
}

template <class Wire, class... From>
std::string bytes_of(const From&... from) {
  Wire wire;
  encode(from..., wire);
  return wire.SerializeAsString();
}

template <class Wire>
Wire parsed(const std::string& bytes) {
  Wire wire;
  EXPECT_TRUE(wire.ParseFromString(bytes));
  return wire;
}

TEST(Shapes, EveryMessageComesBackAsItWasSent) {
  // The targets are used again and again, as a run uses them: nothing of an earlier message stays.
  Advance request;
  Response reply;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Talk talk(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::string described = bytes_of<v1::Description>(talk.body);
    Description body;
    decode(parsed<v1::Description>(described), body);
    EXPECT_TRUE(bytes_of<v1::Description>(body) == described);

    Partners met(body.ports.size());
    for (const auto& [port, surface, law] : talk.surfaces) {
      const int width = surface.count() * surface.dim;
      const PortKernel kernel = talk.dice.kernel(width, width, 2);
      const int partner = static_cast<int>(met[port].size());
      const Meeting meeting{port, partner, &surface, law, talk.dice.coin() ? &kernel : nullptr};
      const std::string sent = bytes_of<v1::Meet>(meeting, std::nullopt);
      ReceivedMeeting got;
      decode(parsed<v1::Meet>(sent), body, met, got);
      EXPECT_TRUE(bytes_of<v1::Meet>(got.meeting, got.first) == sent);
      met[port].push_back(size_of(surface));
    }

    const std::string asked = bytes_of<v1::Advance>(talk.request);
    decode(parsed<v1::Advance>(asked), body, talk.met, request);
    EXPECT_TRUE(bytes_of<v1::Advance>(request) == asked);

    const std::string answered = bytes_of<v1::Advanced>(talk.reply, talk.request);
    decode(parsed<v1::Advanced>(answered), body, talk.request, reply);
    Advance all = talk.request;
    all.want.clear();
    for (std::size_t p = 0; p < reply.ports.size(); ++p)  // room is kept, so there may be more
      reply.ports[p].reactions.resize(talk.reply.ports[p].reactions.size());
    drop_unwanted(talk.request, talk.reply);
    EXPECT_TRUE(bytes_of<v1::Advanced>(reply, all) == bytes_of<v1::Advanced>(talk.reply, all));
  }
}

TEST(Shapes, KernelsOfPatternsComeBackAsTheyWereSent) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Talk talk(seed);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Dice& dice = talk.dice;
    const int port = dice.upto(static_cast<int>(talk.body.ports.size()) - 1);
    const int width = size_of(talk.body.ports[port].geometry).width();
    const int patterns = 1 + dice.upto(3), count = 1 + dice.upto(4);
    const Probing probing{port, dice.values(index(patterns * width)), 0.5 + dice.value(), count};
    Probing asked;
    decode(parsed<v1::Probe>(bytes_of<v1::Probe>(probing)), talk.body, asked);
    EXPECT_TRUE(bytes_of<v1::Probe>(asked) == bytes_of<v1::Probe>(probing));

    const PortKernel kernel = dice.kernel(patterns, width, count);
    PortKernel got;
    decode(parsed<v1::PortKernel>(bytes_of<v1::PortKernel>(kernel)), talk.body, probing, got);
    EXPECT_TRUE(bytes_of<v1::PortKernel>(got) == bytes_of<v1::PortKernel>(kernel));
    EXPECT_EQ(got.count(), count);

    const bool own = talk.met[0].empty() || seed % 2 == 0;
    const int wide = own ? size_of(talk.body.ports[0].geometry).width() : talk.met[0][0].width();
    const PortKernel gives = dice.kernel(wide, wide, count);
    const std::string sent =
        bytes_of<v1::Meet>(Meeting{0, own ? own_surface : 0, nullptr, {}, &gives}, std::nullopt);
    ReceivedMeeting told;
    decode(parsed<v1::Meet>(sent), talk.body, talk.met, told);
    EXPECT_TRUE(bytes_of<v1::Meet>(told.meeting, told.first) == sent);
  }
}

TEST(Shapes, AnythingThatParsesIsTakenOrRefusedInWords) {
  // A byte of a sound message is changed; sanitizers and assertions watch what comes of it.
  const google::protobuf::LogSilencer silent;  // of names that are no UTF-8
  int taken = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Talk talk(seed % 50);
    Dice dice(seed);
    std::string asked = bytes_of<v1::Advance>(talk.request);
    std::string answered = bytes_of<v1::Advanced>(talk.reply, talk.request);
    std::string described = bytes_of<v1::Description>(talk.body);
    for (std::string* bytes : {&asked, &answered, &described}) {
      const std::size_t at = index(dice.upto(static_cast<int>(bytes->size()) - 1));
      (*bytes)[at] = static_cast<char>((*bytes)[at] ^ (1 << dice.upto(7)));
    }
    const std::function<void()> acts[] = {[&] {
                                            Advance got;
                                            decode(as_bytes(asked), talk.body, talk.met, got);
                                          },
                                          [&] {
                                            Response got;
                                            decode(as_bytes(answered), talk.body, talk.request,
                                                   got);
                                          },
                                          [&] {
                                            Description got;
                                            v1::Description wire;
                                            if (wire.ParseFromString(described)) decode(wire, got);
                                          }};
    for (const std::function<void()>& act : acts) {
      try {
        act();
        ++taken;
      } catch (const CodecError& error) {
        refused += std::string(error.what()).empty() ? 0 : 1;
      }
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
}

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

TEST(Shapes, SurfacesAndKernelsThatDoNotFitAreRefusedByFieldName) {
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
}  // namespace abut
