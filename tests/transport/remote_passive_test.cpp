// Goal: a body in its passive form does elsewhere what it does here, through whatever the transport
// does to messages; what a stranger answers amiss is refused in words.
// Oracles: the same calls on a body without any transport, bit for bit; the closed form of the
// body's energy and compliance [M.128, M.129]; the words of the error.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "tests/support/star_body.hpp"
#include "tests/transport/loop.hpp"

namespace abut::remote_passive_test {
namespace {

using Star = LoopOf<StarBody>;

/// A star whose springs do not let go once they are longer than a hair.
struct Stubborn : StarBody {
  Stubborn() { longest = 1.0e-6; }
};
struct Formless : StarBody {
  Formless() { description_.can.passive = false; }
};

/// A step whose impulses depend on its number, so that no two are alike.
PassiveStep step_of(int number, bool pushed = true) {
  PassiveStep step;
  step.begin = 0.1 * number;
  step.end = 0.1 * (number + 1);
  step.impulses.resize(2);
  if (pushed) {
    for (int k = 0; k < 6; ++k) step.impulses[0].push_back(std::sin(1.0 + 6 * number + k));
    if (number % 2 == 1) step.impulses[1] = {0.5, -0.25 * number, 1.0};
  }
  step.pressed = {number % 3 == 0 ? std::vector<std::int32_t>{0, 1} : std::vector<std::int32_t>{1},
                  number % 2 == 0 ? std::vector<std::int32_t>{} : std::vector<std::int32_t>{0}};
  return step;
}

bool advanced(const Outcome& outcome) { return std::holds_alternative<Advanced>(outcome); }

/// What a passive step told, as one list of numbers.
std::vector<double> numbers_of(const PassiveReply& reply) {
  std::vector<double> all = reply.compliance;
  for (const PassiveReply::Port& port : reply.ports) {
    all.insert(all.end(), port.displacement.begin(), port.displacement.end());
    all.insert(all.end(), port.velocity.begin(), port.velocity.end());
  }
  const Energy& energy = reply.record.energy;
  for (const double one : {reply.record.time, energy.kinetic, energy.stored, energy.dissipated,
                           energy.external_work, reply.bulge, reply.held})
    all.push_back(one);
  all.insert(all.end(), reply.record.momentum.begin(), reply.record.momentum.end());
  return all;
}

/// A flight, into the form, steps with a rewind each, some damping, out of it, and a flight; all
/// that was told.
std::vector<double> play(Subdomain& body, int steps) {
  std::vector<double> told;
  const auto fly = [&](double begin, double end) {
    Advance flight;
    flight.window = {0, begin, end};
    flight.records = 2;
    flight.boundary.resize(2);
    Response response;
    EXPECT_TRUE(advanced(body.advance(flight, response)));
    told.insert(told.end(), response.ports[1].trace.u.begin(), response.ports[1].trace.u.end());
    told.push_back(response.records[1].energy.kinetic);
  };
  fly(-0.1, 0.0);
  PassiveForm& form = *body.passive();
  told.push_back(form.enter());
  PassiveReply reply;
  for (int k = 0; k < steps; ++k) {
    body.save();
    for (const bool again : {false, true}) {
      if (again) body.restore();
      const PassiveStep step = step_of(k, again);
      form.start(step);
      EXPECT_TRUE(advanced(form.finish(reply)));
      const std::vector<double> numbers = numbers_of(reply);
      told.insert(told.end(), numbers.begin(), numbers.end());
    }
    if (k % 2 == 0) told.push_back(form.damp(0.125 * (k + 1)));
  }
  double lost = std::nan("");
  EXPECT_TRUE(advanced(form.leave(0.1 * steps, lost)));
  told.push_back(lost);
  fly(0.1 * steps, 0.1 * steps + 0.05);
  return told;
}

TEST(RemotePassive, IsTheBodysBitForBitUnderFaultsOfTheTransport) {
  StarBody local;
  const std::vector<double> expected = play(local, 5);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const FaultyChannel::Chances rough{
        .drop = 0.1, .delay = 0.15, .duplicate = 0.15, .corrupt = 0.05};
    Star loop(seed > 0 ? rough : FaultyChannel::Chances{},
              seed > 0 ? rough : FaultyChannel::Chances{}, 2 * seed);
    loop.configure();
    ASSERT_EQ(play(loop.body, 5), expected) << "seed " << seed;
    ASSERT_EQ(loop.body.state_hash(), local.state_hash()) << "seed " << seed;
    ASSERT_EQ(loop.fake->counts.steps, local.counts.steps);
    ASSERT_EQ(loop.fake->counts.enters, 1);
    ASSERT_EQ(loop.fake->counts.leaves, 1);
    ASSERT_EQ(loop.fake->counts.damps, local.counts.damps);
    ASSERT_EQ(loop.fake->counts.saves, local.counts.saves);
    ASSERT_EQ(loop.fake->counts.restores, local.counts.restores);
  }
}

// Identity [M.128]: what impulses and gravity do is what the energy gains. [M.129]: what an impulse
// adds to the mean velocity is the compliance's column, of all ports in their order.
TEST(RemotePassive, TellsEnergyAndComplianceInTheOrderOfPorts) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  EXPECT_EQ(form.enter(), 0.0);
  PassiveStep step = step_of(0, false);
  step.pressed = {{0, 1}, {0}};
  PassiveReply free, pushed;
  loop.body.save();
  form.start(step);
  ASSERT_TRUE(advanced(form.finish(free)));
  // Before it moved, all 2.5 kg at one velocity.
  const double before = 0.5 * 2.5 * (1.0 + 0.25 + 4.0);
  const std::size_t values = 9;
  ASSERT_EQ(free.compliance.size(), values * values);
  const auto displacement = [](const PassiveReply& reply, std::size_t k) {
    return k < 6 ? reply.ports[0].displacement[k] : reply.ports[1].displacement[k - 6];
  };
  for (std::size_t k = 0; k < values; ++k) {
    step.impulses = {std::vector<double>(6, 0.0), std::vector<double>(3, 0.0)};
    (k < 6 ? step.impulses[0][k] : step.impulses[1][k - 6]) = 3.0;
    loop.body.restore();
    form.start(step);
    ASSERT_TRUE(advanced(form.finish(pushed)));
    for (std::size_t i = 0; i < values; ++i) {
      const double more = (displacement(pushed, i) - displacement(free, i)) / (3.0 * step.length());
      EXPECT_NEAR(more, pushed.compliance[i * values + k], 1.0e-13);  // of values of 2: rounding
    }
    const double work = 3.0 * displacement(pushed, k) / step.length();  // all begin at nothing
    const Energy& after = pushed.record.energy;
    EXPECT_NEAR(after.total() - before, work + after.external_work, 1.0e-12);  // J of 10: rounding
  }
}

TEST(RemotePassive, LeavesWithTheEnergyThatItLoses) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  const PassiveStep step = step_of(0);
  PassiveReply reply;
  form.start(step);
  ASSERT_TRUE(advanced(form.finish(reply)));
  double square = 0.0, lost = 0.0;
  for (const double p : reply.record.momentum) square += p * p;
  ASSERT_TRUE(advanced(form.leave(step.end, lost)));
  // It flies on as one mass: what is left is that of its momentum, 2.5 kg.
  EXPECT_NEAR(lost, reply.record.energy.total() - square / 5.0, 1.0e-12);  // J of 10: rounding
  EXPECT_GT(lost, 0.1);
}

TEST(RemotePassive, DampsAsMuchAsThereIs) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  const PassiveStep step = step_of(0);
  PassiveReply reply;
  form.start(step);
  ASSERT_TRUE(advanced(form.finish(reply)));
  EXPECT_EQ(form.damp(0.01), 0.01);
  const double all = form.damp(1.0e9);
  EXPECT_GT(all, 0.1);
  EXPECT_LT(all, reply.record.energy.kinetic);
  EXPECT_NEAR(form.damp(1.0e9), 0.0, 1.0e-12);  // J of 10: rounding
}

TEST(RemotePassive, StartSendsAndFinishWaits) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  const int before = loop.to_solver.counts().sent;
  loop.body.save();
  const PassiveStep step = step_of(0);
  form.start(step);
  EXPECT_EQ(loop.to_solver.counts().sent - before, 1);  // with the save
  EXPECT_EQ(loop.fake->counts.steps, 0);                // others can be started meanwhile
  PassiveReply reply;
  EXPECT_TRUE(advanced(form.finish(reply)));
  EXPECT_EQ(loop.fake->counts.steps, 1);
  EXPECT_EQ(loop.fake->counts.saves, 1);
  EXPECT_EQ(loop.to_solver.counts().sent - before, 1);
}

TEST(RemotePassive, RestoreTakesEnteringAndLeavingBack) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  const std::uint64_t own = loop.body.state_hash();
  loop.body.save();
  form.enter();
  const std::uint64_t passive = loop.body.state_hash();
  EXPECT_NE(passive, own);
  loop.body.restore();
  EXPECT_EQ(loop.body.state_hash(), own);
  form.enter();
  loop.body.save();
  double lost = 0.0;
  EXPECT_TRUE(advanced(form.leave(0.0, lost)));
  EXPECT_EQ(loop.body.state_hash(), own);
  loop.body.restore();
  EXPECT_EQ(loop.body.state_hash(), passive);
}

TEST(RemotePassive, FailuresAreValuesAndTheBodyServesOn) {
  LoopOf<Stubborn> loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  loop.body.save();
  PassiveStep step = step_of(0);
  PassiveReply reply;
  form.start(step);
  EXPECT_TRUE(advanced(form.finish(reply)));
  const std::uint64_t before = loop.body.state_hash();
  double lost = -7.0;
  const Outcome held = form.leave(step.end, lost);
  ASSERT_TRUE(std::holds_alternative<Failed>(held));
  EXPECT_EQ(std::get<Failed>(held).detail, "a spring does not let go");
  EXPECT_EQ(std::get<Failed>(held).time, step.end);
  EXPECT_EQ(lost, -7.0);
  EXPECT_EQ(loop.body.state_hash(), before);
  step.impulses[0][0] = 1.0e149;
  form.start(step);
  const Outcome gone = form.finish(reply);
  ASSERT_TRUE(std::holds_alternative<Failed>(gone));
  EXPECT_EQ(std::get<Failed>(gone).cause, Failed::Cause::non_finite);
  loop.body.restore();
  step = step_of(0);
  form.start(step);
  EXPECT_TRUE(advanced(form.finish(reply)));
  EXPECT_EQ(loop.body.state_hash(), before);
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const RunError& error) {
    return error.what_is_wrong;
  }
  return "no error";
}

TEST(RemotePassive, ABodyWithoutTheFormHasNoneAndSaysSoWhenAsked) {
  LoopOf<Formless> loop;
  loop.configure();
  EXPECT_FALSE(loop.body.describe().can.passive);
  EXPECT_EQ(loop.body.passive(), nullptr);
  const PassiveStep step = step_of(0);
  const std::function<void()> asks[] = {[&] {
                                          loop.caller.request().mutable_passive_enter();
                                          loop.caller.call("it");
                                        },
                                        [&] {
                                          loop.caller.request().mutable_passive_leave();
                                          loop.caller.call("it");
                                        },
                                        [&] {
                                          loop.caller.request().mutable_passive_damp();
                                          loop.caller.call("it");
                                        },
                                        [&] {
                                          loop.caller.post(step);
                                          loop.caller.await();
                                        }};
  for (const std::function<void()>& ask : asks) {
    const std::string error = error_of(ask);
    EXPECT_TRUE(error.starts_with("body 'fake' failed at ") &&
                error.ends_with(": the body has no passive form"))
        << error;
  }
  loop.body.state_hash();  // it serves on
  Loop flat;               // and so has one that never heard of it
  flat.configure();
  EXPECT_EQ(flat.body.passive(), nullptr);
}

TEST(RemotePassive, ARequestThatIsUnsoundIsAFaultInWords) {
  Star loop;
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  PassiveReply reply;
  PassiveStep step = step_of(0);
  step.impulses[1] = {1.0};
  EXPECT_EQ(error_of([&] {
              form.start(step);
              (void)form.finish(reply);
            }),
            "body 'fake' failed at passive step (request 3): unsound request: "
            "passive_step.ports[1].impulse has 1 numbers where 3 belong");
  EXPECT_EQ(error_of([&] { form.damp(-1.0); }),
            "body 'fake' failed at passive damp (request 4): unsound request: "
            "passive_damp.joules is negative: -1");
  double lost = 0.0;
  EXPECT_EQ(error_of([&] { (void)form.leave(std::nan(""), lost); }),
            "body 'fake' failed at passive leave (request 5): unsound request: "
            "passive_leave.time is not finite: nan");
  EXPECT_EQ(loop.fake->counts.steps + loop.fake->counts.damps + loop.fake->counts.leaves, 0);
}

TEST(RemotePassive, WhatAStrangerAnswersAmissIsRefusedByName) {
  const auto refused = [](const std::function<void(PassiveReply&)>& spoil) {
    Star loop;
    loop.configure();
    PassiveForm& form = *loop.body.passive();
    form.enter();
    loop.fake->spoil = spoil;
    const PassiveStep step = step_of(0);  // two points are pressed
    PassiveReply reply;
    const std::string error = error_of([&] {
      form.start(step);
      (void)form.finish(reply);
    });
    const std::string before = "body 'fake' gave no sound answer to passive step (request 3): ";
    return error.starts_with(before) ? error.substr(before.size()) : error;
  };
  EXPECT_EQ(refused([](PassiveReply&) {}), "no error");
  EXPECT_EQ(refused([](PassiveReply& r) { r.compliance.resize(9); }),
            "passive_stepped.compliance has 9 numbers where 36 belong");
  EXPECT_EQ(refused([](PassiveReply& r) { r.ports[0].displacement.pop_back(); }),
            "passive_stepped.ports[0].displacement has 5 numbers where 6 belong");
  EXPECT_EQ(refused([](PassiveReply& r) { r.ports[1].velocity[0] = std::nan(""); }),
            "passive_stepped.ports[1].velocity is not finite: entry 0 is nan");
  EXPECT_EQ(refused([](PassiveReply& r) {
              for (double& one : r.compliance) one = -one;
            }).substr(0, 56),
            "passive_stepped.compliance moves against an impulse on v");
  EXPECT_EQ(refused([](PassiveReply& r) { r.record.time += 0.05; }),
            "passive_stepped.record.time is 0.15000000000000002 s, where 0.1 s belongs");
}

/// Answers every request after Configure with a reply of this kind.
std::string answered_by(const std::function<void(v1::Reply&)>& fill,
                        const std::function<void(PassiveForm&)>& ask) {
  Star loop;
  loop.configure();
  loop.deaf = true;
  v1::Reply reply;
  reply.set_number(2);
  reply.set_session(loop.server.session());
  fill(reply);
  Frame frame;
  frame.seal(reply);
  loop.link.on_idle([&] { loop.link.far().send(frame.bytes()); });
  return error_of([&] { ask(*loop.body.passive()); });
}

TEST(RemotePassive, AReplyOfAnotherKindIsRefused) {
  const auto hash = [](v1::Reply& reply) { reply.mutable_hash(); };
  const std::string before = "body 'fake' gave no sound answer to passive ";
  double lost = 0.0;
  EXPECT_EQ(answered_by(hash, [](PassiveForm& form) { form.enter(); }),
            before + "enter (request 2): not an entry into the passive form");
  EXPECT_EQ(answered_by(hash, [&](PassiveForm& form) { (void)form.leave(0.0, lost); }),
            before + "leave (request 2): not a leave from the passive form");
  EXPECT_EQ(answered_by(hash, [](PassiveForm& form) { form.damp(1.0); }),
            before + "damp (request 2): not a damping of the passive form");
  EXPECT_EQ(answered_by(hash,
                        [](PassiveForm& form) {
                          const PassiveStep step = step_of(0);
                          PassiveReply reply;
                          form.start(step);
                          (void)form.finish(reply);
                        }),
            before + "step (request 2): not a passive step");
  const double nan_value = std::nan("");
  EXPECT_EQ(answered_by([&](v1::Reply& r) { r.mutable_passive_entered()->set_lost(nan_value); },
                        [](PassiveForm& form) { form.enter(); }),
            before + "enter (request 2): passive_entered.lost is not finite: nan");
  EXPECT_EQ(answered_by([&](v1::Reply& r) { r.mutable_passive_left()->set_lost(nan_value); },
                        [&](PassiveForm& form) { (void)form.leave(0.0, lost); }),
            before + "leave (request 2): passive_left.lost is not finite: nan");
  EXPECT_EQ(answered_by([&](v1::Reply& r) { r.mutable_passive_damped()->set_taken(nan_value); },
                        [](PassiveForm& form) { form.damp(1.0); }),
            before + "damp (request 2): passive_damped.taken is not finite: nan");
}

TEST(RemotePassive, EnergiesThatAreToldArrive) {
  double got = 0.0;
  EXPECT_EQ(answered_by([](v1::Reply& r) { r.mutable_passive_entered()->set_lost(1.0 / 3.0); },
                        [&](PassiveForm& form) { got = form.enter(); }),
            "no error");
  EXPECT_EQ(got, 1.0 / 3.0);
}

TEST(RemotePassive, AComplianceThatNoFrameHoldsIsRefusedBeforeItIsMade) {
  Limits limits;
  limits.frame_bytes = 640;  // 9 values are 648 bytes
  Star loop({}, {}, 0, limits);
  loop.configure();
  PassiveForm& form = *loop.body.passive();
  form.enter();
  PassiveStep step = step_of(0);
  step.pressed = {{0, 1}, {0}};
  PassiveReply reply;
  try {
    form.start(step);
    (void)form.finish(reply);
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_EQ(error.what_is_wrong,
              "body 'fake' failed at passive step (request 3): the compliance of 9 pressed values "
              "is a frame of more than 648 bytes, above the limit of 640");
    EXPECT_EQ(error.remedy,
              "take a coarser mesh where bodies touch, or run with --local, which has no frames");
  }
  EXPECT_EQ(loop.fake->counts.steps, 0);
}

}  // namespace
}  // namespace abut::remote_passive_test
