#pragma once

#include <span>
#include <string>

namespace abut {

/// Whether a run may go on with a scene that differs from that of its checkpoint; both resolved.
/// What is written, where bodies run, what is expected and how long the run goes on may always
/// change; steps, windows and tolerances where `overrides` (key=value) say so. Throws InputError of
/// all else, with values before and now.
void check_changes(const std::string& before, const std::string& now,
                   std::span<const std::string> overrides);

}  // namespace abut
