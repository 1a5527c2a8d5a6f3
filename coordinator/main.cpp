#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "base/denormals.hpp"
#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/memory_end.hpp"
#include "base/shell_word.hpp"
#include "coordinator/command_line.hpp"
#include "coordinator/external_verb.hpp"
#include "coordinator/init/init_files.hpp"
#include "coordinator/interrupt.hpp"
#include "coordinator/jobs/kubernetes_files.hpp"
#include "coordinator/jobs/slurm_script.hpp"
#include "coordinator/json_schema.hpp"
#include "coordinator/launch_local.hpp"
#include "coordinator/record/text_file.hpp"
#include "coordinator/run_directory.hpp"
#include "coordinator/scene.hpp"
#include "coordinator/split/split_scene.hpp"
#include "coordinator/trust.hpp"
#include "coordinator/verbs/check.hpp"
#include "coordinator/verbs/conformance.hpp"
#include "coordinator/verbs/placed_scene.hpp"
#include "coordinator/verbs/resume.hpp"
#include "coordinator/verbs/run.hpp"
#include "messaging/key_files.hpp"

namespace abut {
namespace {

namespace fs = std::filesystem;

constexpr int exit_input = 2, exit_world = 3;

/// Where a divided scene goes when the command line does not say.
fs::path split_directory(const SplitCommand& command) {
  if (!command.out.empty()) return command.out;
  return fmt::format("{}_split_{}", fs::path(command.scene).stem().string(), command.bodies);
}

using NewFiles = std::vector<std::pair<fs::path, std::string>>;

/// In the order of the list; nothing where a file is in the way. `option`: that names the place.
void write_new(const NewFiles& files, bool force, const char* option) {
  for (const auto& [path, text] : files) {
    if (!force && fs::exists(fs::symlink_status(path)))
      throw InputError("is there already", path.string(),
                       fmt::format("Give another {}, or --force.", option));
  }
  for (const auto& [path, text] : files) {
    const fs::path directory = path.parent_path();
    std::error_code error;
    if (!directory.empty()) fs::create_directories(directory, error);
    if (error)
      throw InputError(fmt::format("cannot be made: {}", error.message()), directory.string(),
                       "Give a folder that can be written to.");
    write_whole(path, text);
  }
}

int split_verb(const SplitCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  const fs::path directory = split_directory(command);
  const SplitScene split = split_scene(document, scene, {command.bodies, command.body, directory});
  const fs::path written = directory / fs::path(command.scene).filename();
  NewFiles files;
  for (const auto& [name, text] : split.meshes) files.emplace_back(directory / name, text);
  files.emplace_back(written, split.scene);  // the last one: it needs the others
  write_new(files, command.force, "--out");
  for (const std::string& part : split.parts) fmt::print("{}\n", part);
  for (const auto& [measure, why] : split.left_out)
    fmt::print("left out: what is expected of {}: {}\n", measure, why);
  fmt::print("written: {}\n", written.string());
  return check_verb({written.string(), {}, false, 0.0});
}

int init_verb(const InitCommand& command) {
  const InitFiles made = init_files({command.name, command.from, command.meshes});
  write_new(made.files, command.force, "name");
  for (const std::string& line : made.words) fmt::print("{}\n", line);
  for (const auto& [path, text] : made.files) fmt::print("written: {}\n", path.string());
  const bool study = command.from == "study";  // its own file is the last one
  const std::string own = (study ? made.files.back() : made.files.front()).first.string();
  fmt::print("next: abut {} {}\n", study ? "study" : "run", shell_word(own));
  return 0;
}

int keygen_verb(const KeygenCommand& command) {
  for (const std::string& file : write_keys(command.directory, command.bodies))
    fmt::print("written: {}\n", file);
  fmt::print(
      "the coordinator needs coordinator.key_secret and the bodies' .key files; a body needs "
      "coordinator.key and its own .key_secret\n");
  return 0;
}

constexpr int retries = 6;  // of a body's job, as Kubernetes has it itself

bool restarts(const Scene& scene) { return scene.network.on_lost_body == OnLostBody::restart; }

int slurm_verb(const SlurmCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  const fs::path directory = command.directory.empty() ? default_run_directory(command.scene)
                                                       : fs::path(command.directory);
  const std::vector<ProcessPlan> processes = plan_processes(scene, document);
  for (const ProcessPlan& process : processes)
    if (!process.program.empty())
      check_program(process.program, document.where("bodies." + process.name + ".launch"));
  const bool again = !scene.stages.empty() || restarts(scene);
  const std::string text =
      slurm_script({fs::absolute(command.scene).string(), fs::absolute(directory).string(),
                    program_folder(), command.overrides, command.options, again},
                   processes);
  if (command.script.empty()) {
    fmt::print("{}", text);
    return 0;
  }
  write_new({{command.script, text}}, command.force, "--output");
  fmt::print("written: {0}\nnext: sbatch {0}\n", command.script);
  return 0;
}

int kubernetes_verb(const KubernetesCommand& command) {
  const Document document = Document::load(command.scene, command.overrides);
  const Scene scene = read_all_keys(document);
  if (!scene.stages.empty())
    throw InputError("begin with new processes, but jobs of Kubernetes start theirs once",
                     document.where("stages"), "Use abut slurm, or a scene of one stage.");
  const fs::path directory =
      command.out.empty() ? job_name(command.scene) + "_kubernetes" : command.out;
  const std::vector<ProcessPlan> processes = plan_processes(scene, document);
  NewFiles files;
  for (const auto& [name, text] : kubernetes_files(
           {command.scene, document.text(), command.overrides, mesh_files(scene, document),
            command.image, restarts(scene) ? retries : 0, command.claim},
           processes))
    files.emplace_back(directory / name, text);
  write_new(files, command.force, "--out");
  for (const auto& [path, text] : files) fmt::print("written: {}\n", path.string());
  for (const std::string& need : needs_of_image(processes)) fmt::print("note: {}\n", need);
  std::string names;
  for (const ProcessPlan& process : processes) names += ' ' + process.name;
  fmt::print("next: abut keygen {0}/keys{1} && kubectl apply -k {0}\n", directory.string(), names);
  return 0;
}

int reference_verb(const ReferenceCommand& command) {
  Reference reference;
  reference.add<Scene>("The scene", "");
  document_body_keys(reference);
  if (command.json_schema) {
    fmt::print("{}", json_schema(reference));
  } else if (command.keys) {
    fmt::print("{}", reference.key_paths());
  } else if (!command.key.empty()) {
    fmt::print("{}", reference.part(command.key));
  } else {
    fmt::print(
        "# Keys of a scene file\n\nPrinted by `abut reference`. Units are named in SI; any other "
        "consistent set (mm, ms, kg, kN, GPa)\ndoes as well: no constant is built in. A choice is "
        "written `{{name: {{its keys}}}}`, or as the name alone when all its\nkeys have "
        "defaults, and a list of one as its value alone. What alternatives of a choice have in "
        "common stands once: `{{fe,modal}}` are "
        "these two, `*` is each of them.\n`abut reference KEY` prints a part, as "
        "`abut reference bodies.b.material`.\n\n"
        "`abut reference --json-schema > abut.schema.json` writes the same as a JSON Schema. With "
        "it an editor that has a YAML\nlanguage server completes and checks a scene whose first "
        "line is `# yaml-language-server: $schema=abut.schema.json`.\n\n{}",
        reference.markdown());
  }
  return 0;
}

struct Verbs {
  int operator()(const RunCommand& command) const { return run_verb(command); }
  int operator()(const ResumeCommand& command) const { return resume_verb(command); }
  int operator()(const CheckCommand& command) const { return check_verb(command); }
  int operator()(const SplitCommand& command) const { return split_verb(command); }
  int operator()(const InitCommand& command) const { return init_verb(command); }
  int operator()(const KeygenCommand& command) const { return keygen_verb(command); }
  int operator()(const ReferenceCommand& command) const { return reference_verb(command); }
  int operator()(const ConformanceCommand& command) const { return conformance_verb(command); }
  int operator()(const SlurmCommand& command) const { return slurm_verb(command); }
  int operator()(const KubernetesCommand& command) const { return kubernetes_verb(command); }
  int operator()(const ExternalCommand& command) const {
    become_external_verb(command.verb, command.arguments);
  }
  int operator()(const PrintCommand& command) const {
    std::fputs(command.text.c_str(), command.exit_code == 0 ? stdout : stderr);
    return command.exit_code;
  }
};

int fail(const std::exception& error, int code) {
  // Not fmt::print, which throws where nobody takes the message.
  std::fputs(fmt::format("error: {}\n", error.what()).c_str(), stderr);
  return interrupt_exit_code() != 0 ? interrupt_exit_code() : code;
}

/// What was printed has arrived: a full disk tells so here at the latest.
int delivered(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  const char* why = errno != 0 ? std::strerror(errno) : "nobody takes it";
  throw RunError(fmt::format("cannot be written: {}", why), "standard output",
                 "Check that the output goes to a file or program that takes it.");
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  const abut::FlushedDenormals flushed;  // also of threads that bodies start
  abut::end_in_words_without_memory("error");
  std::signal(SIGXFSZ, SIG_IGN);  // a file at the limit of its size is an error of writing
  try {
    abut::offer_python_package();  // before there is a second thread
    return abut::delivered(std::visit(abut::Verbs{}, abut::parse_command_line(argc, argv)));
  } catch (const abut::InputErrorList& errors) {
    int code = abut::exit_input;
    const std::size_t most = std::min<std::size_t>(errors.all.size(), 20);  // that anybody reads
    for (std::size_t i = 0; i < most; ++i) code = abut::fail(errors.all[i], abut::exit_input);
    if (most < errors.all.size())
      std::fputs(fmt::format("and {} more\n", errors.all.size() - most).c_str(), stderr);
    return code;
  } catch (const abut::InputError& error) {
    return abut::fail(error, abut::exit_input);
  } catch (const std::bad_alloc&) {
    return abut::fail(abut::RunError("the memory is used up", "", "Give coarser meshes."),
                      abut::exit_world);
  } catch (const std::exception& error) {  // RunError, and what the library throws: memory, files
    return abut::fail(error, abut::exit_world);
  }
}
