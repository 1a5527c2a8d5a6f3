#pragma once

#include <string>

#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Refuses a scene whose bodies connect over a network without keys, unless `insecure`: then it is
/// said on standard error. Throws InputError.
void check_endpoint(const Scene& scene, const Document& document, bool insecure);

/// Where the user lists the programs that scenes may start: $ABUT_PROGRAMS, or abut/programs in the
/// user's folder of configurations.
std::string list_of_programs();

/// Refuses programs that neither lie beside this one and are called abut..., nor are on the user's
/// list: a scene of somebody else must not start what it likes. Throws InputError.
void check_programs(const Scene& scene, const Document& document);

}  // namespace abut
