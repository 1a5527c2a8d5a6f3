#include "coordinator/jobs/process_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/error.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_fields.hpp"
#include "coordinator/solver_processes.hpp"

namespace abut {

namespace {

constexpr std::string_view key_letters =  // of a file of keys
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";

/// Key path of a body's only model; empty: it has none that says more than its name.
std::string model_path(const Document& document, const std::string& body) {
  const std::string path = body + ".model";
  const std::vector<std::string> models = document.keys(path);
  return models.size() == 1 ? path + "." + models.front() : std::string();
}

int threads_of(const Document& document, const std::string& body) {
  int threads = 1;
  const std::string model = model_path(document, "bodies." + body);
  if (model.empty() || !document.has(model + ".threads")) return threads;
  read_fields(document, model, [&threads](Fields& f) {
    f.optional("threads", threads, "", "");
    f.ignore_rest();
  });
  return threads;
}

std::string program_elsewhere(const BodyEntry& entry, const Document& document) {
  if (!entry.external) return "";
  if (const SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch)) return spawn->program;
  if (const SshLaunch* ssh = std::get_if<SshLaunch>(&entry.launch)) return ssh->program;
  throw InputError("does not say which program the body is of",
                   document.where("bodies." + entry.name + ".launch"),
                   "Give launch: {spawn: {program: its path}}.");
}

void check_name(const std::string& name, const Document& document) {
  if (name.find_first_not_of(key_letters) == name.npos && name != "coordinator") return;
  throw InputError("has a name that no file of keys can have", document.where("bodies." + name),
                   "Use letters, digits, _ and - alone; coordinator is the name of the other end.");
}

void check_tables(const Document& document) {
  if (document.overrides_elsewhere().size() == document.overrides().size()) return;
  throw InputError("has copies of a table, whose file is not taken along", document.where("bodies"),
                   "Write the copies as a list or a grid.");
}

}  // namespace

std::vector<std::string> ProcessPlan::words() const {
  std::vector<std::string> words;
  if (bodies.size() > 1) words = {"--process", name};
  for (const std::string& body : bodies) words.insert(words.end(), {"--body", body});
  return words;
}

std::vector<ProcessPlan> plan_processes(const Scene& scene, const Document& document) {
  std::vector<ProcessPlan> plans;
  InputErrors errors;
  for (const SolverProcess& process : all_processes(scene)) {
    errors.gather([&] {
      ProcessPlan plan;
      plan.name = name_of_process(scene, process);
      if (process.bodies.size() == 1) check_name(plan.name, document);
      for (const std::size_t b : process.bodies) {
        const auto& [name, entry] = scene.bodies[b];
        plan.bodies.push_back(name);
        plan.program = program_elsewhere(entry, document);
        plan.threads = std::max(plan.threads, threads_of(document, name));
      }
      plans.push_back(std::move(plan));
    });
  }
  errors.raise();
  return plans;
}

std::vector<MeshFile> mesh_files(const Scene& scene, const Document& document) {
  check_tables(document);
  const std::filesystem::path folder = std::filesystem::path(document.name()).parent_path();
  std::vector<MeshFile> files;
  const auto add = [&](const std::string& at, const std::string& as_written) {
    const std::string model = model_path(document, at);
    for (const std::string& kind : document.keys(model + ".mesh")) {
      const std::string map = model + ".mesh." + kind;
      if (model.empty() || !document.has(map + ".file")) continue;
      std::string file;
      read_fields(document, map, [&file](Fields& f) {
        f.required("file", file, "", "");
        f.ignore_rest();
      });
      const std::string key = as_written + map.substr(at.size()) + ".file";
      if (std::ranges::find(files, key, &MeshFile::key) == files.end())
        files.push_back({key, (folder / file).string()});
    }
  };
  for (const auto& [name, entry] : scene.bodies) {
    const std::string written = document.body_of_copy(name);
    add("bodies." + name, "bodies." + (written.empty() ? name : written));
  }
  for (const std::string& stage : document.keys("stages"))
    for (const std::string& name : document.keys("stages." + stage + ".bodies")) {
      const std::string at = "stages." + stage + ".bodies." + name;
      add(at, at);
    }
  return files;
}

std::string job_name(const std::string& scene_path) {
  std::string name = std::filesystem::path(scene_path).stem().string();
  for (char& c : name)
    if (key_letters.find(c) == key_letters.npos) c = '_';
  return name;
}

}  // namespace abut
