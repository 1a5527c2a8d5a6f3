// Goal: what a body of somebody else tells is complete and sound, or refused by the name of the
// field; nothing that it sends breaks the reader.
// Oracle: the words of the error; for messages changed at random that they are either refused or
// decoded to a reply of the promised shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <google/protobuf/message.h>

#include "base/index.hpp"
#include "base/printable.hpp"
#include "messaging/soundness.hpp"
#include "tests/transport/stranger.hpp"

namespace abut::stranger {
namespace {

TEST(Soundness, OfWhatIsSoundNothingIsRefused) {
  EXPECT_EQ(told([](Description&) {}), "accepted");
  EXPECT_EQ(answered([](Response&) {}), "accepted");
  EXPECT_EQ(refusal([] { require_sound(kernel(), body(), probing()); }), "accepted");
}

TEST(Soundness, FacetsThatGeometryCannotRelyOnAreRefused) {
  const auto facets = [](const std::vector<std::int32_t>& nodes,
                         const std::vector<std::int32_t>& offsets) {
    return told([&](Description& d) {
      d.ports[0].geometry.facets = nodes;
      d.ports[0].geometry.offsets = offsets;
    });
  };
  const std::string where = "description.ports[0].surface.facets is unsound: facet ";
  EXPECT_EQ(facets({0, 1, 4, 5, 2, 3}, {0, 6}), where + "0 has a wrong number of nodes");
  EXPECT_EQ(facets({0, 1, 2, 3, 1}, {0, 4, 5}), where + "1 has a wrong number of nodes");
  EXPECT_EQ(facets({0, 1}, {0, 2}), where + "0 has a wrong number of nodes");
  EXPECT_EQ(facets({0, 1, 1, 3}, {0, 4}), where + "0 has a node twice");
  EXPECT_EQ(facets({0, 1, 2, 9}, {0, 4}), where + "0 has a node that is not there");
  EXPECT_EQ(facets({0, 1, 3, 2}, {0, 4}), where + "0 has no area");  // crossed
  EXPECT_EQ(facets({0, 1, 4}, {0, 3}), where + "0 has no area");     // on a line
  EXPECT_EQ(facets({0, 1, 2, 3, 1, 2, 5, 4}, {0, 4, 8}),
            where + "1 looks the other way than its neighbour");
  // A facet of 100,000 nodes is told at once: no work goes with the square of its size.
  std::vector<std::int32_t> endless(100'000);
  for (std::size_t i = 0; i < endless.size(); ++i) endless[i] = static_cast<std::int32_t>(i % 6);
  EXPECT_EQ(facets(endless, {0, 100'000}), where + "0 has a wrong number of nodes");
}

TEST(Soundness, NormalsLookWhereTheFacetsDo) {
  const std::string where = "description.ports[0].surface.normals ";
  EXPECT_EQ(told([](Description& d) { d.ports[0].geometry.normals[2] = 2.0; }),
            where + "has length 2 at point 0, not 1");
  EXPECT_EQ(told([](Description& d) {
              for (double& n : d.ports[0].geometry.normals) n = -n;
            }).substr(0, where.size() + 35),
            where + "looks against the facets at point 0");
  EXPECT_EQ(told([](Description& d) {
              d.ports[0].geometry.facets = {3, 2, 1, 0, 2, 5, 4, 1};
            }).substr(0, where.size() + 35),
            where + "looks against the facets at point 0");
}

TEST(Soundness, DescriptionsAreHeldAgainstWhatABodyCanBe) {
  EXPECT_EQ(told([](Description& d) { d.mass = 0.0; }),
            "description.mass is 0; of a body that nothing moves it is infinity");
  EXPECT_EQ(told([](Description& d) { d.loose.assign(42, 1.0); }),
            "description.loose has 7 motions, a rigid body has 6");
  EXPECT_EQ(told([](Description& d) { d.can.only_passive = true; }),
            "description.can.only_passive is told of a body without a passive form");
  EXPECT_EQ(told([](Description& d) { d.can.only_passive = d.can.passive = true; }), "accepted");
  EXPECT_EQ(told([](Description& d) { d.columns = {"heat\n[J]"}; }),
            "description.columns[0] has a control character");
  EXPECT_EQ(told([](Description& d) { d.columns = {"heat,[J]"}; }),
            "description.columns[0] has a comma or a quote");
  EXPECT_EQ(told([](Description& d) { d.model = "\x1b[2J"; }),
            "description.model has a control character");
  EXPECT_EQ(told([](Description& d) { d.model.assign(3'000'000, 'x'); }),
            "description.model has 3000000 bytes, more than 1000");
  EXPECT_EQ(told([](Description& d) { d.ports[0].geometry.spacing = 1e-300; }),
            "description.ports[0].surface.spacing is 1e-300 m, where edges of facets are 1 m");
}

TEST(Soundness, PartsOfAReplyThatAreMissingAreNamed) {
  EXPECT_EQ(answered([](Response& r) { r.ports[0].trace.clear(); }),
            "advanced.ports[0].trace is missing");
  EXPECT_EQ(answered([](Response& r) { r.ports[0].lower.clear(), r.ports[0].upper.clear(); }),
            "advanced.ports[0].lower is missing");
  EXPECT_EQ(answered([](Response& r) { r.records[1].momentum.clear(); }),
            "advanced.records[1].momentum is missing");
  Description striking = body();
  striking.can.impulse = true;
  EXPECT_EQ(refusal([&] { require_sound(reply(), striking, asked()); }),
            "advanced.ports[0].recoil is missing");
}

TEST(Soundness, BoxesAndBoundsOfSpeedAreThoseOfTheMotion) {
  EXPECT_EQ(answered([](Response& r) { std::swap(r.ports[0].lower, r.ports[0].upper); }),
            "advanced.ports[0].lower is above upper at entry 0: 2 and 0");
  EXPECT_EQ(answered([](Response& r) { r.ports[0].upper = {2, 1, 0.1, 2, 1, 0.15}; }).substr(0, 45),
            "advanced.ports[0].upper leaves out point 0, w");
  EXPECT_EQ(answered([](Response& r) {
              r.ports[0].slowest = {0, 1, 0};
              r.ports[0].fastest = {0, -1, 0};
            }),
            "advanced.ports[0].slowest is above fastest at entry 1: 1 and -1");
  EXPECT_EQ(answered([](Response& r) { r.ports[0].speed_bound = -3.0; }),
            "advanced.ports[0].speed_bound is negative: -3");
  EXPECT_EQ(answered([](Response& r) { r.ports[0].speed_bound = 0.0; }),
            "advanced.ports[0].speed_bound is 0 m/s, but the port moves at 1 m/s");
  EXPECT_EQ(answered([](Response& r) { r.ports[0].acceleration_bound = -1.0; }),
            "advanced.ports[0].acceleration_bound is negative: -1");
}

TEST(Soundness, TimesAreThoseThatWereAskedFor) {
  EXPECT_EQ(answered([](Response& r) { r.steps = 1; }),
            "advanced.ports[0].trace.time has 3 times, at most 2 belong");
  EXPECT_EQ(answered([](Response& r) { r.records[0].time = 0.1; }),
            "advanced.records[0].time is 0.1 s, where 1.1 s belongs");
}

TEST(Soundness, KernelsAreWholeAndGoAlongTheirForces) {
  const auto given = [](const std::function<void(PortKernel&)>& spoil) {
    PortKernel spoilt = kernel();
    spoil(spoilt);
    return refusal([&] { require_sound(spoilt, body(), probing()); });
  };
  EXPECT_EQ(given([](PortKernel& k) { k.begin.clear(); }),
            "kernel.begin is missing, which belongs to forces of NODAL support");
  EXPECT_EQ(given([](PortKernel& k) { k.step = 0.2; }),
            "kernel.step is 0.2 s, where 0.1 s was asked for, 1 of it off");
  EXPECT_EQ(given([](PortKernel& k) { k.step = 0.1 * (1.0 + 1.0e-12); }), "accepted");
  // Numbers that look alike are told with all that they differ in.
  EXPECT_EQ(given([](PortKernel& k) { k.step = 0.1000000123; }),
            "kernel.step is 0.1000000123 s, where 0.1 s was asked for, 1.2e-07 of it off");
  EXPECT_EQ(given([](PortKernel& k) { k.support = ForceSupport::linear; }),
            "kernel.support is LINEAR: pulses of a kernel act over a substep (STEP) or over the "
            "dual cell around its end (NODAL)");
  EXPECT_EQ(
      given([](PortKernel& k) {
        for (double& u : k.displacement) u = -u;
      }),
      "kernel.displacement moves against the force in pattern 0: a sign or a normal is wrong");
}

TEST(Soundness, TextOfSomebodyElseIsHarmless) {
  EXPECT_EQ(printable("plain, with \xc3\xa4 and\na second line"),
            "plain, with \xc3\xa4 and\na second line");
  EXPECT_EQ(printable("\x1b[31m\x07\x7f"), "\\x1b[31m\\x07\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"), "\\x9b");
  EXPECT_EQ(printable("\x9b|\xc3|\xc0\x80|\xed\xa0\x80|\xf4\x90\x80\x80"),
            "\\x9b|\\xc3|\\xc0\\x80|\\xed\\xa0\\x80|\\xf4\\x90\\x80\\x80");  // no UTF-8
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "drab\xe2\x81\xa9"),
            "\\u202edrab\\u2069");
  EXPECT_EQ(printable("\xe2\x82\xac \xf0\x9f\x98\x80"), "\xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(printable("123456789", 4), "1234...");
  EXPECT_EQ(printable("123\xc3\xa4", 4), "123...");  // not half a character
}

// ---- messages changed at random

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

/// One field somewhere in a message made absent, empty, longer, or another number.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}
  void change(Message& message) {
    std::vector<const FieldDescriptor*> set;
    message.GetReflection()->ListFields(message, &set);
    if (set.empty()) return;
    const FieldDescriptor* field = set[pick(set.size())];
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && pick(4) != 0)
      return change(inner(message, *field));
    if (pick(4) == 0) return message.GetReflection()->ClearField(&message, field);
    if (field->is_repeated()) return resize(message, *field);
    set_number(message, *field);
  }

 private:
  std::size_t pick(std::size_t count) { return random_() % count; }

  Message& inner(Message& message, const FieldDescriptor& field) {
    const auto* access = message.GetReflection();
    if (!field.is_repeated()) return *access->MutableMessage(&message, &field);
    const std::size_t count = index(access->FieldSize(message, &field));
    return *access->MutableRepeatedMessage(&message, &field, static_cast<int>(pick(count)));
  }
  double odd() {
    const double values[] = {0.0,     -1.0,      1.0e308,  -1.0e308,    1.0e-308,
                             1.0e150, -infinity, infinity, std::nan("")};
    return values[pick(std::size(values))];
  }
  std::int32_t odd_integer() {
    const std::int32_t values[] = {0,
                                   1,
                                   -1,
                                   2,
                                   3,
                                   7,
                                   1 << 20,
                                   std::numeric_limits<int>::max(),
                                   std::numeric_limits<int>::min()};
    return values[pick(std::size(values))];
  }
  void resize(Message& message, const FieldDescriptor& field) {
    const auto* access = message.GetReflection();
    const int count = access->FieldSize(message, &field);
    const int at = static_cast<int>(pick(index(count)));
    const bool shorter = pick(3) == 0;
    if (shorter) return access->RemoveLast(&message, &field);
    const bool longer = pick(2) == 0;
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return longer ? access->AddDouble(&message, &field, odd())
                      : access->SetRepeatedDouble(&message, &field, at, odd());
      case FieldDescriptor::CPPTYPE_INT32:
        return longer ? access->AddInt32(&message, &field, odd_integer())
                      : access->SetRepeatedInt32(&message, &field, at, odd_integer());
      case FieldDescriptor::CPPTYPE_MESSAGE:
        access->AddMessage(&message, &field);
        return;
      default:
        return access->RemoveLast(&message, &field);
    }
  }
  void set_number(Message& message, const FieldDescriptor& field) {
    const auto* access = message.GetReflection();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return access->SetDouble(&message, &field, odd());
      case FieldDescriptor::CPPTYPE_INT32:
        return access->SetInt32(&message, &field, odd_integer());
      case FieldDescriptor::CPPTYPE_ENUM:
        return access->SetEnumValue(&message, &field, odd_integer());
      case FieldDescriptor::CPPTYPE_BOOL:
        return access->SetBool(&message, &field, !access->GetBool(message, &field));
      default:
        return access->ClearField(&message, &field);
    }
  }

  std::mt19937_64 random_;
};

/// The shapes that whoever uses a reply relies on.
void expect_whole(const Response& got, const Description& body, const Advance& asked) {
  ASSERT_EQ(got.ports.size(), body.ports.size());
  ASSERT_GE(got.records.size(), index(asked.records));
  for (const PortResponse& port : got.ports) {
    EXPECT_EQ(port.trace.u.size(), port.trace.size() * 18);
    EXPECT_EQ(port.trace.v.size(), port.trace.u.size());
    EXPECT_EQ(port.trace.time.front(), asked.window.begin);
    EXPECT_EQ(port.trace.time.back(), asked.window.end);
    EXPECT_EQ(port.lower.size(), 6u);
    EXPECT_EQ(port.upper.size(), 6u);
    EXPECT_GE(port.speed_bound, 0.0);
  }
  for (const BodyRecord& record : got.records) {
    EXPECT_EQ(record.momentum.size(), 3u);
    EXPECT_EQ(record.columns.size(), body.columns.size());
    EXPECT_TRUE(std::isfinite(record.energy.total() * record.energy.total()));
  }
}

TEST(Soundness, AReplyChangedAtRandomIsRefusedOrWhole) {
  v1::Advanced sound;
  encode(reply(), asked(), sound);
  int refused = 0;
  Response got;  // reused, as in a run
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    v1::Advanced wire = sound;
    Mutator mutate(seed);
    for (std::uint64_t k = 0; k <= seed % 3; ++k) mutate.change(wire);
    SCOPED_TRACE(seed);
    const std::string why = refusal([&] {
      decode(wire, body(), asked(), got);
      require_sound(got, body(), asked());
    });
    if (why != "accepted") {
      EXPECT_EQ(why.rfind("advanced", 0), 0u) << why;  // the field is named
      ++refused;
      continue;
    }
    expect_whole(got, body(), asked());
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(refused, 5'000);  // the changes are not all harmless
}

TEST(Soundness, ADescriptionOrKernelChangedAtRandomIsRefusedOrSound) {
  v1::Description described;
  encode(body(), described);
  v1::PortKernel responded;
  encode(kernel(), responded);
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE(seed);
    Mutator mutate(seed);
    v1::Description wire = described;
    v1::PortKernel kernel_wire = responded;
    mutate.change(wire);
    mutate.change(kernel_wire);
    Description got;
    PortKernel answer;
    const std::string why = refusal([&] {
      decode(wire, got);
      require_sound(got);
    });
    if (why != "accepted") {
      EXPECT_EQ(why.rfind("description", 0), 0u) << why;
      ++refused;
    }
    const std::string kernel_why = refusal([&] {
      decode(kernel_wire, body(), probing(), answer);
      require_sound(answer, body(), probing());
    });
    if (kernel_why == "accepted") {
      EXPECT_EQ(answer.count(), 2);
      EXPECT_EQ(answer.begin.size(),
                answer.support == ForceSupport::nodal ? 36u : answer.begin.size());
    } else {
      EXPECT_EQ(kernel_why.rfind("kernel", 0), 0u) << kernel_why;
    }
  }
  EXPECT_GT(refused, 5'000);
}

TEST(Soundness, APassiveReplyChangedAtRandomIsRefusedOrWhole) {
  const Description block = body();
  const PassiveStep step{1.0, 1.2, {std::vector<double>(18, 0.5)}, {{1, 4}}};
  PassiveReply reply;
  reply.ports = {{std::vector<double>(18, 0.1), std::vector<double>(18, 0.5)}};
  reply.compliance.assign(36, 0.0);
  for (std::size_t k = 0; k < 6; ++k) reply.compliance[7 * k] = 1.0;
  reply.record = {1.2, Energy{1.0, 0.0, 0.0, 0.0}, {0, 0, 2}, {}, {}, {293.0}};
  reply.bulge = 0.001;
  reply.held = 0.5;
  v1::PassiveStepped sound;
  encode(reply, sound);
  int refused = 0;
  PassiveReply got;
  for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
    SCOPED_TRACE(seed);
    v1::PassiveStepped wire = sound;
    Mutator mutate(seed);
    for (std::uint64_t k = 0; k <= seed % 3; ++k) mutate.change(wire);
    const std::string why = refusal([&] {
      decode(wire, block, step, got);
      require_sound(got, block, step);
    });
    if (why != "accepted") {
      EXPECT_EQ(why.rfind("passive_stepped", 0), 0u) << why;
      ++refused;
      continue;
    }
    ASSERT_EQ(got.ports.size(), 1u);
    EXPECT_EQ(got.ports[0].displacement.size() + got.ports[0].velocity.size(), 36u);
    EXPECT_EQ(got.compliance.size(), 36u);
    EXPECT_EQ(got.record.momentum.size(), 3u);
    EXPECT_TRUE(std::isfinite(got.record.energy.total() * got.record.energy.total()));
    EXPECT_GE(got.bulge, 0.0);
    EXPECT_GE(got.held, 0.0);
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(refused, 5'000);  // the changes are not all harmless
}

}  // namespace
}  // namespace abut::stranger
