#pragma once

#include <filesystem>
#include <string>

namespace abut {

/// Where the files of a run go when the command line does not say: runs/<scene name>.
std::filesystem::path default_run_directory(const std::string& scene_path);

/// Throws InputError when the directory holds a run already (unless `force`) or cannot be written.
/// Looks, and changes nothing.
void check_run_directory(const std::filesystem::path& directory, bool force);

/// Makes the directory and its parents, and takes out the files of an earlier run so that none is
/// taken for the new one's. Throws InputError.
void make_run_directory(const std::filesystem::path& directory, bool force);

}  // namespace abut
