// Goal: when a run has ended people are told what happened: contacts, reactions, energies, who
// waited. Oracle: the text of made-up runs.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/record/run_table.hpp"

namespace abut::test_run_table {
namespace {

class RunTableText : public testing::Test {
 protected:
  RunTableText() {
    left.name = "left";
    right.name = "right";
    right.columns = {"clamp.reaction_x [N]", "clamp.reaction_y [N]"};
    start.end = 2.0;
    start.bodies = {&left, &right};
    start.interfaces = {{.name = "impact"}, {.name = "weld", .tied = true}};
    for (const char* of : {"begin", "end", "closings", "impulse", "force_peak", "dissipated"})
      measures.set(std::string("contact.impact.") + of, 0.25);
    measures.none("contact.impact.end", "the interface was closed when the run ended");
    measures.set("contact.weld.force_peak", 12.5);
    measures.set("energy.total.relative_drift_end", -0.001);
    table.on_start(start);
    window(0.0, 0.0, {5.0, 0.0, 0.0, 0.0}, {0.0, 0.0});
    window(0.0, 1.0, {4.0, 1.0, 0.0, 0.0}, {3.0, -4.0});
    window(1.0, 2.0, {3.0, 1.0, 1.0, 0.5}, {1.0, 2.0});
  }
  /// Both bodies have the energy, the right one the reaction, at the end.
  void window(double begin, double end, const Energy& energy, std::vector<double> reaction) {
    std::vector<Response> responses(2);
    for (Response& response : responses) response.records = {{end, energy, {}}};
    responses[1].records[0].columns = std::move(reaction);
    table.on_window({{0, begin, end}, responses, {}});
  }

  Description left, right;
  RunStart start;
  Measures measures;
  RunTable table;
};

TEST_F(RunTableText, TellsContactsReactionsAndEnergies) {
  EXPECT_EQ(table.text(measures),
            "contact  begin [s]  end [s]  closings  impulse [N*s]  peak [N]  friction [J]\n"
            "impact        0.25        -      0.25           0.25      0.25          0.25\n"
            "\n"
            "tie   largest force [N]  largest gap [m]\n"
            "weld               12.5                -\n"
            "\n"
            "reaction     peak [N]  at [s]  at the end [N]\n"
            "right.clamp         5       1            1, 2\n"
            "\n"
            "energy [J]  kinetic  stored  work done on it  dissipated   error\n"
            "begin            10       0                0           0\n"
            "end               6       2                1           2  -0.1 %\n"
            "\n");
}

/// What passive windows took is in no body's account: with it the energies of the table balance.
TEST_F(RunTableText, TellsWhatPassiveWindowsTook) {
  RunEnd end;
  end.given_up = {.windows = 3, .normal = 0.5, .friction = 0.75, .push_out = 0.25};
  table.on_end(end);
  // The bodies have 10 J at the begin, 6 + 2 + 2 - 1 J at the end: 1 J less, all of which was
  // taken.
  EXPECT_NE(table.text(measures).find(
                "energy [J]  kinetic  stored  work done on it  dissipated  passive friction  given "
                "up  error\n"
                "begin            10       0                0           0\n"
                "end               6       2                1           2              0.75      "
                "0.25    0 %\n"),
            std::string::npos)
      << table.text(measures);
}

/// From rest 100 J are done on bodies that hold 40 J at most and keep 10: 90 % is lost, of what
/// there was at once 225 %.
TEST_F(RunTableText, TellsTheErrorOfAllThatWasPutIn) {
  RunTable damped;
  damped.on_start(start);
  const auto both = [&damped](double time, const Energy& energy) {
    std::vector<Response> responses(2);
    for (Response& response : responses) {
      response.records = {{time, energy, {}}};
      response.records[0].columns = {0.0, 0.0};
    }
    damped.on_window({{0, 0.0, time}, responses, {}});
  };
  both(0.0, {});
  both(1.0, {.kinetic = 3.0, .stored = 2.0, .external_work = 50.0});
  measures.total_energy_scale = 40.0;
  measures.set("energy.total.relative_drift_end", (10.0 - 100.0) / 40.0);
  EXPECT_NE(damped.text(measures).find("  -90 %\n"), std::string::npos) << damped.text(measures);
  measures.total_energy_scale = 200.0;  // what there was in between is more than what was put in
  measures.set("energy.total.relative_drift_end", (10.0 - 100.0) / 200.0);
  EXPECT_NE(damped.text(measures).find("  -45 %\n"), std::string::npos) << damped.text(measures);
}

/// Ended while it waited for its bodies, a run has none to tell of.
TEST_F(RunTableText, TellsNoTimesOfARunThatNeverBegan) {
  RunTable none;
  none.on_end({.wall_seconds = 1.0, .compute_seconds = {0.25, 0.5}});
  EXPECT_EQ(none.times(std::vector{0.5, 0.25}, {{0}, {1}}), "");
}

TEST_F(RunTableText, TellsTenContactsAndHowManyMoreThereAre) {
  start.interfaces.assign(12, InterfaceInfo{.name = "impact"});
  RunTable many;
  many.on_start(start);
  EXPECT_NE(many.text(measures).find("and 2 more: measures contact.* of summary.json\n"),
            std::string::npos);
}

TEST_F(RunTableText, TellsWhoTookTheTimeAndWhoWaited) {
  RunEnd end;
  end.wall_seconds = 10.0;
  const std::vector<double> waited = {2.0, 5.0};
  end.compute_seconds = {4.0, 6.0};
  table.on_end(end);
  EXPECT_EQ(table.times(waited, {{0}, {1}}),
            "time   right 50 %, left 20 %, coupling 30 %\nwaited right 40 %, left 60 % of it\n");
  EXPECT_EQ(table.times(waited, {}), "time   right 50 %, left 20 %, coupling 30 %\n");
  EXPECT_EQ(table.times(waited, {{0, 1}}), table.times(waited, {}));  // nobody to wait for
}

}  // namespace
}  // namespace abut::test_run_table
