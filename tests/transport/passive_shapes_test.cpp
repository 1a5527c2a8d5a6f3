// Goal: steps of the passive form and their replies arrive as they were sent, whatever the shapes
// of ports; what does not fit body or step is refused by the name of the field.
// Oracle: what arrived encodes to the bytes that were sent, which protobuf's own classes read and
// write too; the words of the error.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/index.hpp"
#include "messaging/codec.hpp"
#include "messaging/soundness.hpp"
#include "tests/transport/shape_dice.hpp"
#include "tests/transport/wire_bytes.hpp"

namespace abut::passive_shapes_test {
namespace {

/// A body with some ports, a step, and the reply to it.
struct Talk {
  explicit Talk(std::uint64_t seed) : dice(seed) {
    body.dim = 1 + dice.upto(2);
    body.mass = dice.coin() ? std::numeric_limits<double>::infinity() : 2.0;
    body.columns = {"clamp [N]"};
    if (dice.coin()) body.members = {{"all of it", 2.0, {0}}};
    step.begin = dice.coin() ? 0.0 : dice.value();
    step.end = step.begin + 0.5 + dice.value();
    step.looser = dice.coin() ? 0 : dice.upto(PassiveStep::loosest);
    step.again = dice.coin();
    for (int p = dice.upto(3); p >= 0; --p) {
      body.ports.push_back({"port" + std::to_string(p), dice.surface(body.dim), false});
      const SurfaceSize size = size_of(body.ports.back().geometry);
      step.impulses.push_back(dice.values(dice.coin() ? index(size.width()) : 0));
      step.pressed.push_back(dice.coin() ? dice.points(size.points) : std::vector<std::int32_t>());
      reply.ports.push_back({dice.values(index(size.width())), dice.values(index(size.width()))});
    }
    const std::size_t values = pressed_values(step, body);
    reply.compliance = dice.values(values * values);
    reply.record.time = step.end;
    reply.record.energy = {dice.value(), dice.value(), dice.value(), dice.value()};
    reply.record.momentum = dice.values(index(body.dim));
    reply.record.columns = {dice.value()};
    for (std::size_t m = 0; m < body.members.size(); ++m)
      reply.record.members.push_back(
          {{dice.value(), dice.value(), dice.value(), dice.value()}, dice.values(index(body.dim))});
    reply.bulge = dice.coin() ? 0.0 : 0.5 + dice.value();
    reply.held = dice.coin() ? 0.0 : 0.5 + dice.value();
    reply.compute_seconds = dice.coin() ? 0.0 : 0.5 + dice.value();
  }

  Dice dice;
  Description body;
  PassiveStep step;
  PassiveReply reply;
};

template <class Wire, class From>
std::string bytes_of(const From& from) {
  Wire wire;
  encode(from, wire);
  return wire.SerializeAsString();
}

void expect_equal(const PassiveStep& got, const PassiveStep& sent) {
  EXPECT_EQ(got.begin, sent.begin);
  EXPECT_EQ(got.end, sent.end);
  EXPECT_EQ(got.impulses, sent.impulses);
  EXPECT_EQ(got.pressed, sent.pressed);
  EXPECT_EQ(got.looser, sent.looser);
  EXPECT_EQ(got.again, sent.again);
}

void expect_equal(const PassiveReply& got, const PassiveReply& sent) {
  ASSERT_EQ(got.ports.size(), sent.ports.size());
  for (std::size_t p = 0; p < sent.ports.size(); ++p) {
    EXPECT_EQ(got.ports[p].displacement, sent.ports[p].displacement);
    EXPECT_EQ(got.ports[p].velocity, sent.ports[p].velocity);
  }
  EXPECT_EQ(got.compliance, sent.compliance);
  EXPECT_EQ(bytes_of<v1::PassiveStepped>(got), bytes_of<v1::PassiveStepped>(sent));  // the record
  EXPECT_EQ(got.bulge, sent.bulge);
  EXPECT_EQ(got.compute_seconds, sent.compute_seconds);
}

TEST(PassiveShapes, StepsAndRepliesComeBackAsTheyWereSent) {
  PassiveStep step;  // used again and again: nothing of an earlier message stays
  PassiveReply reply;
  int pressed = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    SCOPED_TRACE(seed);
    const Talk talk(seed);
    v1::PassiveStep asked;
    encode(talk.step, asked);
    decode(asked, talk.body, step);
    expect_equal(step, talk.step);
    v1::PassiveStepped answered;
    encode(talk.reply, answered);
    decode(answered, talk.body, step, reply);
    expect_equal(reply, talk.reply);
    pressed += reply.compliance.empty() ? 0 : 1;
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(pressed, 500);  // and as many that press nowhere
  EXPECT_LT(pressed, 1900);
}

TEST(PassiveShapes, AParsedMessageHoldsNothingOfTheOneBefore) {
  // Steps among other kinds, each into the same message: the mark is of the last one alone.
  v1::Request request;
  const Talk talk(3);
  for (int turn = 0; turn < 30; ++turn) {
    v1::Request wire;
    wire.set_number(index(turn) + 1);
    wire.set_save_first(turn % 2 == 0);
    if (turn % 3 == 0) encode(talk.step, *wire.mutable_passive_step());
    if (turn % 5 == 0) wire.mutable_hash();
    if (turn % 7 == 0) wire.mutable_advance()->set_records(3);
    const std::string bytes = wire.SerializeAsString();
    Bytes bulk;
    ASSERT_TRUE(parse_into(request, as_bytes(bytes), bulk));
    EXPECT_EQ(request.body_case(), wire.body_case()) << turn;
    EXPECT_EQ(request.number(), wire.number());
    EXPECT_EQ(request.save_first(), wire.save_first());
    EXPECT_EQ(bulk.empty(), !wire.has_passive_step() && !wire.has_advance());
    if (!wire.has_passive_step()) continue;
    PassiveStep got;
    decode(bulk, talk.body, got);
    expect_equal(got, talk.step);
  }
}

/// A block of two squares on top and one point below, pressed on three points.
struct Block {
  Block() {
    body.dim = 3;
    body.mass = 2.0;
    body.ports.resize(2);
    body.ports[0].geometry.dim = body.ports[1].geometry.dim = 3;
    body.ports[0].geometry.points.assign(18, 0.5);
    body.ports[1].geometry.points.assign(3, 0.25);
    step.begin = 1.0;
    step.end = 1.5;
    step.impulses = {std::vector<double>(18, 0.5), {}};
    step.pressed = {{1, 4}, {0}};
    reply.ports = {{std::vector<double>(18, 0.1), std::vector<double>(18, 0.2)},
                   {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}}};
    reply.compliance.assign(81, 0.0);
    for (std::size_t i = 0; i < 9; ++i) reply.compliance[10 * i] = 2.0;
    reply.compliance[1] = reply.compliance[9] = 0.5;
    reply.record.time = 1.5;
    reply.record.momentum = {0.0, 0.0, 1.0};
  }
  Description body;
  PassiveStep step;
  PassiveReply reply;
};

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const CodecError& error) {
    return error.what();
  }
  return "accepted";
}

std::string asked(const std::function<void(PassiveStep&)>& spoil) {
  Block block;
  spoil(block.step);
  return refusal([&] {
    PassiveStep got;
    v1::PassiveStep wire;
    encode(block.step, wire);
    decode(wire, block.body, got);
  });
}

std::string answered(const std::function<void(PassiveReply&)>& spoil) {
  Block block;
  spoil(block.reply);
  return refusal([&] {
    PassiveReply got;
    v1::PassiveStepped wire;
    encode(block.reply, wire);
    decode(wire, block.body, block.step, got);
    require_sound(got, block.body, block.step);
  });
}

TEST(PassiveShapes, StepsThatDoNotFitTheBodyAreRefused) {
  EXPECT_EQ(asked([](PassiveStep&) {}), "accepted");
  EXPECT_EQ(asked([](PassiveStep& s) { s.impulses[0].pop_back(); }),
            "passive_step.ports[0].impulse has 17 numbers where 18 belong");
  EXPECT_EQ(asked([](PassiveStep& s) { s.impulses[0][3] = std::nan(""); }),
            "passive_step.ports[0].impulse is not finite: entry 3 is nan");
  EXPECT_EQ(asked([](PassiveStep& s) { s.pressed[1] = {1}; }),
            "passive_step.ports[1].pressed names point 1, but the surface has 1");
  EXPECT_EQ(asked([](PassiveStep& s) {
              s.pressed[0] = {4, 1};
            }),
            "passive_step.ports[0].pressed does not ascend at entry 1");
  EXPECT_EQ(asked([](PassiveStep& s) { s.pressed.pop_back(), s.impulses.pop_back(); }),
            "passive_step.ports has 1 entries for 2 ports");
  EXPECT_EQ(asked([](PassiveStep& s) { s.pressed.resize(3), s.impulses.resize(3); }),
            "passive_step.ports has more entries than the body's 2 ports");
  EXPECT_EQ(asked([](PassiveStep& s) { s.end = s.begin - 1.0; }), "passive_step is from 1 to 0 s");
  EXPECT_EQ(asked([](PassiveStep& s) { s.end = s.begin; }), "accepted");  // tells where it is
  EXPECT_EQ(asked([](PassiveStep& s) { s.end = std::numeric_limits<double>::infinity(); }),
            "passive_step.end is not finite: inf");
  for (const std::int32_t wrong : {-1, 21})
    EXPECT_EQ(asked([wrong](PassiveStep& s) { s.looser = wrong; }),
              fmt::format("passive_step.looser is {}, not within 0 and 20", wrong));
}

TEST(PassiveShapes, RepliesThatDoNotFitTheStepAreRefused) {
  EXPECT_EQ(answered([](PassiveReply&) {}), "accepted");
  EXPECT_EQ(answered([](PassiveReply& r) { r.ports.pop_back(); }),
            "passive_stepped.ports has 1 entries for 2 ports");
  EXPECT_EQ(answered([](PassiveReply& r) { r.ports.resize(3); }),
            "passive_stepped.ports has more entries than the body's 2 ports");
  EXPECT_EQ(answered([](PassiveReply& r) { r.ports[0].displacement.push_back(0.0); }),
            "passive_stepped.ports[0].displacement has 19 numbers where 18 belong");
  EXPECT_EQ(answered([](PassiveReply& r) { r.ports[1].velocity.clear(); }),
            "passive_stepped.ports[1].velocity has 0 numbers where 3 belong");
  EXPECT_EQ(answered([](PassiveReply& r) { r.ports[1].velocity[2] = 1.0e200; }),
            "passive_stepped.ports[1].velocity is too large: entry 2 is 1e+200");
  for (const std::size_t count : {0u, 9u, 80u, 82u, 100u})
    EXPECT_EQ(answered([&](PassiveReply& r) { r.compliance.assign(count, 1.0); }),
              fmt::format("passive_stepped.compliance has {} numbers where 81 belong", count));
  EXPECT_EQ(answered([](PassiveReply& r) { r.bulge = -1.0; }),
            "passive_stepped.bulge is negative: -1");
  EXPECT_EQ(answered([](PassiveReply& r) { r.record.time = 0.0; }),
            "passive_stepped.record.time is 0 s, where 1.5 s belongs");
  EXPECT_EQ(answered([](PassiveReply& r) { r.record.momentum.clear(); }),
            "passive_stepped.record.momentum is missing");
  EXPECT_EQ(answered([](PassiveReply& r) { r.record.energy.stored = std::nan(""); }),
            "passive_stepped.record.stored is not finite: nan");
  Block block;
  v1::PassiveStepped wire;
  encode(block.reply, wire);
  wire.clear_record();
  EXPECT_EQ(refusal([&] { decode(wire, block.body, block.step, block.reply); }),
            "passive_stepped.record is missing");
}

TEST(PassiveShapes, AComplianceIsOneOfABody) {
  EXPECT_EQ(answered([](PassiveReply& r) { r.compliance[10] = -1.0; }),
            "passive_stepped.compliance moves against an impulse on value 1: -1");
  EXPECT_EQ(answered([](PassiveReply& r) { r.compliance[1] = -0.5; }),
            "passive_stepped.compliance is not symmetric: 0.5 of value 1 by value 0, -0.5 the "
            "other way");
  EXPECT_EQ(answered([](PassiveReply& r) { r.compliance[1] = r.compliance[9] = -3.0; }),
            "passive_stepped.compliance is not definite: -3 of value 1 by value 0, where values "
            "have 2 of their own at most");
  // Of what is held nothing moves; and rounding, however badly conditioned the body, is no fault.
  EXPECT_EQ(answered([](PassiveReply& r) { r.compliance.assign(81, 0.0); }), "accepted");
  EXPECT_EQ(answered([](PassiveReply& r) { r.compliance[1] += 1.0e-6, r.compliance[80] = -1e-9; }),
            "accepted");
}

TEST(PassiveShapes, AnythingThatParsesIsTakenOrRefusedInWords) {
  // A bit of a sound message is changed, or its end is cut off; sanitizers and assertions watch.
  int taken = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    const Talk talk(seed % 50);
    Dice dice(seed);
    std::string step = bytes_of<v1::PassiveStep>(talk.step);
    std::string reply = bytes_of<v1::PassiveStepped>(talk.reply);
    for (std::string* bytes : {&step, &reply}) {
      const std::size_t at = index(dice.upto(static_cast<int>(bytes->size()) - 1));
      (*bytes)[at] = static_cast<char>((*bytes)[at] ^ (1 << dice.upto(7)));
      if (dice.upto(9) == 0) bytes->resize(at);
    }
    const auto judged = [&](const std::function<void()>& act) {
      const std::string why = refusal(act);
      EXPECT_TRUE(why == "accepted" || why.starts_with("passive_step")) << why;
      ++(why == "accepted" ? taken : refused);
    };
    judged([&] {
      PassiveStep got;
      decode(as_bytes(step), talk.body, got);
    });
    judged([&] {
      PassiveReply got;
      decode(as_bytes(reply), talk.body, talk.step, got);
      const std::size_t values = pressed_values(talk.step, talk.body);
      EXPECT_EQ(got.compliance.size(), values * values);
    });
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace abut::passive_shapes_test
