#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coordinator/jobs/process_plan.hpp"

namespace abut {

/// What a cluster is told beside the scene.
struct KubernetesJob {
  std::string scene;                   // path of its file
  std::string text;                    // of the scene
  std::vector<std::string> overrides;  // key.path=value
  std::vector<MeshFile> meshes;
  std::string image;
  int retries = 0;    // of a process of bodies that has failed
  std::string claim;  // of a volume for the run's folder; empty: it goes with the pod
};

/// Files of a Kustomize base, by their paths in its folder: a Job for the coordinator and for each
/// process of bodies, a headless Service, and lists from which Kustomize makes a ConfigMap of scene
/// and meshes and a Secret of keys for each Job. The keys themselves are not among them. Throws
/// InputError where a mesh cannot be read, or all is more than a ConfigMap holds.
std::vector<std::pair<std::string, std::string>> kubernetes_files(
    const KubernetesJob& job, const std::vector<ProcessPlan>& processes);

/// What the image must hold beside abut, in a sentence for each program of somebody else.
std::vector<std::string> needs_of_image(const std::vector<ProcessPlan>& processes);

/// A name of a resource: letters in lower case, digits and hyphens, 40 at most.
std::string resource_name(const std::string& text);

}  // namespace abut
