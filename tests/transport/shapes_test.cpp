// Goal: messages of surfaces of any shape arrive as they were sent.
// Oracle: what arrived encodes to the bytes that were sent.
#include <google/protobuf/stubs/logging.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "tests/transport/shape_dice.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut::shapes_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// All that a friction law is, whatever is added to it.
using FrictionNumbers = std::array<double, sizeof(FrictionLaw) / sizeof(double)>;

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
    body.can.passive = dice.coin();
    body.columns = {"clamp [N]"};
    for (int p = dice.upto(2); p >= 0; --p)
      body.ports.push_back({"port" + std::to_string(p), dice.surface(body.dim), dice.coin()});
    met.resize(body.ports.size());
    for (std::size_t p = 0; p < met.size(); ++p)
      for (int k = dice.upto(3); k > 0; --k) {
        FrictionNumbers friction;
        for (double& number : friction) number = std::abs(dice.value());
        surfaces.push_back({static_cast<int>(p),
                            dice.surface(body.dim),
                            {dice.coin(), dice.coin(), std::bit_cast<FrictionLaw>(friction)}});
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
      // A number that the codec forgets would be absent from both.
      EXPECT_EQ(got.meeting.law.tied, law.tied);
      EXPECT_EQ(got.meeting.law.points, law.points);
      EXPECT_EQ(std::bit_cast<FrictionNumbers>(got.meeting.law.friction),
                std::bit_cast<FrictionNumbers>(law.friction));
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

}  // namespace
}  // namespace abut::shapes_test
