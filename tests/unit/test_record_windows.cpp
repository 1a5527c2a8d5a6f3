// Goal: measures of contact are those of the physical history, however it is cut into windows and
// whenever events are told. Oracle: sums over the history itself, and the same run cut otherwise.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordinator/record/measure_recorder.hpp"
#include "tests/unit/record_run.hpp"

namespace abut::test_record_windows {
namespace {

// Sums of three hundred numbers of size 1, at times that windows round in their own way.
constexpr double roundoff = 1e-12;
constexpr int substeps = 300;
constexpr double step = 0.01;  // [s]

struct Contact {
  double begin, end, height;  // [s] [s] [N]
};

// Located between substeps: two that part for 2.3 substeps, and one whose last touch, after one
// substep, carries 1e-5 of the impulse.
const std::vector<Contact> contacts = {
    {0.1037, 0.3521, 1.0}, {0.3755, 0.9011, 0.7}, {1.2077, 2.1013, 1.3}, {2.1113, 2.1312, 1e-3}};

double press(double time) {
  for (const Contact& c : contacts) {
    if (time > c.begin && time < c.end)
      return c.height * (1.5 - (time - c.begin) / (c.end - c.begin));
  }
  return 0.0;
}

double velocity(int side, double time) { return std::sin(3.0 * time + side) + 0.2 * side; }

enum class Told { before, after };           // events, of the window that they lie in
enum class Flags { honest, always, never };  // whether windows are reported closed

struct Cut {
  int substeps = 1;  // in a window
  Told told = Told::before;
  Flags flags = Flags::honest;
};

struct History {
  ForceSupport support = ForceSupport::nodal;
  int kinematic = 0;
  double transit = 0.0;  // [s]
  bool tied = false;
};

bool pressed(double begin, double end) {
  return std::ranges::any_of(
      contacts, [begin, end](const Contact& c) { return c.begin < end && c.end > begin; });
}

void tell_events(HandMadeRun& run, Observer& observer, double begin, double end) {
  for (const Contact& c : contacts) {
    if (c.begin >= begin && c.begin < end)
      run.event(observer, RunEvent::Kind::contact_closed, c.begin);
    if (c.end >= begin && c.end < end) run.event(observer, RunEvent::Kind::contact_opened, c.end);
  }
}

std::map<std::string, double> measures(const History& history, const Cut& cut) {
  HandMadeRun run;
  run.support = history.support;
  run.kinematic = history.kinematic;
  run.substeps = cut.substeps;
  run.f = [](int side, double time) { return side == 0 ? -press(time) : press(time); };
  run.v = velocity;
  run.bodies[0].ports[0].geometry.transit = 0.5 * history.transit;
  run.bodies[1].ports[0].geometry.transit = history.transit;  // the coarser one counts
  run.start.interfaces[0].tied = history.tied;
  MeasureRecorder recorder(&run.form, MeanForceSpec{0.1});
  recorder.on_start(run.start);
  for (int k = 0; k < substeps; k += cut.substeps) {
    const double begin = k * step, end = (k + cut.substeps) * step;
    const bool closed = cut.flags == Flags::always ||
                        (cut.flags == Flags::honest && (history.tied || pressed(begin, end)));
    if (cut.told == Told::before && !history.tied) tell_events(run, recorder, begin, end);
    run.window(recorder, begin, end, closed);
    if (cut.told == Told::after && !history.tied) tell_events(run, recorder, begin, end);
  }
  recorder.on_end(run.end());
  return recorder.measures().values;
}

/// The contacts as one where they part for less than `together` [s].
std::vector<Contact> joined(double together) {
  std::vector<Contact> out;
  for (const Contact& c : contacts) {
    if (!out.empty() && c.begin - out.back().end < together) {
      out.back().end = c.end;
    } else {
      out.push_back(c);
    }
  }
  return out;
}

double impulse(ForceSupport support) {
  double sum = 0.0;
  for (int k = 0; k < substeps; ++k) {
    const double from = k * step, to = (k + 1) * step;
    sum += step * (support == ForceSupport::step ? press(0.5 * (from + to))
                                                 : 0.5 * (press(from) + press(to)));
  }
  return sum;
}

/// Of the velocity that is linear in substeps, its square by the trapezoid rule on the parts that
/// events make of substeps.
double velocity_rms(const std::vector<Contact>& closed, const std::vector<Contact>& events,
                    int side) {
  double sum = 0.0, length = 0.0;
  for (int k = 0; k < substeps; ++k) {
    const double from = k * step, to = (k + 1) * step;
    const double v_from = velocity(side, from), v_to = velocity(side, to);
    std::vector<double> ends = {from, to};
    for (const Contact& c : events) {
      for (const double event : {c.begin, c.end})
        if (event > from && event < to) ends.push_back(event);
    }
    std::ranges::sort(ends);
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double a = ends[i - 1], b = ends[i], middle = 0.5 * (a + b);
      const bool counts = std::ranges::any_of(
          closed, [middle](const Contact& c) { return middle > c.begin && middle < c.end; });
      if (!counts) continue;
      const double v_a = v_from + (v_to - v_from) * (a - from) / step;
      const double v_b = v_from + (v_to - v_from) * (b - from) / step;
      sum += 0.5 * (v_a * v_a + v_b * v_b) * (b - a);
      length += b - a;
    }
  }
  return std::sqrt(sum / length);
}

class Windows : public testing::TestWithParam<ForceSupport> {};
INSTANTIATE_TEST_SUITE_P(Record, Windows, testing::Values(ForceSupport::nodal, ForceSupport::step));

TEST_P(Windows, MakeNoDifferenceToTheMeasuresOfContact) {
  for (const int kinematic : {0, 1}) {
    // Nothing is the same contact; the last touch is; the short release too, to whole substeps.
    for (const double transit : {0.0, 0.0025, 0.01}) {
      const History history{GetParam(), kinematic, transit};
      const std::vector<Contact> expected = joined(5.0 * transit);
      double closed = 0.0;
      for (const Contact& c : expected) closed += c.end - c.begin;
      const auto notable = std::ranges::count_if(
          expected, [](const Contact& c) { return c.height > 0.01; });  // of the impulse, about
      const std::map<std::string, double> first = measures(history, {});
      for (const int in_window : {1, 3, 10, substeps}) {
        for (const Told told : {Told::before, Told::after}) {
          for (const Flags flags : {Flags::honest, Flags::always, Flags::never}) {
            const std::map<std::string, double> m = measures(history, {in_window, told, flags});
            const auto value = [&m](const std::string& what) {
              return m.at("contact.impact." + what);
            };
            EXPECT_EQ(value("count"), notable);
            EXPECT_EQ(value("closings"), contacts.size());
            EXPECT_EQ(value("begin"), contacts.front().begin);
            EXPECT_EQ(value("end"), contacts.back().end);
            EXPECT_NEAR(value("duration"), contacts.back().end - contacts.front().begin, roundoff);
            EXPECT_NEAR(value("impulse"), impulse(GetParam()), roundoff);
            EXPECT_NEAR(value("force_mean"), impulse(GetParam()) / closed, roundoff);
            EXPECT_NEAR(value("velocity_rms"), velocity_rms(expected, contacts, kinematic),
                        roundoff);
            for (const char* what :
                 {"force_peak", "force_peak_filtered", "begin_error", "release_error",
                  "release_error_half_force", "force_rms_error", "force_max_error",
                  "velocity_rms_error", "count_error", "impulse_error"})
              EXPECT_NEAR(value(what), first.at(std::string("contact.impact.") + what), roundoff)
                  << what << " in windows of " << in_window;
          }
        }
      }
    }
  }
}

TEST_P(Windows, MakeNoDifferenceToATie) {
  const History history{GetParam(), 0, 0.005, true};
  const double length = substeps * step;
  for (const int in_window : {1, 10, substeps}) {
    const std::map<std::string, double> m = measures(history, {in_window});
    EXPECT_EQ(m.at("contact.impact.count"), 0.0);
    EXPECT_NEAR(m.at("contact.impact.force_mean"), impulse(GetParam()) / length, roundoff);
    EXPECT_NEAR(m.at("contact.impact.velocity_rms"), velocity_rms({{0.0, length, 0.0}}, {}, 0),
                roundoff);
  }
}

}  // namespace
}  // namespace abut::test_record_windows
