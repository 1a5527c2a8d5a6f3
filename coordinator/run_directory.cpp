#include "coordinator/run_directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "coordinator/record/checkpoint_file.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr const char* scene_file = "scene.resolved.yaml";  // written first, removed last;
constexpr const char* summary_file = "summary.json";       // either tells of a run
constexpr const char* folder_of_fields = "fields";
constexpr const char* list_of_fields = "fields.pvd";
constexpr const char* state_of_paraview = "fields.pvsm";
constexpr const char* trace_file = "trace.json";
constexpr std::array<const char*, 6> of_its_end{summary_file, "report.html", "film.mp4",
                                                "film.gif",   "picture.png", "progress.json"};
constexpr std::array<const char*, 11> of_its_way{
    "history.csv",         "closed_form.csv", "measures.csv",    "events.jsonl",
    list_of_fields,        state_of_paraview, latest_checkpoint, earlier_checkpoint,
    unfinished_checkpoint, trace_file,        scene_file};

std::vector<const char*> run_files() {
  std::vector<const char*> all(of_its_end.begin(), of_its_end.end());
  all.insert(all.end(), of_its_way.begin(), of_its_way.end());
  return all;
}

fs::file_status status_of(const fs::path& path) {
  std::error_code ignored;
  return fs::symlink_status(path, ignored);
}

bool is_there(const fs::path& path) { return fs::exists(status_of(path)); }

/// The states that fields.pvd of an earlier run lists: what that run wrote, and nothing else.
std::vector<fs::path> listed_states(const fs::path& directory) {
  std::vector<fs::path> states;
  if (!fs::is_directory(status_of(directory / folder_of_fields))) return states;
  std::ifstream file(directory / list_of_fields);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::regex state(R"re(file="(fields/[^"/]+\.vtu)")re");
  for (std::sregex_iterator found(text.begin(), text.end(), state), end; found != end; ++found)
    states.push_back(directory / found->str(1));
  return states;
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

/// Descriptor of the locked directory; -1 where it went away meanwhile.
int lock(const fs::path& directory) {
  const int descriptor = open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) return -1;
  if (descriptor < 0) refuse(directory, fmt::format("cannot be opened: {}", std::strerror(errno)));
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) {
      close(descriptor);
      throw InputError("is in use by another run", directory.string(),
                       "Wait for that run's end, or give another directory with --out.");
    }
    // Some network file systems lock no directories; a run alone there is as good as ever.
    log_warning(fmt::format("{}: cannot be locked ({}): see to it that no other run writes there",
                            directory.string(), std::strerror(errno)));
  }
  struct stat held {
  }, named{};
  const bool same = fstat(descriptor, &held) == 0 && stat(directory.c_str(), &named) == 0 &&
                    held.st_dev == named.st_dev && held.st_ino == named.st_ino;
  if (same) return descriptor;
  close(descriptor);  // a run that never began has taken it away
  return -1;
}

}  // namespace

fs::path default_run_directory(const std::string& scene_path) {
  return fs::path("runs") / fs::path(scene_path).stem();
}

RunDirectory RunDirectory::of_run(fs::path directory) {
  if (!is_there(directory / scene_file))
    throw InputError("holds no run", directory.string(),
                     "Give the directory of a run, as abut run has named it at its end.");
  return RunDirectory(std::move(directory), true);
}

RunDirectory::RunDirectory(fs::path directory, bool force) : path_(std::move(directory)) {
  const fs::path there = existing_part(path_);
  std::error_code error;
  if (!fs::is_directory(there, error))
    refuse(path_, fmt::format("cannot be a run directory: {} is a file", there.string()));
  if (access(there.c_str(), W_OK | X_OK) != 0)
    refuse(path_, fmt::format("cannot be written: no permission in {}", there.string()));
  try {
    while (lock_ < 0) {
      fresh_ = fs::create_directories(path_, error);
      if (error) refuse(path_, "cannot be made: " + error.message());
      lock_ = lock(path_);
    }
    refuse_what_stays(force);
  } catch (...) {  // also where memory ends; what another run has locked is that run's
    if (lock_ >= 0) {
      abandon();
      close(lock_);
    }
    throw;
  }
}

RunDirectory::~RunDirectory() { close(lock_); }

void RunDirectory::refuse_what_stays(bool force) const {
  const bool holds_run = is_there(path_ / scene_file) || is_there(path_ / summary_file);
  if (holds_run && !force)
    throw InputError("holds a run already", path_.string(),
                     "Give another directory with --out, or --force to replace that run.");
  for (const char* name : run_files()) {
    const fs::file_status status = status_of(path_ / name);
    if (!fs::exists(status)) continue;
    if (!fs::is_regular_file(status))
      refuse(path_, fmt::format("holds {}, which is no file of a run{}", name,
                                fs::is_symlink(status) ? " but a symbolic link" : ""));
    if (!holds_run) refuse(path_, fmt::format("holds {}, and no run that could own it", name));
  }
  const fs::file_status fields = status_of(path_ / folder_of_fields);
  if (fs::exists(fields) && !fs::is_directory(fields))
    refuse(path_, fmt::format("holds {}, which is no folder of a run{}", folder_of_fields,
                              fs::is_symlink(fields) ? " but a symbolic link" : ""));
}

void RunDirectory::clear() {
  std::error_code error;
  for (const fs::path& state : listed_states(path_)) {
    if (fs::is_regular_file(status_of(state))) fs::remove(state, error);
  }
  if (fs::is_directory(status_of(path_ / folder_of_fields)))
    fs::remove(path_ / folder_of_fields, error);  // stays where it holds something else
  for (const char* name : run_files()) remove(name);
}

bool RunDirectory::has_checkpoint() const {
  return is_there(path_ / latest_checkpoint) || is_there(path_ / earlier_checkpoint);
}

void RunDirectory::go_on() {
  for (const char* name : of_its_end) remove(name);
}

fs::path RunDirectory::new_trace() {
  const fs::file_status status = status_of(path_ / trace_file);
  if (fs::exists(status) && !fs::is_regular_file(status))
    refuse(path_, fmt::format("holds {}, which is no file of a run", trace_file));
  remove(trace_file);
  return path_ / trace_file;
}

void RunDirectory::remove(const char* name) {
  std::error_code error;
  fs::remove(path_ / name, error);
  if (error) refuse(path_, fmt::format("cannot lose {}: {}", name, error.message()));
}

void RunDirectory::abandon() {
  std::error_code not_empty;
  if (fresh_) fs::remove(path_, not_empty);
}

}  // namespace abut
