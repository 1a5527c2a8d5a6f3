#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// What a scene will pay for, told before it runs. Counts are ranges where they depend on contact.
struct Estimate {
  struct Body {
    std::string name, model;
    bool known = true;  // false: an external body that has not told yet what it is
    std::int64_t dofs = 0;
    std::int64_t substeps = 0;  // when nothing is repeated
    double memory_mib = 0.0;    // of its process
  };

  /// By which a surface gives way to another: of all its points, and of how many fit into what the
  /// scene allows. Of the side for which it is larger where the scene leaves it open who yields.
  struct Kernel {
    std::string interface, side;
    std::int64_t points = 0, points_that_fit = 0, substeps = 0;
    double memory_mib = 0.0, allowed_mib = 0.0;
    // Where near points alone may answer: of the narrowest band; 0: they may not.
    double banded_mib = 0.0;
    // What finds the forces of all points of the other side, where they are many; 0: they are not.
    double rows_mib = 0.0;
  };

  /// Tied surfaces that hang together, and the kernel that answers them.
  struct Ties {
    struct Joint {
      std::string interface, force;  // the side in whose steps the force is constant
      double step = 0.0;             // [s]
      std::int64_t rows = 0;
    };
    std::vector<Joint> joints;
    bool used = true;      // false: an accelerator that uses no kernels
    bool banded = false;   // rows answer their neighbours; false: every other one
    bool narrow = false;   // so near that waves come farther in a window
    bool linear = true;    // all bodies
    bool floats = false;   // statics that nothing but ties hold, or that bend: no trials
    bool touched = false;  // contact on the same bodies is iterated with them
    double memory_mib = 0.0;
    std::int64_t probes = 0;

    /// Calls of the bodies in a window on average, the first windows aside, as measured over the
    /// shipped scenes at tolerances of 1e-4 to 1e-6; none at the upper end: as many as converge.
    struct Calls {
      int low = 1;
      std::optional<int> high;
    };
    Calls calls() const {
      if (!used) return {3, std::nullopt};
      if (narrow) return {2, std::nullopt};
      if (floats) return {1, linear ? 2 : 4};
      if (touched) return {1, linear ? 3 : 5};
      return {1, linear ? (banded ? 3 : 1) : (banded ? 4 : 3)};
    }
  };

  std::vector<Body> bodies;
  std::vector<Ties> ties;  // told by estimate_ties
  std::vector<Kernel> kernels;
  std::int64_t windows = 0;
  std::int64_t contact_windows_low = 0, contact_windows_high = 0;
  std::int64_t exchanges_low = 0, exchanges_high = 0;
  std::int64_t sweeps = 1;                     // most iterations of a window in contact, on average
  std::vector<std::string> in_use, not_built;  // optional features
  // Why windows that the accurate method cannot take end the run; empty: they go passively, or
  // there are none.
  std::string not_passive;
};

/// `bodies` are in the scene's order, null where not known; `contact_time` [s]: how long interfaces
/// are closed, when a closed form tells it.
Estimate estimate(const Scene& scene, std::span<const Description* const> bodies,
                  std::optional<double> contact_time);

/// For people, several lines.
std::string to_text(const Estimate& estimate, bool verbose = false);

}  // namespace abut
