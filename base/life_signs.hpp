#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace abut {

/// While one lives, a thread of its own calls a hook now and then: a sign of life during one long
/// call, such as a factorisation, that calls none itself. The hook's data must not be used
/// otherwise meanwhile; they are handed over and back with the thread's start and end.
class LifeSigns {
 public:
  LifeSigns(std::function<void()> hook, std::chrono::milliseconds every);
  ~LifeSigns();
  LifeSigns(const LifeSigns&) = delete;
  LifeSigns& operator=(const LifeSigns&) = delete;

  /// Ends the calls; throws what the hook has thrown, after which it was not called again.
  void end();

 private:
  void run(std::chrono::milliseconds every);
  void stop();

  std::function<void()> hook_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool ended_ = false;
  std::exception_ptr thrown_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace abut
