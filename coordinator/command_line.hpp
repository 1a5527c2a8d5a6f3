#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/awaited.hpp"

namespace abut {

struct RunCommand {
  std::string scene;
  std::string out;  // empty: runs/<scene name>
  std::vector<std::string> overrides;
  bool local = false;
  bool quiet = false;
  bool force = false;
  bool insecure = false;
  unsigned grace = 10;  // [s] for the window under way, where a signal ends the run
  bool trace = false;
  std::optional<Awaited> awaited;  // absent: processes come to life as the scene says
};
struct ResumeCommand {
  std::string directory;
  std::string scene;  // empty: as the run has it
  std::string end;    // empty: the scene's; else in YAML
  std::vector<std::string> overrides;
  bool local = false;
  bool quiet = false;
  bool insecure = false;
  unsigned grace = 10;  // [s] for the window under way, where a signal ends the run
  bool trace = false;
  std::optional<Awaited> awaited;
};
struct KeygenCommand {
  std::string directory;
  std::vector<std::string> bodies;
};
struct CheckCommand {
  std::string scene;
  std::vector<std::string> overrides;
  bool verbose = false;
  double probe = 2.0;  // [s] for which the run is tried; 0: it is not
};
struct SplitCommand {
  std::string scene;
  int bodies = 2;
  std::string body;  // empty: the only one that can be divided
  std::string out;   // empty: <scene name>_split_<bodies>
  std::vector<std::string> overrides;
  bool force = false;
};
struct InitCommand {
  std::string name;
  std::string from = "bars";
  std::vector<std::string> meshes;  // of mesh and gmsh
  bool force = false;
};
struct ConformanceCommand {
  std::string what;               // a scene, a program or an endpoint
  std::string keys = "{}";        // in YAML, of a program or an endpoint alone
  std::string body = "body";      // its name, likewise
  double window = 1.0e-3;         // [s] likewise
  double deadline = 10.0;         // [s] likewise
  std::vector<std::string> only;  // clauses; empty: all
  std::vector<std::string> overrides;
  bool names_scene() const { return what.ends_with(".yaml") || what.ends_with(".yml"); }
};
struct SlurmCommand {
  std::string scene;
  std::string directory;             // of the run; empty: runs/<scene name>
  std::string script;                // file; empty: standard output
  std::vector<std::string> options;  // of sbatch
  std::vector<std::string> overrides;
  bool force = false;
};
struct KubernetesCommand {
  std::string scene;
  std::string out;  // folder; empty: <scene name>_kubernetes
  std::string image = "abut:latest";
  std::string claim;  // empty: none
  std::vector<std::string> overrides;
  bool force = false;
};
struct ReferenceCommand {
  std::string key;  // empty: all of them
  bool json_schema = false;
  bool keys = false;
};
/// `abut V ...` where V is none of ours: the program abut-V.
struct ExternalCommand {
  std::string verb;
  std::vector<std::string> arguments;
};
/// Help, version, or what is wrong with the command line.
struct PrintCommand {
  std::string text;
  int exit_code = 0;  // other than 0: for standard error
};

using Command = std::variant<RunCommand, ResumeCommand, CheckCommand, SplitCommand, InitCommand,
                             KeygenCommand, ReferenceCommand, ConformanceCommand, SlurmCommand,
                             KubernetesCommand, ExternalCommand, PrintCommand>;

/// Never throws: a command line that is wrong becomes a PrintCommand with exit code 2.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace abut
