#pragma once

#include <string>

#include "base/fields_reference.hpp"

namespace abut {

/// The keys of a scene as a JSON Schema (draft 7), with which editors complete and check scene
/// files. Of the reference's sections the first is of the scene, the second of a body, the third of
/// a body of another program. What is equal stands once, under `definitions`. Rules across keys are
/// not in it: they are told by `abut check` alone.
std::string json_schema(const Reference& reference);

}  // namespace abut
