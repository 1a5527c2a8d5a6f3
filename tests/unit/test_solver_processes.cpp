// Goal: every body that the coordinator starts lives in exactly one process, alone or with the
// bodies of its group. Oracle: the lists, written out.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "coordinator/solver_processes.hpp"

namespace abut::test_solver_processes {
namespace {

Document document(const std::string& bodies, int processes = 0) {
  const std::string network =
      processes == 0 ? "" : fmt::format("network: {{processes: {}}}\n", processes);
  return Document::from_text("s.yaml", "meta: {title: t}\ntime: {begin: 0, end: 1, window: 1}\n" +
                                           network + "bodies:\n" + bodies);
}

/// The bodies of each process, by their first letters: "ab c".
std::string processes_of(const std::string& bodies, int processes = 0) {
  const Scene scene = read_scene(document(bodies, processes));
  std::string text;
  for (const SolverProcess& process : solver_processes(scene)) {
    if (!text.empty()) text += ' ';
    for (const std::size_t body : process.bodies) text += scene.bodies[body].first;
    if (!process.program.empty()) text += "(" + process.program + ")";
  }
  return text;
}

TEST(SolverProcesses, ABodyIsAloneUnlessItHasAGroup) {
  EXPECT_EQ(processes_of("  a: {}\n  b: {launch: spawn}\n  c: {launch: connect}\n"), "a b");
  EXPECT_EQ(processes_of("  a: {launch: {group: g}}\n  b: {}\n  c: {launch: {group: g}}\n"),
            "ac b");
  EXPECT_EQ(processes_of("  a: {launch: {group: g}}\n  b: {launch: {group: {name: g}}}\n"
                         "  c: {launch: {group: h}}\n"),
            "ab c");
}

TEST(SolverProcesses, AGroupMayNameItsProgram) {
  EXPECT_EQ(processes_of("  a: {launch: {group: {name: g, program: p}}}\n"
                         "  b: {launch: {group: {name: g, program: p}}}\n"),
            "ab(p)");
}

TEST(SolverProcesses, BodiesAreDealtInTurns) {
  const std::string five = "  a: {}\n  b: {}\n  c: {}\n  d: {}\n  e: {}\n";
  EXPECT_EQ(processes_of(five), "a b c d e");
  EXPECT_EQ(processes_of(five, 1), "abcde");
  EXPECT_EQ(processes_of(five, 2), "ace bd");
  EXPECT_EQ(processes_of(five, 64), "a b c d e");
}

TEST(SolverProcesses, WhoHasAProcessOfItsOwnIsNotDealt) {
  EXPECT_EQ(processes_of("  a: {}\n  b: {launch: {group: \"process 0\"}}\n"
                         "  c: {launch: {spawn: {program: p}}}\n  d: {launch: connect}\n  e: {}\n",
                         1),
            "ae b c(p)");
}

TEST(SolverProcesses, OverSshAGroupIsOfItsHostAndUser) {
  EXPECT_EQ(processes_of("  a: {launch: {ssh: n}}\n  b: {launch: {ssh: n}}\n"), "a b");
  EXPECT_EQ(processes_of("  a: {launch: {ssh: {host: n, group: g}}}\n"
                         "  b: {launch: {ssh: {host: n, group: g}}}\n"
                         "  c: {launch: {ssh: {host: m, group: g}}}\n"
                         "  d: {launch: {ssh: {host: n, user: u, group: g}}}\n"
                         "  e: {launch: {group: g}}\n"),
            "ab c d e");
  const Scene scene =
      read_scene(document("  a: {launch: {ssh: {host: n, program: /p}}}\n"
                          "  b: {launch: spawn}\n"));
  const std::vector<SolverProcess> processes = solver_processes(scene);
  EXPECT_EQ(processes[0].ssh.value().destination(), "n");
  EXPECT_FALSE(processes[1].ssh.has_value());
  EXPECT_FALSE(starts_our_solver(scene.bodies[0].second));
  EXPECT_TRUE(may_run_elsewhere(scene.bodies[0].second));
}

TEST(SolverProcesses, WhoeverConnectsComesAfterThoseThatAreStarted) {
  const Scene scene =
      read_scene(document("  a: {launch: connect}\n  b: {}\n  c: {}\n  d: {}\n", 2));
  const std::vector<SolverProcess> all = all_processes(scene);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(name_of_process(scene, all[0]), "process-1");  // of b and d
  EXPECT_EQ(name_of_process(scene, all[1]), "c");
  EXPECT_EQ(name_of_process(scene, all[2]), "a");
  EXPECT_TRUE(all[2].connects && !all[0].connects);
}

TEST(SolverProcesses, ARunHasAtMost64) {
  for (const int count : {64, 65}) {
    std::string bodies;
    for (int b = 0; b < count; ++b) bodies += fmt::format("  b{}: {{}}\n", b);
    const Document alone = document(bodies), dealt = document(bodies, 64);
    const Scene scene = read_scene(alone);
    const auto check = [&] { check_processes(scene, alone); };
    if (count == 64) {
      EXPECT_NO_THROW(check());
    } else {
      EXPECT_THROW(check(), InputError);
    }
    EXPECT_NO_THROW(check_processes(read_scene(dealt), dealt));
  }
}

}  // namespace
}  // namespace abut::test_solver_processes
