#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/unit/solver_cases.hpp"

namespace abut {

/// One way to advance a bar that its own core and the model of solids both know, its end massive.
struct SharedScheme {
  std::string name, integrator;
  std::string layer;  // of the core's end
};
inline void PrintTo(const SharedScheme& s, std::ostream* out) { *out << s.name; }

inline std::vector<SharedScheme> shared_schemes() {
  std::vector<SharedScheme> out = {{"explicit", explicit_scheme(case_step), "kick: {}"}};
  for (const char* mass : {"lumped", "averaged", "consistent"}) {
    for (const char* scheme : {"newmark", "hht_alpha", "generalized_alpha"})
      out.push_back({fmt::format("{}_{}", scheme, mass),
                     fmt::format("{}: {{step: {}, mass: {}}}", scheme, number(case_step), mass),
                     "massive: {}"});
  }
  return out;
}

}  // namespace abut
