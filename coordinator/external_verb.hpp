#pragma once

#include <string>
#include <vector>

namespace abut {

/// Replaces this process by the program `abut-<verb>`, found beside this one or on PATH. Returns
/// only by throwing InputError: there is no such program.
[[noreturn]] void become_external_verb(const std::string& verb,
                                       const std::vector<std::string>& arguments);

/// Folder of this program, with a slash at its end; empty when the system does not tell.
std::string program_folder();

/// Programs that this one starts find the Python package `abut` of this installation (PYTHONPATH).
void offer_python_package();

}  // namespace abut
