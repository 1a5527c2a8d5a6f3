#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace abut {

/// Threads that share the tasks of one caller, who works too. Which thread runs a task is left to
/// chance: results may depend on the task alone.
class WorkerThreads {
 public:
  explicit WorkerThreads(int count);  // at least 1: the caller alone
  ~WorkerThreads();
  WorkerThreads(const WorkerThreads&) = delete;
  WorkerThreads& operator=(const WorkerThreads&) = delete;

  int count() const { return static_cast<int>(threads_.size()) + 1; }
  /// work(task, worker) for every task below `tasks`, workers being numbered from 0. Returns when
  /// all are done; work must not throw.
  using Work = std::function<void(std::size_t task, int worker)>;
  void run(std::size_t tasks, const Work& work);

 private:
  void serve(int worker);
  void take_tasks(int worker);

  std::vector<std::thread> threads_;
  const Work* work_ = nullptr;
  std::size_t tasks_ = 0;
  std::atomic<std::size_t> next_{0};
  std::atomic<unsigned> round_{0};  // changes when there is work, or an end of it
  std::atomic<int> busy_{0};        // threads that have not finished this round
  bool ended_ = false;
};

}  // namespace abut
