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

/// What scenes may start: whole paths, and HOST:PROGRAM of other machines.
struct Listed {
  std::set<fs::path> programs;
  std::set<std::string> elsewhere;
};

/// One a line; # begins a comment.
Listed read_list(const std::string& file) {
  Listed listed;
  require_own_list(file);
  std::ifstream list(file);
  int number = 0;
  for (std::string line; std::getline(list, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == line.npos || line[begin] == '#') continue;
    const std::string path = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
    const std::size_t colon = path.find(':');
    if (path.starts_with('/')) {
      listed.programs.insert(plain(path));
    } else if (colon != path.npos && colon > 0 && path.find('/') > colon) {
      listed.elsewhere.insert(path);
    } else {
      throw InputError(fmt::format("is no whole path: {}", path),
                       fmt::format("{}:{}", file, number),
                       "Write programs from / on, one a line; of other machines HOST:PROGRAM.");
    }
  }
  return listed;
}

struct Named {
  std::string program, key;  // key path
  bool over_ssh = false;     // `program` is HOST:PROGRAM
};

std::vector<Named> named_programs(const Scene& scene) {
  std::vector<Named> all;
  for (const auto& [name, entry] : scene.bodies) {
    Named named;
    if (const SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch))
      named = {spawn->program, fmt::format("bodies.{}.launch.spawn.program", name), false};
    if (const GroupLaunch* group = std::get_if<GroupLaunch>(&entry.launch))
      named = {group->program, fmt::format("bodies.{}.launch.group.program", name), false};
    if (const SshLaunch* ssh = std::get_if<SshLaunch>(&entry.launch))
      named = {ssh->destination() + ':' + ssh->remote_program(),
               fmt::format("bodies.{}.launch.ssh", name), true};
    const bool told = std::any_of(all.begin(), all.end(), [&named](const Named& other) {
      return other.program == named.program;
    });
    if (!named.program.empty() && !told) all.push_back(std::move(named));
  }
  return all;
}

InputError not_listed(const std::string& program, const std::string& where, const fs::path& found,
                      const std::string& file) {
  return InputError(fmt::format("would start {}, which is not on your list of programs", program),
                    where,
                    fmt::format("If you trust it, add the line {} to {}.", found.string(), file));
}

void require_closed(const std::string& endpoint, bool keys, bool insecure, const std::string& where,
                    const std::string& key) {
  if (keys || is_local_endpoint(endpoint)) return;
  if (!insecure)
    throw InputError(
        fmt::format("is {}, where whoever reaches it could read the scene and be its bodies",
                    endpoint),
        where,
        fmt::format("Give keys: abut keygen keys BODY ..., and {}; or tcp://127.0.0.1:PORT "
                    "for programs of this machine; or --insecure on a network that you trust.",
                    key));
  std::fputs(fmt::format("warning: --insecure: whoever reaches {} can read the scene and be its "
                         "bodies\n",
                         endpoint)
                 .c_str(),
             stderr);
}

}  // namespace

void check_awaited(const Awaited& awaited, bool insecure) {
  require_closed(awaited.endpoint, !awaited.keys.empty(), insecure, "--await", "--keys keys");
}

void check_endpoint(const Scene& scene, const Document& document, bool insecure) {
  const std::string& endpoint = scene.network.endpoint;
  const bool waits = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& body) {
    return std::holds_alternative<ConnectLaunch>(body.second.launch);
  });
  if (!waits) return;
  require_closed(endpoint, !scene.network.keys.empty(), insecure,
                 document.where("network.endpoint"), "network: {keys: keys}");
}

std::string list_of_programs() {
  if (const char* file = std::getenv("ABUT_PROGRAMS"); file != nullptr && *file != '\0')
    return file;
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder != nullptr && *folder == '/')
    return std::string(folder) + "/abut/programs";
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : "") + "/.config/abut/programs";
}

void check_program(const std::string& program, const std::string& where) {
  const std::string file = list_of_programs();
  const fs::path found = found_on_path(program);
  if (is_ours(found) || read_list(file).programs.contains(found)) return;
  throw not_listed(program, where, found, file);
}

void check_programs(const Scene& scene, const Document& document) {
  const std::vector<Named> named = named_programs(scene);
  if (named.empty()) return;
  const std::string file = list_of_programs();
  const Listed listed = read_list(file);
  InputErrors errors;
  for (const auto& [program, key, over_ssh] : named) {
    if (over_ssh) {
      if (!listed.elsewhere.contains(program))
        errors.add(
            {fmt::format("would start {} over ssh, which is not on your list of programs", program),
             document.where(key),
             fmt::format("If this is what you want, add the line {} to {}.", program, file)});
      continue;
    }
    const fs::path found = found_on_path(program);
    if (listed.programs.contains(found) || is_ours(found)) continue;
    errors.add(not_listed(program, document.where(key), found, file));
  }
  errors.raise();
}

}  // namespace abut
