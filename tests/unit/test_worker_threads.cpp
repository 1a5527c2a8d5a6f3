// Goal: every task runs once, whatever the number of threads, and what tasks have written is there
// when they are done. Oracle: sums known in closed form; limits of the operating system.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <memory>
#include <numeric>
#include <system_error>
#include <vector>

#include "base/index.hpp"
#include "base/worker_threads.hpp"

namespace abut {
namespace {

TEST(WorkerThreads, EveryTaskRunsOnceInEveryRound) {
  for (const int count : {1, 2, 4}) {
    WorkerThreads threads(count);
    EXPECT_EQ(threads.count(), count);
    std::vector<long> runs(200, 0), by_worker(index(count), 0);
    for (std::size_t round = 0; round < 50; ++round) {
      const std::size_t tasks = round * 4;  // also none
      threads.run(tasks, [&runs, &by_worker](std::size_t task, int worker) {
        ++runs[task];
        ++by_worker[index(worker)];
      });
    }
    // Task k runs in all rounds with 4 r > k.
    for (std::size_t k = 0; k < runs.size(); ++k) EXPECT_EQ(runs[k], 49 - static_cast<long>(k / 4));
    EXPECT_EQ(std::accumulate(by_worker.begin(), by_worker.end(), 0L), 4L * 49 * 50 / 2);
  }
}

// Sanitizers need more addresses than that; clang has no macro that names them.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
/// Ends this process with 0 when threads that cannot be had are told and none of them is left.
void ask_for_too_many() {
  rlimit room{};
  room.rlim_cur = room.rlim_max = rlim_t{1} << 28;  // [B] addresses: stacks of some thirty threads
  if (setrlimit(RLIMIT_AS, &room) != 0) std::_Exit(2);
  try {
    const WorkerThreads threads(1000);
  } catch (const std::system_error&) {
    std::_Exit(0);
  }
  std::_Exit(3);
}

TEST(WorkerThreads, ThreadsThatCannotBeHadAreTold) {
  EXPECT_EXIT(ask_for_too_many(), testing::ExitedWithCode(0), "");
}
#endif

}  // namespace
}  // namespace abut
