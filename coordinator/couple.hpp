#pragma once

#include <memory>
#include <vector>

#include "coordinator/coupling/schwarz.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The interfaces of a run with their ways of transmission: what the scene says, joined to the
/// bodies.
struct Coupling {
  struct Rule {               // per interface, constant during a run
    bool published = false;   // dirichlet_neumann: decided at window starts
    bool internal = false;    // contact inside a body: watched, never iterated
    bool tied = false;        // closed from the start to the end: no criterion, no events
    bool swap = false;        // published form: roles swap after every window in contact
    bool role_fixed = true;   // false: by probe at first touch
    bool projection = false;  // published form: plastic impact of the contact nodes at first touch

    /// Whether every substep decides for itself if contact pushes.
    bool unilateral() const { return !published && !internal && !tied; }
  };

  std::vector<Interface> interfaces;
  std::vector<std::unique_ptr<Transmission>> transmissions;
  std::vector<Rule> rules;

  std::vector<Joint> joints();
};

/// Throws InputError for ports that do not face each other or bodies that cannot take their roles.
Coupling make_coupling(const Scene& scene, const Bodies& bodies);

Schwarz make_schwarz(const SchwarzSpec& spec);

}  // namespace abut
