#pragma once

#include <span>

#include "base/yaml_document.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// The run's own times: a window that is no longer than the run and that rounding leaves whole.
/// The last window of a run may be shorter than the others. Throws InputError.
void check_times(const TimeSpec& time, const Document& document);

/// A run or stage ends with a contact that the scene has. Throws InputError.
void check_until(const Scene& scene, const Document& document);

/// Windows hold a whole number of every body's steps, no more than a request may, and steps are
/// longer than the rounding of times. What is proposed has passed the same rules. `bodies` are in
/// the scene's order. Throws InputError.
void check_steps(const Scene& scene, std::span<const Description* const> bodies,
                 const Document& document);

}  // namespace abut
