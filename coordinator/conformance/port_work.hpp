#pragma once

#include <vector>

#include "coordinator/conformance/body_trial.hpp"

namespace abut {

/// Throws BrokenClause where the work that a port tells is not force times way, or of a body that
/// conserves not the change of its energy. `before`: the window before, at whose end no force acts;
/// `free`: the window without the push.
void hold_work(const Description& body, const Response& before, const Response& free,
               const Response& pushed, const Push& push);

/// A window under pushes, under their opposites, and without any, of as many records.
struct Worked {
  const Response& free;
  const Response& pushed;
  const Response& opposite;
  const std::vector<Push>& pushes;  // constant forces, one of a port
};

/// Throws BrokenClause where the energy of a body that conserves does not change by the work of the
/// forces, from record to record. Of pushes and their opposites together: what the body does
/// anyway, and what forces do along it, goes out, and hides nothing.
void hold_energy(const Description& body, const Worked& worked);

}  // namespace abut
