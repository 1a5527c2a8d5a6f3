#include "coordinator/jobs/kubernetes_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "base/error.hpp"

namespace abut {

namespace {

constexpr std::size_t most_name = 40;          // of 63, as Kustomize and Jobs add to it
constexpr std::size_t most_files = 1'000'000;  // [B] of a ConfigMap, which holds 1 MiB
constexpr int user = 10001;                    // of the image (Dockerfile)

/// A Job with one container. {0} job, {1} run, {2} part of the run, {3} image, {4} program and
/// words, {5} CPUs, {6} keys, {7} scene, {8} user, {9} more mounts, {10} more volumes,
/// {11} retries.
constexpr const char* job_text = R"(apiVersion: batch/v1
kind: Job
metadata:
  name: {0}
  labels: {{app.kubernetes.io/name: {1}, app.kubernetes.io/component: {2}}}
spec:
  backoffLimit: {11}
  template:
    metadata:
      labels: {{app.kubernetes.io/name: {1}, app.kubernetes.io/component: {2}}}
    spec:
      restartPolicy: Never
      automountServiceAccountToken: false
      enableServiceLinks: false
      terminationGracePeriodSeconds: 60
      securityContext:
        runAsNonRoot: true
        runAsUser: {8}
        runAsGroup: {8}
        fsGroup: {8}
        seccompProfile: {{type: RuntimeDefault}}
      initContainers:
        # Files of a Secret may be read by a group; abut wants its own for one user alone.
        - name: keys
          image: {3}
          command: [sh, -c, "umask 077 && mkdir /keys/own && cp /secret/* /keys/own/"]
          securityContext: &closed
            allowPrivilegeEscalation: false
            readOnlyRootFilesystem: true
            capabilities: {{drop: [ALL]}}
          volumeMounts:
            - {{name: secret, mountPath: /secret, readOnly: true}}
            - {{name: keys, mountPath: /keys}}
      containers:
        - name: abut
          image: {3}
          command: {4}
          resources: {{requests: {{cpu: "{5}"}}}}
          securityContext: *closed
          volumeMounts:
            - {{name: keys, mountPath: /keys}}
            - {{name: scene, mountPath: /scene, readOnly: true}}
            - {{name: temporary, mountPath: /tmp}}
{9}      volumes:
        - name: secret
          secret: {{secretName: {6}, defaultMode: 0440}}
        - name: keys
          emptyDir: {{medium: Memory}}
        - name: scene
          configMap: {{name: {7}}}
        - name: temporary
          emptyDir: {{}}
{10})";

constexpr const char* service_text = R"(apiVersion: v1
kind: Service
metadata:
  name: {0}
  labels: {{app.kubernetes.io/name: {1}}}
spec:
  clusterIP: None  # headless: the name is that of the coordinator's pod
  publishNotReadyAddresses: true
  selector: {{app.kubernetes.io/name: {1}, app.kubernetes.io/component: coordinator}}
  ports:
    - {{name: bodies, port: 5555}}
---
)";

std::string in_quotes(const std::string& text) { return nlohmann::json(text).dump(); }

std::string list_of(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(in_quotes(word));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

std::string read_mesh(const MeshFile& mesh) {
  std::ifstream file(mesh.file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file) return text;
  throw InputError("cannot be read", mesh.file, fmt::format("Correct {}.", mesh.key));
}

/// Names of parts of the run, no two alike.
std::vector<std::string> part_names(const std::vector<ProcessPlan>& processes) {
  std::vector<std::string> names;
  std::set<std::string> used{"coordinator"};
  for (const ProcessPlan& process : processes) {
    std::string name = resource_name(process.name);
    if (!used.insert(name).second) {
      name += fmt::format("-{}", names.size());
      used.insert(name);
    }
    names.push_back(name);
  }
  return names;
}

/// Scene and meshes in one folder, under names of their own; and what puts them in the scene's
/// keys.
struct Packed {
  std::map<std::string, std::string> files;  // texts, by name
  std::vector<std::string> overrides;
};

Packed pack(const KubernetesJob& job) {
  namespace fs = std::filesystem;
  Packed packed{{{fs::path(job.scene).filename().string(), job.text}}, job.overrides};
  std::map<std::string, std::string> names;  // of meshes, by file
  std::size_t bytes = job.text.size();
  for (const MeshFile& mesh : job.meshes) {
    const auto [entry, fresh] = names.emplace(mesh.file, "");
    if (fresh) {
      entry->second = fs::path(mesh.file).filename().string();
      while (packed.files.contains(entry->second))
        entry->second = fmt::format("{}-{}", packed.files.size(), entry->second);
      const std::string& text = packed.files[entry->second] = read_mesh(mesh);
      bytes += text.size();
    }
    packed.overrides.push_back(fmt::format("{}=/scene/{}", mesh.key, entry->second));
  }
  if (bytes <= most_files) return packed;
  throw InputError(
      fmt::format("is, with its meshes, {} bytes, and a ConfigMap holds {}", bytes, most_files),
      job.scene,
      "Put the meshes in a volume that all pods mount, and name them from / on in the scene's "
      "keys.");
}

std::string kustomization(const std::string& run, const Packed& packed,
                          const std::vector<ProcessPlan>& processes,
                          const std::vector<std::string>& parts) {
  std::string text = fmt::format(
      "# Written by abut kubernetes. Keys are made once, before `kubectl apply -k` of this "
      "folder:\n"
      "#   abut keygen keys");
  for (const ProcessPlan& process : processes) text += ' ' + process.name;
  text += '\n';
  for (const std::string& need : needs_of_image(processes)) text += fmt::format("# {}\n", need);
  text +=
      "apiVersion: kustomize.config.k8s.io/v1beta1\nkind: Kustomization\nresources:\n"
      "  - coordinator.yaml\n  - bodies.yaml\nconfigMapGenerator:\n";
  text += fmt::format("  - name: {}-scene\n    files:\n", run);
  for (const auto& [name, content] : packed.files)
    text += fmt::format("      - {}\n", in_quotes("scene/" + name));
  text += fmt::format(
      "secretGenerator:  # to each what it needs and no more\n"
      "  - name: {}-coordinator-keys\n    files:\n      - keys/coordinator.key_secret\n",
      run);
  for (const ProcessPlan& process : processes)
    text += fmt::format("      - keys/{}.key\n", process.name);
  for (std::size_t k = 0; k < processes.size(); ++k)
    text += fmt::format(
        "  - name: {}-{}-keys\n    files:\n      - keys/coordinator.key\n      - "
        "keys/{}.key_secret\n",
        run, parts[k], processes[k].name);
  return text;
}

std::string job_of(const std::string& run, const std::string& part, const KubernetesJob& job,
                   const std::vector<std::string>& words, int cpus, int retries,
                   const std::string& mounts, const std::string& volumes) {
  const std::string name = run + '-' + part;
  return fmt::format(fmt::runtime(job_text), name, run, part, in_quotes(job.image), list_of(words),
                     cpus, name + "-keys", run + "-scene", user, mounts, volumes, retries);
}

}  // namespace

std::string resource_name(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const bool capital = c >= 'A' && c <= 'Z';
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    name += capital ? static_cast<char>(c - 'A' + 'a') : plain ? c : '-';
  }
  name = name.substr(0, most_name);
  while (name.starts_with('-')) name.erase(0, 1);
  while (name.ends_with('-')) name.pop_back();
  return name.empty() ? "run" : name;
}

std::vector<std::string> needs_of_image(const std::vector<ProcessPlan>& processes) {
  std::vector<std::string> needs;
  for (const ProcessPlan& process : processes) {
    if (process.program.empty()) continue;
    const bool whole = process.program.starts_with('/');
    needs.push_back(fmt::format(
        "The image must hold the program of {}, {}{}: none is taken along from here. Another "
        "path there: --set bodies.{}.launch.spawn.program=PATH",
        process.name, in_quotes(process.program), whole ? "" : " on its PATH", process.name));
  }
  return needs;
}

std::vector<std::pair<std::string, std::string>> kubernetes_files(
    const KubernetesJob& job, const std::vector<ProcessPlan>& processes) {
  const std::string stem = job_name(job.scene);
  const std::string run = resource_name(stem).substr(0, 20);
  const std::vector<std::string> parts = part_names(processes);
  const Packed packed = pack(job);
  std::vector<std::string> words{"abut",
                                 "run",
                                 "/scene/" + std::filesystem::path(job.scene).filename().string(),
                                 "--out",
                                 "/abut/runs/" + stem,
                                 "--await",
                                 "tcp://0.0.0.0:5555",
                                 "--keys",
                                 "/keys/own",
                                 "--patience",
                                 "600"};
  for (const std::string& each : packed.overrides) words.insert(words.end(), {"--set", each});
  const std::string runs = job.claim.empty()
                               ? "emptyDir: {}  # goes with the pod: --claim keeps the run"
                               : fmt::format("persistentVolumeClaim: {{claimName: {}}}", job.claim);
  std::string coordinator = fmt::format(fmt::runtime(service_text), run + "-coordinator", run) +
                            job_of(run, "coordinator", job, words, 1, 0,
                                   "            - {name: runs, mountPath: /abut/runs}\n",
                                   fmt::format("        - name: runs\n          {}\n", runs));
  std::string bodies;
  for (std::size_t k = 0; k < processes.size(); ++k) {
    const ProcessPlan& process = processes[k];
    std::vector<std::string> solver{process.program.empty() ? "abut-solver" : process.program,
                                    "--connect", fmt::format("tcp://{}-coordinator:5555", run),
                                    "--keys", "/keys/own"};
    if (process.program.empty()) solver.insert(solver.end(), {"--patience", "600"});
    const std::vector<std::string> which = process.words();
    solver.insert(solver.end(), which.begin(), which.end());
    bodies += (k > 0 ? "---\n" : "") +
              job_of(run, parts[k], job, solver, process.threads, job.retries, "", "");
  }
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& [name, text] : packed.files) files.emplace_back("scene/" + name, text);
  files.emplace_back("coordinator.yaml", std::move(coordinator));
  files.emplace_back("bodies.yaml", std::move(bodies));
  files.emplace_back("kustomization.yaml", kustomization(run, packed, processes, parts));
  return files;
}

}  // namespace abut
