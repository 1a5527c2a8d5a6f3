#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// A run that is broken off, to see what its windows cost.
struct ProbedRun {
  /// A window, or a flight of several.
  struct Stretch {
    double length = 0.0, wall = 0.0;  // [s] of the scene's time, of the clock
    bool closed = false;              // something pressed
    int iterations = 1;
  };
  std::vector<Stretch> stretches;      // without the start
  double begin = 0.0, reached = 0.0;   // [s] of the scene's time
  double wall = 0.0;                   // [s] of the clock, the start included
  double state_wall = 0.0;             // [s] of the clock, to write one state of all fields
  double states_apart = 0.0;           // [s] of the scene's time; 0: no fields are written
  bool whole = false;                  // the run came to its end
  std::string failure;                 // why it failed; empty: it did not
  std::vector<double> waited_seconds;  // by body, of `wall`
};

/// Runs the scene for at most `seconds`, for two and a half times as long where fewer than three
/// windows have ended by then, four times where contact is possible (`touches`) and has pressed in
/// fewer than three, and not past the end of the window that is under way. Whoever waits
/// for bodies looks at `stop`, which is set at the end, or when `interrupted` is. The bodies are of
/// no use afterwards. Fields are written as the run would, to a folder that is gone afterwards.
ProbedRun probe_run(const Scene& scene, const std::vector<Subdomain*>& bodies, double seconds,
                    std::atomic<bool>& stop, const std::atomic<bool>& interrupted, bool touches);

}  // namespace abut
