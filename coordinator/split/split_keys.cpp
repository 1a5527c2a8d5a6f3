#include "coordinator/split/split_keys.hpp"

#include <algorithm>

namespace abut {

namespace {

/// "hit" of "hit_2", where the scene has it; else the name itself.
std::string undivided(const Document& document, const std::string& interface) {
  const std::string before = interface.substr(0, interface.rfind('_'));
  const bool divided =
      !document.has("interfaces." + interface) && document.has("interfaces." + before);
  return divided ? before : interface;
}

}  // namespace

bool SplitKeys::wants(const std::string& path) const {
  const std::vector<std::string> steps = split_path(path);
  if (steps.size() == 1 && (steps[0] == "bodies" || steps[0] == "interfaces")) return true;
  if (steps[0] == "interfaces") return wants_of_interface(steps);
  const bool part = steps[0] == "bodies" && std::ranges::count(parts_, steps[1]) > 0;
  return part ? wants_of_part(steps) : document_.says(path);
}

bool SplitKeys::wants_of_interface(const std::vector<std::string>& steps) const {
  if (steps.size() == 2) return true;
  const std::string name = undivided(document_, steps[1]);
  if (!document_.has("interfaces." + name))  // a tie of parts
    return steps.size() == 3 && (steps[2] == "sides" || steps[2] == "tied");
  std::string path = "interfaces." + name;
  for (std::size_t k = 2; k < steps.size(); ++k) path = join_path(path, steps[k]);
  return document_.says(path);
}

bool SplitKeys::wants_of_part(const std::vector<std::string>& steps) const {
  if (steps.size() == 2) return true;
  const std::string body = "bodies." + whole_.name;
  std::string path = body, own;
  for (std::size_t k = 2; k < steps.size(); ++k) {
    path = join_path(path, steps[k]);
    own = join_path(own, steps[k]);
  }
  if (own.starts_with("model.fe.mesh"))
    return own == "model.fe.mesh" || own.ends_with(".gmsh") || own.ends_with(".file");
  if (own == "model.fe.map" || own == "initial.position") return false;         // the mesh is there
  if (steps[2] == "constraints") return document_.says(body + ".constraints");  // other keys, too
  if (own == "ports") return true;
  const bool cut = steps[2] == "ports" && !document_.says(body + ".ports." + steps[3]);
  if (cut) return steps.size() == 4 || steps[4] == "side";
  return document_.says(path);
}

}  // namespace abut
