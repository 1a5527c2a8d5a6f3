#pragma once

#include <string>

#include "base/awaited.hpp"
#include "base/yaml_document.hpp"
#include "coordinator/scene.hpp"

namespace abut {

/// Refuses an endpoint for processes that somebody else starts which other machines can reach,
/// where there are no keys, unless `insecure`: then it is said on standard error. Throws
/// InputError.
void check_awaited(const Awaited& awaited, bool insecure);
/// Refuses a scene whose bodies connect over a network without keys, unless `insecure`: then it is
/// said on standard error. Throws InputError.
void check_endpoint(const Scene& scene, const Document& document, bool insecure);

/// Where the user lists the programs that scenes may start, and HOST:PROGRAM what they may start
/// over ssh: $ABUT_PROGRAMS, or abut/programs in the
/// user's folder of configurations.
std::string list_of_programs();

/// Refuses programs that neither lie beside this one and are called abut..., nor are on the user's
/// list, and whatever is to start on other machines and is not listed: a scene of somebody else
/// must not start what it likes, nor go where it likes. Throws InputError.
void check_programs(const Scene& scene, const Document& document);
/// The same of one program, which a job will start. Throws InputError.
void check_program(const std::string& program, const std::string& where);

}  // namespace abut
