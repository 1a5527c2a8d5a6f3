#include "base/worker_threads.hpp"

namespace abut {
namespace {

void end_workers(std::vector<std::thread>& threads, std::atomic<unsigned>& round, bool& ended) {
  ended = true;
  ++round;
  round.notify_all();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace

WorkerThreads::WorkerThreads(int count) {
  try {
    for (int worker = 1; worker < count; ++worker)
      threads_.emplace_back([this, worker] { serve(worker); });
  } catch (...) {  // there are no more threads, or memory: those that run are ended first
    end_workers(threads_, round_, ended_);
    throw;
  }
}

WorkerThreads::~WorkerThreads() { end_workers(threads_, round_, ended_); }

void WorkerThreads::run(std::size_t tasks, const Work& work) {
  work_ = &work;
  tasks_ = tasks;
  next_ = 0;
  if (!threads_.empty()) {
    busy_ = static_cast<int>(threads_.size());
    ++round_;
    round_.notify_all();
  }
  take_tasks(0);
  for (int busy = busy_; busy > 0; busy = busy_) busy_.wait(busy);
}

void WorkerThreads::serve(int worker) {
  for (unsigned seen = 0;; ++seen) {
    round_.wait(seen);
    if (ended_) return;
    take_tasks(worker);
    if (--busy_ == 0) busy_.notify_one();
  }
}

void WorkerThreads::take_tasks(int worker) {
  for (std::size_t task = next_++; task < tasks_; task = next_++) (*work_)(task, worker);
}

}  // namespace abut
