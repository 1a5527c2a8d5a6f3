// Goal: whatever number, count or length a body of somebody else tells, and however large its
// surface is, it is refused by the name of the field or taken, in time that grows as what it sent.
// Oracle: the words of the error.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/message.h>

#include "base/index.hpp"
#include "messaging/soundness.hpp"
#include "tests/transport/stranger.hpp"

namespace abut::stranger {
namespace {

std::string decoded(const std::function<void(v1::Advanced&)>& spoil) {
  v1::Advanced wire;
  encode(reply(), asked(), wire);
  spoil(wire);
  Response got;
  return refusal([&] { decode(wire, body(), asked(), got); });
}

TEST(Soundness, ArraysAreAsLongAsTheirTimesAndCountsSay) {
  const auto trace = [](v1::Advanced& a) -> v1::Waveform& {
    return *a.mutable_ports(0)->mutable_trace();
  };
  EXPECT_EQ(decoded([](v1::Advanced&) {}), "accepted");
  EXPECT_EQ(decoded([&](v1::Advanced& a) { trace(a).mutable_time()->RemoveLast(); }),
            "advanced.ports[0].trace.u has 54 numbers where 36 belong");
  EXPECT_EQ(decoded([&](v1::Advanced& a) { trace(a).add_time(1.3); }),
            "advanced.ports[0].trace.u has 54 numbers where 72 belong");
  EXPECT_EQ(decoded([&](v1::Advanced& a) { trace(a).set_time(1, 1.3); }),
            "advanced.ports[0].trace.time does not increase at entry 2");
  EXPECT_EQ(decoded([&](v1::Advanced& a) { trace(a).set_time(2, 1.3); }),
            "advanced.ports[0].trace.time is from 1 to 1.3 s in a window from 1 to 1.2 s");
  EXPECT_EQ(decoded([](v1::Advanced& a) { a.clear_steps(); }), "advanced.steps is missing");
  EXPECT_EQ(decoded([](v1::Advanced& a) { a.set_steps(-1); }), "advanced.steps is -1");
  EXPECT_EQ(decoded([](v1::Advanced& a) { a.add_unbalanced(1.0); }),
            "advanced.unbalanced has 1 numbers where 0 belong");
  EXPECT_EQ(decoded([](v1::Advanced& a) { a.mutable_records()->RemoveLast(); }),
            "advanced.records has 1 entries for 2 records that were asked for");
  EXPECT_EQ(decoded([](v1::Advanced& a) { a.mutable_records(0)->add_momentum(1.0); }),
            "advanced.records[0].momentum has 4 numbers where 3 belong");
  v1::Description wire;
  encode(body(), wire);
  wire.mutable_ports(0)->mutable_surface()->add_normals(1.0);
  Description got;
  EXPECT_EQ(refusal([&] { decode(wire, got); }),
            "description.ports[0].surface.normals has 19 numbers where 18 belong");
}

/// Calls `visit` with every number of a message in turn, set to `value`.
template <class Visit>
void with_each_number(google::protobuf::Message& all, google::protobuf::Message& within,
                      double value, const Visit& visit) {
  using Field = google::protobuf::FieldDescriptor;
  const auto* access = within.GetReflection();
  std::vector<const Field*> set;
  access->ListFields(within, &set);
  for (const Field* field : set) {
    const int count = field->is_repeated() ? access->FieldSize(within, field) : 1;
    for (int k = 0; k < count; ++k) {
      if (field->cpp_type() == Field::CPPTYPE_MESSAGE) {
        with_each_number(all,
                         field->is_repeated() ? *access->MutableRepeatedMessage(&within, field, k)
                                              : *access->MutableMessage(&within, field),
                         value, visit);
      } else if (field->cpp_type() == Field::CPPTYPE_DOUBLE && field->is_repeated()) {
        const double kept = access->GetRepeatedDouble(within, field, k);
        access->SetRepeatedDouble(&within, field, k, value);
        visit(field->full_name());
        access->SetRepeatedDouble(&within, field, k, kept);
      } else if (field->cpp_type() == Field::CPPTYPE_DOUBLE) {
        const double kept = access->GetDouble(within, field);
        access->SetDouble(&within, field, value);
        visit(field->full_name());
        access->SetDouble(&within, field, kept);
      }
    }
  }
}

TEST(Soundness, NumbersThatWouldLeaveTheRangeAreRefusedInEveryField) {
  v1::Advanced advanced;
  encode(reply(), asked(), advanced);
  v1::PortKernel kernels;
  PortKernel told = kernel();
  told.compliance.assign(18, 0.001);
  encode(told, kernels);
  v1::Description described;
  Description d = body();
  d.loose.assign(6, 1.0);
  d.frequencies = {1.0};
  encode(d, described);
  int fields = 0;
  for (const double value : {1.0e308, -1.0e308, std::nan("")}) {
    with_each_number(advanced, advanced, value, [&](const std::string& name) {
      Response got;
      const std::string why = refusal([&] { decode(advanced, body(), asked(), got); });
      EXPECT_EQ(why.rfind("advanced.", 0), 0u) << name << ' ' << value << ' ' << why;
      ++fields;
    });
    with_each_number(kernels, kernels, value, [&](const std::string& name) {
      PortKernel got;
      const std::string why = refusal([&] { decode(kernels, body(), probing(), got); });
      EXPECT_EQ(why.rfind("kernel.", 0), 0u) << name << ' ' << value << ' ' << why;
      ++fields;
    });
    with_each_number(described, described, value, [&](const std::string& name) {
      Description got;
      const std::string why = refusal([&] { decode(described, got); });
      EXPECT_EQ(why.rfind("description.", 0), 0u) << name << ' ' << value << ' ' << why;
      ++fields;
    });
  }
  EXPECT_GT(fields, 900);
}

TEST(Soundness, OfRigidMotionsABodyHasNoMoreThanItsDimensionAllows) {
  for (const auto& [dim, each, most] : {std::array{2, 3, 3}, std::array{3, 6, 6}}) {
    for (const int motions : {most, most + 1, 1'000'000}) {
      Description flat = body();
      flat.dim = dim;
      flat.ports.clear();
      flat.loose.assign(index(motions * each), 1.0);
      const std::string why = refusal([&] { require_sound(flat); });
      EXPECT_EQ(why, motions == most ? std::string("accepted")
                                     : fmt::format("description.loose has {} motions, a rigid "
                                                   "body has {}",
                                                   motions, most));
    }
  }
}

/// A plane of squares, counterclockwise from outside.
PortGeometry plane_of(int squares) {
  PortGeometry surface;
  surface.dim = 3;
  const int row = squares + 1;
  for (int j = 0; j < row; ++j)
    for (int i = 0; i < row; ++i) {
      surface.points.insert(surface.points.end(), {0.01 * i, 0.01 * j, 0.0});
      surface.normals.insert(surface.normals.end(), {0, 0, 1});
    }
  for (int j = 0; j < squares; ++j)
    for (int i = 0; i < squares; ++i) {
      const int p = j * row + i;
      surface.offsets.push_back(static_cast<std::int32_t>(surface.facets.size()));
      surface.facets.insert(surface.facets.end(), {p, p + 1, p + row + 1, p + row});
    }
  surface.offsets.push_back(static_cast<std::int32_t>(surface.facets.size()));
  surface.spacing = 0.01;
  return surface;
}

// Sixteen times as many points take sixteen times as long, and some for caches that are full; a
// rule of pairs would take 256 times as long.
TEST(Soundness, TheTimeToLookAtASurfaceGrowsAsItsPoints) {
  const auto seconds = [](int squares) {
    Description large = body();
    large.ports[0].geometry = plane_of(squares);
    v1::Description wire;
    encode(large, wire);
    double least = infinity;
    for (int k = 0; k < 3; ++k) {
      const auto begin = std::chrono::steady_clock::now();
      Description got;
      decode(wire, got);
      require_sound(got);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      least = std::min(least, took.count());
    }
    return least;
  };
  const double small = seconds(79), large = seconds(319);  // 6,400 and 102,400 points
  EXPECT_LT(large, 80.0 * small) << small << ' ' << large;
}

}  // namespace
}  // namespace abut::stranger
