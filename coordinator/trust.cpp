#include "coordinator/trust.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <system_error>
#include <variant>

#include "base/endpoint.hpp"
#include "base/input_errors.hpp"

namespace abut {

namespace {

namespace fs = std::filesystem;

/// Without symbolic links, as far as it is there.
fs::path plain(const fs::path& path) {
  std::error_code error;
  fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? path : found;
}

/// As execvp finds it.
fs::path found_on_path(const std::string& program) {
  if (program.find('/') != program.npos) return plain(program);
  const char* places = std::getenv("PATH");
  std::istringstream list(places != nullptr ? places : "/bin:/usr/bin");
  for (std::string folder; std::getline(list, folder, ':');) {
    const fs::path candidate = fs::path(folder.empty() ? "." : folder) / program;
    if (access(candidate.c_str(), X_OK) == 0) return plain(candidate);
  }
  return program;
}

bool is_ours(const fs::path& program) {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return !error && program.parent_path() == self.parent_path() &&
         program.filename().string().starts_with("abut");
}

void require_own_list(const std::string& file) {
  struct stat about {};
  if (stat(file.c_str(), &about) != 0) return;
  if (about.st_uid != geteuid() && about.st_uid != 0)
    throw InputError("belongs to another user", file, "Name a list of your own.");
  if ((about.st_mode & 022) != 0)
    throw InputError("may be written by other users", file,
                     fmt::format("Close it: chmod go-w {}", file));
}

/// Absolute paths, one a line; # begins a comment.
std::set<fs::path> read_list(const std::string& file) {
  std::set<fs::path> programs;
  require_own_list(file);
  std::ifstream list(file);
  int number = 0;
  for (std::string line; std::getline(list, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos || line[begin] == '#') continue;
    const std::string path = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
    if (!path.starts_with('/'))
      throw InputError(fmt::format("is no whole path: {}", path),
                       fmt::format("{}:{}", file, number), "Write programs from / on, one a line.");
    programs.insert(plain(path));
  }
  return programs;
}

struct Named {
  std::string program, key;  // key path
};

std::vector<Named> named_programs(const Scene& scene) {
  std::vector<Named> all;
  for (const auto& [name, entry] : scene.bodies) {
    Named named;
    if (const SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch))
      named = {spawn->program, fmt::format("bodies.{}.launch.spawn.program", name)};
    if (const GroupLaunch* group = std::get_if<GroupLaunch>(&entry.launch))
      named = {group->program, fmt::format("bodies.{}.launch.group.program", name)};
    const bool told = std::any_of(all.begin(), all.end(), [&named](const Named& other) {
      return other.program == named.program;
    });
    if (!named.program.empty() && !told) all.push_back(std::move(named));
  }
  return all;
}

}  // namespace

void check_endpoint(const Scene& scene, const Document& document, bool insecure) {
  const std::string& endpoint = scene.network.endpoint;
  const bool waits = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& body) {
    return std::holds_alternative<ConnectLaunch>(body.second.launch);
  });
  if (!waits || !scene.network.keys.empty() || is_local_endpoint(endpoint)) return;
  if (!insecure)
    throw InputError(
        fmt::format("is {}, where whoever reaches it could read the scene and be its bodies",
                    endpoint),
        document.where("network.endpoint"),
        "Give keys: abut keygen keys BODY ..., and network: {keys: keys}; or tcp://127.0.0.1:PORT "
        "for programs of this machine; or --insecure on a network that you trust.");
  std::fputs(fmt::format("warning: --insecure: whoever reaches {} can read the scene and be its "
                         "bodies\n",
                         endpoint)
                 .c_str(),
             stderr);
}

std::string list_of_programs() {
  if (const char* file = std::getenv("ABUT_PROGRAMS"); file != nullptr && *file != '\0')
    return file;
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder != nullptr && *folder == '/')
    return std::string(folder) + "/abut/programs";
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : "") + "/.config/abut/programs";
}

void check_programs(const Scene& scene, const Document& document) {
  const std::vector<Named> named = named_programs(scene);
  if (named.empty()) return;
  const std::string file = list_of_programs();
  const std::set<fs::path> listed = read_list(file);
  InputErrors errors;
  for (const auto& [program, key] : named) {
    const fs::path found = found_on_path(program);
    if (listed.contains(found) || is_ours(found)) continue;
    errors.add({fmt::format("would start {}, which is not on your list of programs", program),
                document.where(key),
                fmt::format("If you trust it, add the line {} to {}.", found.string(), file)});
  }
  errors.raise();
}

}  // namespace abut
