#pragma once

#include <filesystem>
#include <string>

namespace abut {

/// Where the files of a run go when the command line does not say: runs/<scene name>.
std::filesystem::path default_run_directory(const std::string& scene_path);

/// Makes the directory and its parents. Throws InputError when it holds a run already (unless
/// `force`) or cannot be written; then nothing has been made. True when it was not there before.
bool make_run_directory(const std::filesystem::path& directory, bool force);

/// Takes away an empty run directory; one that holds something stays.
void remove_run_directory(const std::filesystem::path& directory);

/// Takes out the files of an earlier run, so that none is taken for the new one's. Throws
/// InputError.
void clear_run_directory(const std::filesystem::path& directory);

}  // namespace abut
