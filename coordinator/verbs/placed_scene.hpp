#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/estimate.hpp"
#include "coordinator/exact/closed_form.hpp"
#include "coordinator/launch.hpp"
#include "coordinator/scene.hpp"

namespace abut {

// A scene with its bodies, as verbs need it.

/// The bodies of a run and, when they live in other processes, what keeps those alive.
struct Placement {
  std::unique_ptr<Launch> launch;  // null: this process
  std::vector<std::unique_ptr<Subdomain>> bodies;

  /// Null: an external body that is not here.
  std::vector<const Description*> descriptions() const {
    std::vector<const Description*> all;
    for (const std::unique_ptr<Subdomain>& body : bodies)
      all.push_back(body != nullptr ? &body->describe() : nullptr);
    return all;
  }
  bool whole() const {
    return std::all_of(bodies.begin(), bodies.end(),
                       [](const std::unique_ptr<Subdomain>& body) { return body != nullptr; });
  }
  std::vector<Subdomain*> pointers() const {
    std::vector<Subdomain*> all;
    for (const std::unique_ptr<Subdomain>& body : bodies) all.push_back(body.get());
    return all;
  }
};

/// Builds the bodies, in this process or in others; `awaited`: in those that somebody else starts.
/// Throws InputError, RunError.
Placement place(const Scene& scene, const Document& document, bool local,
                const std::atomic<bool>& interrupted,
                const std::optional<Awaited>& awaited = std::nullopt);

/// What is known of a scene beside its keys.
struct Validated {
  std::optional<ClosedForm> form;
  Estimate estimate;
};

/// Scene and bodies are read by readers of their own: what both refuse is told at once; stages that
/// follow after it. Throws InputErrorList.
Scene read_all_keys(const Document& document);

/// Sets a scene up. Errors that it throws have the words of the scene's units, in which its numbers
/// are: "overlap by 14 mm".
void in_units_of(const Scene& scene, const std::function<void()>& set_up);

/// All that can be said of a scene with the bodies that are there. `processes`: what they send goes
/// in frames. Throws InputError.
Validated validate_all(const Scene& scene, const Document& document, const Placement& placement,
                       bool processes);

/// The same of the stages that follow a scene, with bodies that are built here for that, where they
/// stand at the scene's begin.
void validate_stages(const Document& document);

}  // namespace abut
