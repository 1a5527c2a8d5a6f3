// Goal: what one end encodes, the other end decodes unchanged, and nothing unsound gets through.
// Oracle: bit-equal values; for unsound messages the name of the field in the error.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "messaging/frame.hpp"
#include "messaging/protocol.hpp"
#include "tests/support/fakes.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut::codec_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

Waveform wave(int width, double offset) {
  Waveform w(width);
  w.support = ForceSupport::step;
  for (int i = 0; i < 3; ++i) {
    w.time.push_back(0.1 * i);
    for (int k = 0; k < width; ++k) {
      w.u.push_back(1.0 / 3.0 + i + k + offset);
      w.v.push_back(-1.0 / 7.0 * i + k);
      w.a.push_back(1.0e-300 * i + k);
      w.f.push_back(1.0e150 + i - k);
    }
  }
  return w;
}

void expect_equal(const Waveform& a, const Waveform& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.support, b.support);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.u, b.u);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.f, b.f);
}

Advance full_advance() {
  Advance advance;
  advance.window = TimeWindow{41, -2.0e-4, 1.0 / 3.0, 3, 5, -0.5, 0.1};
  advance.records = 7;
  advance.sampling = Sampling::records;
  advance.ahead = 0.75;
  advance.boundary.resize(2);
  advance.boundary[0].motion = wave(1, 0.0);
  advance.boundary[0].forces = {wave(1, 1.0), Waveform(), wave(1, 3.0)};
  advance.boundary[0].obstacles = {Obstacle{}, Obstacle{wave(1, 2.0), {}}};
  advance.boundary[0].impedance = {2.5, false};
  advance.boundary[0].impulse = {-0.5};
  advance.want = {Want{true, false, true, false, {0}}, Want{false, true, false, true, {}}};
  return advance;  // the second port has nothing imposed
}

/// The first port has met two points on a line.
const Partners met{{SurfaceSize{1, 1}, SurfaceSize{1, 1}}, {}};

/// The request that full_response() answers.
Advance bare_advance() {
  Advance advance;
  advance.window = TimeWindow{0, 0.0, 0.2};
  advance.boundary.resize(2);
  return advance;
}

Description two_ports() {
  Description body = FakeSubdomain().describe();
  body.ports.push_back(body.ports[0]);
  body.ports[1].name = "tail";
  body.members = {{"front", 1.5, {0}}, {"rear", 2.5, {1}}};
  body.measures = {"displacement.x.max", "energy.stored"};
  body.fields.push_back({"stress", FieldPlace::cells, 6});
  body.columns = {"clamp.reaction [N]"};
  body.frequencies = {0.0, 12.5};
  body.linear = true;
  return body;
}

Response full_response() {
  Response response;
  response.ports.resize(2);
  response.ports[0].trace = wave(1, 0.0);
  response.ports[0].lower = {-1.0};
  response.ports[0].upper = {2.0};
  response.ports[0].slowest = {-2.5};
  response.ports[0].fastest = {3.0};
  response.ports[0].speed_bound = 3.5;
  response.ports[0].acceleration_bound = 9.81;
  response.ports[0].recoil = Recoil{6.0, 7.0};
  response.ports[0].work = -8.0;
  response.ports[1].trace = wave(1, 0.5);
  response.records.push_back(BodyRecord{0.25, Energy{1.0, 2.0, 3.0, 4.0}, {5.0}});
  response.records[0].members = {{Energy{0.1, 0.2, 0.3, 0.4}, {0.5}},
                                 {Energy{1.1, 1.2, 1.3, 1.4}, {1.5}}};
  response.records[0].columns = {-7.5};
  response.steps = 100;
  response.compute_seconds = 0.125;
  return response;
}

v1::Advanced through_bytes(const Response& from, const Advance& asked) {
  v1::Advanced wire, copy;
  encode(from, asked, wire);
  EXPECT_TRUE(copy.ParseFromString(wire.SerializeAsString()));
  return copy;
}

template <class From, class Wire>
Wire through_bytes(const From& from, Wire wire = {}) {
  encode(from, wire);
  Wire copy;
  EXPECT_TRUE(copy.ParseFromString(wire.SerializeAsString()));
  return copy;
}

/// The error of a decoding that has to fail.
template <class Decode>
std::string refusal(const Decode& decode_it) {
  try {
    decode_it();
  } catch (const CodecError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Codec, AdvanceKeepsEveryField) {
  const Advance sent = full_advance();
  Advance got;
  decode(through_bytes<Advance, v1::Advance>(sent), two_ports(), met, got);
  EXPECT_EQ(got.window.index, 41);
  EXPECT_EQ(got.window.windows, 3);
  EXPECT_EQ(got.window.since, 5);
  EXPECT_EQ(got.window.anchor, -0.5);
  EXPECT_EQ(got.window.whole, 0.1);
  EXPECT_EQ(got.window.begin, sent.window.begin);
  EXPECT_EQ(got.window.end, sent.window.end);
  EXPECT_EQ(got.records, 7);
  EXPECT_EQ(got.sampling, Sampling::records);
  EXPECT_EQ(got.ahead, 0.75);
  expect_equal(got.boundary[0].motion, sent.boundary[0].motion);
  ASSERT_EQ(got.boundary[0].forces.size(), 3U);
  expect_equal(got.boundary[0].forces[0], sent.boundary[0].forces[0]);
  EXPECT_TRUE(got.boundary[0].forces[1].empty());
  expect_equal(got.boundary[0].forces[2], sent.boundary[0].forces[2]);
  ASSERT_EQ(got.boundary[0].obstacles.size(), 2U);
  EXPECT_TRUE(got.boundary[0].obstacles[0].empty());
  expect_equal(got.boundary[0].obstacles[1].motion, sent.boundary[0].obstacles[1].motion);
  ASSERT_EQ(got.want.size(), 2U);
  EXPECT_TRUE(got.want[0].u && !got.want[0].v && got.want[0].a && !got.want[0].f);
  EXPECT_EQ(got.want[0].points, std::vector<std::int32_t>{0});
  EXPECT_TRUE(!got.want[1].u && got.want[1].v && !got.want[1].a && got.want[1].f);
  EXPECT_EQ(got.boundary[0].impedance.value, 2.5);
  EXPECT_FALSE(got.boundary[0].impedance.bilateral);
  EXPECT_TRUE(got.boundary[1].impedance.empty());
  EXPECT_EQ(got.boundary[0].impulse, sent.boundary[0].impulse);
  EXPECT_FALSE(got.boundary[1].closed());
  EXPECT_TRUE(got.boundary[1].impulse.empty());
}

TEST(Codec, AngularMomentumHasOneNumberPerAxisOfRotationOrNone) {
  Description body;
  Response sent;
  sent.records.push_back(BodyRecord{0.25, {}, {}, {}});
  const Advance asked;
  for (const auto& [dim, axes] : {std::pair{1, 0u}, {2, 1u}, {3, 3u}}) {
    body.dim = dim;
    sent.records[0].momentum.assign(index(dim), 1.0);
    for (const std::size_t count : {0u, 1u, 2u, 3u}) {
      sent.records[0].angular_momentum.assign(count, 2.5);
      const v1::Advanced wire = through_bytes(sent, asked);
      Response got;
      const std::string why = refusal([&] { decode(wire, body, asked, got); });
      if (count == 0 || count == axes) {
        EXPECT_EQ(why, "accepted");
        EXPECT_EQ(got.records[0].angular_momentum, sent.records[0].angular_momentum);
      } else {
        EXPECT_EQ(why, fmt::format("advanced.records[0].angular_momentum has {} numbers where {} "
                                   "belong",
                                   count, axes));
      }
    }
  }
}

TEST(Codec, AReusedMessageHoldsNothingOfTheLastOne) {
  v1::Advance wire;
  encode(full_advance(), wire);
  Advance bare;
  bare.window = TimeWindow{1, 0.0, 1.0};
  bare.boundary.resize(2);
  encode(bare, wire);
  Advance got = full_advance();
  decode(wire, two_ports(), met, got);
  EXPECT_FALSE(got.boundary[0].closed());
  EXPECT_TRUE(got.boundary[0].impulse.empty());
  EXPECT_EQ(got.sampling, Sampling::substeps);
}

TEST(Codec, ALookAheadIsOfItsTimeAlone) {
  Response sent = full_response();
  Waveform& look = sent.ports[1].ahead = Waveform(1);
  look.time = {0.2, 0.3, 0.5};
  look.u = {1.0, 2.0, 4.0};
  Advance asked = bare_advance();
  asked.ahead = 0.3;
  Response got;
  decode(through_bytes(sent, asked), two_ports(), asked, got);
  expect_equal(got.ports[1].ahead, look);
  EXPECT_TRUE(got.ports[0].ahead.empty());
  for (const double other : {0.0, 0.4}) {  // not asked for; asked for another time
    Advance unlike = asked;
    unlike.ahead = other;
    EXPECT_THROW(decode(through_bytes(sent, asked), two_ports(), unlike, got), CodecError)
        << other;
  }
}

/// A body that two rigid motions are left to: where they are, and what is left over along them.
TEST(Codec, LooseMotionsKeepTheirPlaces) {
  Description body;
  body.name = "floats";
  body.dim = 2;
  body.loose = {1.0, 0.0, 0.5, 0.0, 1.0, -0.25};
  Description told;
  decode(through_bytes<Description, v1::Description>(body), told);
  EXPECT_EQ(told.loose, body.loose);
  Advance sent = bare_advance();
  sent.boundary.clear();
  sent.carry = {1.0, 2.0, 3.0, 4.0};
  Advance got;
  decode(through_bytes<Advance, v1::Advance>(sent), body, {}, got);
  EXPECT_EQ(got.carry, sent.carry);
  sent.carry.pop_back();
  const auto take = [&] { decode(through_bytes<Advance, v1::Advance>(sent), body, {}, got); };
  EXPECT_EQ(refusal(take), "advance.carry has 3 values, not a multiple of 2");
  Response reply;
  reply.records.resize(1);
  reply.records[0].momentum = {0.0, 0.0};
  reply.steps = 2;
  reply.unbalanced = {-1.0, -2.0, -3.0, -4.0};
  const Advance asked = [] {
    Advance advance = bare_advance();
    advance.boundary.clear();
    return advance;
  }();
  Response read;
  decode(through_bytes(reply, asked), body, asked, read);
  EXPECT_EQ(read.unbalanced, reply.unbalanced);
  reply.steps = 1;
  const auto misread = [&] { decode(through_bytes(reply, asked), body, asked, read); };
  EXPECT_EQ(refusal(misread), "advanced.unbalanced has 4 numbers where 2 belong");
}

TEST(Codec, ResponseKeepsEveryField) {
  const Response sent = full_response();
  Response got;
  decode(through_bytes(sent, bare_advance()), two_ports(), bare_advance(), got);
  ASSERT_EQ(got.ports.size(), 2U);
  expect_equal(got.ports[0].trace, sent.ports[0].trace);
  expect_equal(got.ports[1].trace, sent.ports[1].trace);
  EXPECT_EQ(got.ports[0].lower, sent.ports[0].lower);
  EXPECT_EQ(got.ports[0].upper, sent.ports[0].upper);
  EXPECT_EQ(got.ports[0].slowest, sent.ports[0].slowest);
  EXPECT_EQ(got.ports[0].fastest, sent.ports[0].fastest);
  EXPECT_EQ(got.ports[0].speed_bound, 3.5);
  EXPECT_EQ(got.ports[0].acceleration_bound, 9.81);
  ASSERT_TRUE(got.ports[0].recoil.has_value());
  EXPECT_EQ(got.ports[0].recoil->velocity, 6.0);
  EXPECT_EQ(got.ports[0].recoil->mobility, 7.0);
  EXPECT_EQ(got.ports[0].work, -8.0);
  EXPECT_FALSE(got.ports[1].recoil.has_value());
  ASSERT_EQ(got.records.size(), 1U);
  EXPECT_EQ(got.records[0].time, 0.25);
  EXPECT_EQ(got.records[0].energy.kinetic, 1.0);
  EXPECT_EQ(got.records[0].energy.stored, 2.0);
  EXPECT_EQ(got.records[0].energy.dissipated, 3.0);
  EXPECT_EQ(got.records[0].energy.external_work, 4.0);
  EXPECT_EQ(got.records[0].momentum, sent.records[0].momentum);
  ASSERT_EQ(got.records[0].members.size(), 2U);
  for (std::size_t m : {0U, 1U}) {
    const MemberRecord& member = got.records[0].members[m];
    const MemberRecord& as_sent = sent.records[0].members[m];
    EXPECT_EQ(member.energy.kinetic, as_sent.energy.kinetic);
    EXPECT_EQ(member.energy.stored, as_sent.energy.stored);
    EXPECT_EQ(member.energy.dissipated, as_sent.energy.dissipated);
    EXPECT_EQ(member.energy.external_work, as_sent.energy.external_work);
    EXPECT_EQ(member.momentum, as_sent.momentum);
  }
  EXPECT_EQ(got.steps, 100);
  EXPECT_EQ(got.compute_seconds, 0.125);
}

TEST(Codec, ParsingIntoAUsedReplyEqualsParsingIntoAFreshOne) {
  v1::Reply used;
  v1::Reply wire;
  wire.set_number(7);
  encode(full_response(), bare_advance(), *wire.mutable_advanced());
  std::string bytes = wire.SerializeAsString();
  ASSERT_TRUE(parse_into(used, std::as_bytes(std::span<const char>(bytes))));
  Response small = full_response();
  small.ports[0].recoil.reset();
  small.ports[1].trace.clear();
  small.records.clear();
  encode(small, bare_advance(), *wire.mutable_advanced());
  wire.set_number(8);
  bytes = wire.SerializeAsString();
  ASSERT_TRUE(parse_into(used, std::as_bytes(std::span<const char>(bytes))));
  EXPECT_EQ(used.SerializeAsString(), bytes);
}

TEST(Codec, DescriptionKeepsEveryFieldAndInfinity) {
  Description sent = two_ports();
  sent.mass = infinity;
  sent.step = 1.0e-7;
  sent.can.yielding = sent.can.neighbours = true;
  sent.can.passive = sent.can.only_passive = true;
  sent.ports[1].geometry.spacing = 0.00125;
  sent.ports[1].geometry.transit = 1.25e-6;
  Description got;
  decode(through_bytes<Description, v1::Description>(sent), got);
  EXPECT_EQ(got.name, sent.name);
  EXPECT_EQ(got.model, sent.model);
  EXPECT_EQ(got.dim, 1);
  EXPECT_EQ(got.dofs, 1);
  EXPECT_EQ(got.mass, infinity);
  EXPECT_EQ(got.step, 1.0e-7);
  EXPECT_EQ(got.stable_step, infinity);
  ASSERT_EQ(got.ports.size(), 2U);
  EXPECT_EQ(got.ports[1].name, "tail");
  EXPECT_EQ(got.ports[1].geometry.points, sent.ports[1].geometry.points);
  EXPECT_EQ(got.ports[1].geometry.normals, sent.ports[1].geometry.normals);
  EXPECT_EQ(got.ports[1].geometry.spacing, 0.00125);
  EXPECT_EQ(got.ports[1].geometry.transit, 1.25e-6);
  EXPECT_TRUE(got.can.force && got.can.impulse && got.can.kernel && got.can.yielding);
  EXPECT_TRUE(got.can.neighbours && got.can.passive && got.can.only_passive);
  EXPECT_FALSE(got.can.motion || got.can.obstacle);
  EXPECT_EQ(got.measures, (std::vector<std::string>{"displacement.x.max", "energy.stored"}));
  EXPECT_EQ(got.columns, std::vector<std::string>{"clamp.reaction [N]"});
  EXPECT_EQ(got.frequencies, (std::vector<double>{0.0, 12.5}));
  EXPECT_TRUE(got.linear);
  ASSERT_EQ(got.fields.size(), 2U);
  EXPECT_EQ(got.fields[0].name, "displacement");
  EXPECT_EQ(got.fields[0].place, FieldPlace::nodes);
  EXPECT_EQ(got.fields[1].name, "stress");
  EXPECT_EQ(got.fields[1].place, FieldPlace::cells);
  EXPECT_EQ(got.fields[1].components, 6);
  ASSERT_EQ(got.members.size(), 2U);
  EXPECT_EQ(got.members[1].name, "rear");
  EXPECT_EQ(got.members[1].mass, 2.5);
  EXPECT_EQ(got.members[1].ports, std::vector<std::int32_t>{1});
}

TEST(Codec, ConfigureKeepsEveryField) {
  Specification from{"scene.yaml", "text", {"a=1", "b=2"}, "bodies.left", {}};
  for (const int bit : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    const auto is = [bit](int k) { return k == bit; };
    PortPartner partner{"hit", "right", "tip",        is(0),  is(1),
                        is(2), is(3),   std::nullopt, "keys", 0xfedcba9876543210u};
    if (bit % 2 == 0) partner.overlap = OverlapRole{is(4), is(6), is(8), is(10)};
    from.context = {{{"tip", is(5), is(7), is(9), {partner, {}}}, {}}, is(3), 1u};
    v1::Configure wire, parsed;
    encode(from, wire);
    ASSERT_TRUE(parsed.ParseFromString(wire.SerializeAsString()));
    Specification to;
    decode(parsed, to);
    EXPECT_EQ(to.document + to.text + to.path, from.document + from.text + from.path);
    EXPECT_EQ(to.overrides, from.overrides);
    EXPECT_EQ(to.context, from.context) << bit;
    EXPECT_EQ(to.context.ports.at(1).alike, true);
  }
}

TEST(Codec, EveryCauseOfFailureComesBack) {
  for (const Failed::Cause cause : {Failed::Cause::no_convergence, Failed::Cause::inverted_element,
                                    Failed::Cause::step_too_small, Failed::Cause::non_finite}) {
    Failed got;
    decode(through_bytes<Failed, v1::Failed>(Failed{cause, 0.5, "why"}), got);
    EXPECT_EQ(got.cause, cause);
    EXPECT_EQ(got.time, 0.5);
    EXPECT_EQ(got.detail, "why");
  }
}

// Identity: what is refused is what is not below the number whose square is still finite many times
// over, at every place and of either sign.
TEST(Codec, WaveformsHoldNumbersAloneWhoseSquaresAreFinite) {
  using Limits = std::numeric_limits<double>;
  const Description body = two_ports();
  constexpr double limit = 0x1.0p499;
  for (const double value :
       {0.0, 1.0, std::nextafter(limit, 0.0), limit, 1.0e155, Limits::max(), Limits::denorm_min(),
        Limits::min(), infinity, nan_value, Limits::signaling_NaN()}) {
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t place = 0; place < full_response().ports[1].trace.f.size(); ++place) {
        Response response = full_response(), got;
        response.ports[1].trace.f[place] = std::copysign(value, sign);
        const v1::Advanced wire = through_bytes(response, bare_advance());
        const std::string why = refusal([&] { decode(wire, body, bare_advance(), got); });
        EXPECT_EQ(why == "accepted", value < limit) << value << ' ' << sign << ' ' << why;
      }
    }
  }
}

TEST(Codec, UnsoundResponsesAreRefusedByFieldName) {
  const Description body = two_ports();
  const auto refused = [&body](const std::function<void(Response&)>& spoil) {
    Response response = full_response();
    spoil(response);
    const v1::Advanced wire = through_bytes(response, bare_advance());
    return refusal([&wire, &body] {
      Response got;
      decode(wire, body, bare_advance(), got);
    });
  };
  EXPECT_EQ(refused([](Response& r) { r.ports[1].trace.f[2] = nan_value; }),
            "advanced.ports[1].trace.f is not finite: entry 2 is nan");
  EXPECT_EQ(refused([](Response& r) { r.records[0].energy.stored = infinity; }),
            "advanced.records[0].stored is not finite: inf");
  EXPECT_EQ(refused([](Response& r) { r.records[0].members.pop_back(); }),
            "advanced.records[0].members has 1 entries for 2 members");
  EXPECT_EQ(refused([](Response& r) { r.records[0].members[1].momentum = {infinity}; }),
            "advanced.records[0].members[1].momentum is not finite: entry 0 is inf");
  EXPECT_EQ(refused([](Response& r) { r.ports[0].trace.u.pop_back(); }),
            "advanced.ports[0].trace.u has 2 numbers where 3 belong");
  EXPECT_EQ(refused([](Response& r) { r.ports[0].trace.time[1] = r.ports[0].trace.time[0]; }),
            "advanced.ports[0].trace.time does not increase at entry 1");
  EXPECT_EQ(refused([](Response& r) { r.ports[0].trace = wave(2, 0.0); }),
            "advanced.ports[0].trace.width is 2, but 1 points of dimension 1 are 1 numbers");
  EXPECT_EQ(refused([](Response& r) { r.ports.pop_back(); }),
            "advanced.ports has 1 entries for 2 ports");
}

TEST(Codec, UnsoundRequestsAreRefusedByFieldName) {
  const auto refused = [](const std::function<void(v1::Advance&)>& spoil) {
    v1::Advance wire;
    encode(full_advance(), wire);
    spoil(wire);
    return refusal([&wire] {
      Advance got;
      decode(wire, two_ports(), met, got);
    });
  };
  EXPECT_EQ(refused([](v1::Advance& a) { a.clear_window(); }), "advance.window is missing");
  EXPECT_EQ(refused([](v1::Advance& a) { a.set_records(most_records + 1); }),
            "advance.records is 1000001, not 1 to 1000000");
  EXPECT_EQ(refused([](v1::Advance& a) { a.set_sampling(v1::SAMPLING_UNSPECIFIED); }),
            "advance.sampling has an unknown value");
  EXPECT_EQ(refused([](v1::Advance& a) {
              a.mutable_boundary(0)->mutable_forces(0)->set_support(v1::FORCE_SUPPORT_UNSPECIFIED);
            }),
            "advance.boundary[0].forces[0].support has an unknown value 0");
  EXPECT_EQ(refused([](v1::Advance& a) { a.mutable_boundary(0)->set_impulse(0, nan_value); }),
            "advance.boundary[0].impulse is not finite: entry 0 is nan");
  EXPECT_EQ(refused([](v1::Advance& a) { a.mutable_boundary()->RemoveLast(); }),
            "advance.boundary has 1 entries for 2 ports");
}

TEST(Frame, EveryFlippedBitAndEveryCutIsRecognised) {
  v1::Reply reply;
  reply.set_number(3);
  encode(full_response(), bare_advance(), *reply.mutable_advanced());
  Frame frame;
  frame.seal(reply);
  const std::vector<std::byte> sound(frame.bytes().begin(), frame.bytes().end());
  ASSERT_TRUE(open_frame(sound).has_value());
  for (std::size_t i = 0; i < sound.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<std::byte> damaged = sound;
      damaged[i] ^= std::byte{1} << bit;
      EXPECT_FALSE(open_frame(damaged).has_value()) << "byte " << i << " bit " << bit;
    }
    EXPECT_FALSE(open_frame(Bytes(sound.data(), i)).has_value()) << "cut at " << i;
  }
}

}  // namespace
}  // namespace abut::codec_test
