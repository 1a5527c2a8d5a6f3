#include "coordinator/external_body.hpp"

#include <fmt/format.h>

#include "base/input_errors.hpp"

namespace abut {

namespace {
std::string model_of(const std::string& body) { return "bodies." + body + ".model"; }
}  // namespace

void ExternalBody::fields(Fields& f) {
  f.ignore("launch");
  f.ignore("like");
  f.choice("model", model,
           "model of the body; the keys of external are those of another program and reach it as "
           "they stand (proto/README.md)");
}

bool is_external(const Document& document, const std::string& body) {
  return document.chooses(model_of(body), ExternalModel::name);
}

void check_external_launch(const BodyEntry& entry, const Document& document) {
  if (!entry.external) return;
  if (std::holds_alternative<GroupLaunch>(entry.launch))
    throw InputError("is of another program, whose process holds no other body",
                     document.where("bodies." + entry.name + ".launch.group"),
                     "Give launch: {connect: {}} and start that program yourself, or launch: "
                     "{spawn: {program: its path}}.");
  if (const SshLaunch* ssh = std::get_if<SshLaunch>(&entry.launch)) {
    const std::string path = "bodies." + entry.name + ".launch.ssh";
    if (!ssh->group.empty())
      throw InputError("is of another program, whose process holds no other body",
                       document.where(path + ".group"), "Leave group out.");
    if (ssh->program.empty())
      throw InputError("is of another program, but abut-solver would be started for it",
                       document.where(path), "Give program: its path on that machine.");
    return;
  }
  const SpawnLaunch* spawn = std::get_if<SpawnLaunch>(&entry.launch);
  if (spawn == nullptr || !spawn->program.empty()) return;
  throw InputError("is of another program, but abut-solver would be started for it",
                   document.where(model_of(entry.name)),
                   "Give launch: {connect: {}} and start that program yourself, or launch: "
                   "{spawn: {program: its path}}.");
}

void check_external_like(const BodyEntry& entry, const Document& document) {
  const std::string path = "bodies." + entry.name + ".like";
  if (!entry.external || !document.has(path)) return;
  throw InputError("is for bodies of this program: another one reads the text as it stands",
                   document.where(path), "Write the external body out.");
}

void refuse_external_bodies(const Scene& scene, const Document& document) {
  InputErrors errors;
  for (const auto& [name, entry] : scene.bodies)
    if (entry.external)
      errors.add({"is of another program, which cannot live in this process",
                  document.where(model_of(name)), "Run without --local."});
  errors.raise();
}

}  // namespace abut
