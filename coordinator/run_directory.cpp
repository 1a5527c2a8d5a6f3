#include "coordinator/run_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <system_error>
#include <vector>

#include "base/error.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

// The first two say that a directory holds a run.
constexpr std::array<const char*, 7> run_files{"scene.resolved.yaml", "summary.json", "history.csv",
                                               "closed_form.csv",     "events.jsonl", "report.html",
                                               "fields.pvd"};

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// Takes out the states of an earlier run; the folder stays where it holds something else.
void clear_fields(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> states;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".vtu") states.push_back(entry.path());
  for (const fs::path& state : states) fs::remove(state, error);
  fs::remove(folder, error);
}

/// The deepest part of the path that is there: its permissions decide.
fs::path existing_part(fs::path path) {
  path = fs::absolute(path).lexically_normal();
  while (!is_there(path) && path.has_parent_path() && path != path.parent_path())
    path = path.parent_path();
  return path;
}

[[noreturn]] void refuse(const fs::path& directory, const std::string& what) {
  throw InputError(what, directory.string(), "Give another directory with --out.");
}

}  // namespace

fs::path default_run_directory(const std::string& scene_path) {
  return fs::path("runs") / fs::path(scene_path).stem();
}

bool make_run_directory(const fs::path& directory, bool force) {
  const fs::path there = existing_part(directory);
  std::error_code error;
  if (!fs::is_directory(there, error))
    refuse(directory, fmt::format("cannot be a run directory: {} is a file", there.string()));
  if (access(there.c_str(), W_OK | X_OK) != 0)
    refuse(directory, fmt::format("cannot be written: no permission in {}", there.string()));
  if (!force && (is_there(directory / run_files[0]) || is_there(directory / run_files[1])))
    throw InputError("holds a run already", directory.string(),
                     "Give another directory with --out, or --force to replace that run.");
  const bool fresh = fs::create_directories(directory, error);
  if (error) refuse(directory, "cannot be made: " + error.message());
  return fresh;
}

void remove_run_directory(const fs::path& directory) {
  std::error_code not_empty;
  fs::remove(directory, not_empty);
}

void clear_run_directory(const fs::path& directory) {
  for (const char* name : run_files) {
    std::error_code error;
    fs::remove(directory / name, error);
    if (error) refuse(directory, fmt::format("cannot lose {}: {}", name, error.message()));
  }
  clear_fields(directory / "fields");
}

}  // namespace abut
