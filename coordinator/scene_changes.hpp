#pragma once

#include <span>
#include <string>

namespace abut {

class Document;

/// Whether a run may go on with a scene that differs from that of its checkpoint; both resolved.
/// What is written, where bodies run, what is expected and how long the run goes on may always
/// change; steps, windows and tolerances where `overrides` (key=value) say so. Throws InputError of
/// all else, with values before and now.
void check_changes(const std::string& before, const std::string& now,
                   std::span<const std::string> overrides);

/// Whether the stages of a scene change what a stage may, and each says when it ends. Throws
/// InputErrorList.
void check_stages(const Document& document);

}  // namespace abut
