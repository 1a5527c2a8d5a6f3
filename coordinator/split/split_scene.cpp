#include "coordinator/split/split_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/yaml_fields.hpp"
#include "base/yaml_resolved.hpp"
#include "coordinator/split/partition.hpp"
#include "coordinator/split/split_body.hpp"
#include "coordinator/split/split_expectations.hpp"
#include "coordinator/split/split_keys.hpp"
#include "coordinator/split/split_names.hpp"
#include "subdomain_solver/fe/gmsh_text.hpp"
#include "subdomain_solver/make/read_body.hpp"

namespace abut {

namespace {

namespace fs = std::filesystem;

/// Names as those of copies: with as many digits as the last has.
std::vector<std::string> part_names(const std::string& body, int count) {
  std::vector<std::string> names;
  const std::size_t digits = std::to_string(count).size();
  for (int k = 1; k <= count; ++k) names.push_back(fmt::format("{}_{:0{}}", body, k, digits));
  return names;
}

/// The scene around the parts, in its own terms.
class Splitter {
 public:
  Splitter(const Document& document, const Scene& scene, const SplitOptions& options,
           WholeBody whole)
      : document_(document),
        scene_(scene),
        options_(options),
        whole_(std::move(whole)),
        names_(part_names(whole_.name, options.bodies)),
        parts_(divided()),
        where_(whole_.mesh, parts_) {}

  SplitScene split() {
    shorten_windows();
    divide_interfaces();
    divide_bodies();
    divide_what_is_expected();
    SplitScene out;
    out.scene = text();
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const auto& [point, spec] : whole_.spec.points) parts_[p].mesh.node_sets.erase(point);
      out.meshes.emplace_back(names_[p] + ".msh", gmsh_text(parts_[p].mesh));
      out.parts.push_back(words(p));
    }
    out.left_out = left_out_;
    return out;
  }

 private:
  std::vector<MeshPart> divided() const {
    const std::string where = document_.where("bodies." + whole_.name + ".model.fe.mesh");
    const CellGraph graph = cell_graph(whole_.mesh);
    const std::vector<std::int32_t> touched = touched_nodes(whole_);
    const std::vector<int> part =
        partition(graph, kept_together(whole_.mesh, touched), options_.bodies, where);
    std::vector<MeshPart> parts = divide(whole_.mesh, graph, part, names_, where);
    hold_single_nodes(document_, whole_, parts);
    return parts;
  }

  /// Windows of a body alone couple nothing, and may be long; ties want short ones: of one step,
  /// kernels are small, and next to exact where laws are not linear.
  void shorten_windows() {
    if (scene_.bodies.size() > 1) return;
    const double step =
        std::visit([](const auto& scheme) { return scheme.step; }, *whole_.spec.integrator);
    const double steps = std::round(scene_.time.window / step);
    if (steps < 2.0) return;
    scene_.time.window = step;
    shorter_windows_ = true;
    if (scene_.output.field_output)
      scene_.output.field_output->every *= static_cast<int>(std::min(steps, 1.0e3));
  }

  std::string words(std::size_t p) const {
    std::vector<std::string> tied;
    for (const auto& [other, side] : parts_[p].towards)
      tied.push_back(fmt::format("{} ({} facets)", names_[static_cast<std::size_t>(other)],
                                 parts_[p].mesh.side(side).size()));
    return fmt::format("{}: {} cells, {} nodes, tied to {}", names_[p], parts_[p].mesh.cell_count(),
                       parts_[p].mesh.node_count(), fmt::join(tied, ", "));
  }

  /// Of a side of an interface: the parts that have it; empty: it is of another body.
  std::vector<std::size_t> parts_at(const std::string& side) const {
    const PortName name = split_port(side);
    if (name.body != whole_.name) return {};
    for (const auto& [port, spec] : whole_.spec.ports)
      if (port == name.port) return where_.parts_of(spec.side);
    throw InputError(fmt::format("is {}, but {} has no port {}", side, name.body, name.port),
                     document_.where("interfaces"), "Name one of its ports.");
  }

  void add(const std::string& name, InterfaceSpec spec) {
    const auto same = [&name](const auto& entry) { return entry.first == name; };
    if (std::ranges::any_of(scene_.interfaces, same)) {
      throw InputError("is the name that an interface of the parts would have",
                       document_.where("interfaces." + name), "Give the interface another name.");
    }
    spec.name = name;
    scene_.interfaces.emplace_back(name, std::move(spec));
  }

  void divide_interfaces() {
    const auto before = std::exchange(scene_.interfaces, {});
    for (const auto& [name, spec] : before) {
      for (std::size_t s = 0; s < spec.sides.size(); ++s) {
        const std::vector<std::size_t> parts = parts_at(spec.sides[s]);
        if (parts.size() > 1) divided_interfaces_.push_back(name);
        for (std::size_t p : parts) {
          InterfaceSpec own = spec;
          own.sides[s] = names_[p] + "." + split_port(spec.sides[s]).port;
          rename(own, spec.sides[s], own.sides[s]);
          add(parts.size() == 1 ? name : name + names_[p].substr(whole_.name.size()), own);
        }
      }
      const auto ours = [this](const std::string& side) { return !parts_at(side).empty(); };
      if (std::ranges::none_of(spec.sides, ours)) add(name, spec);
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (const auto& [other, side] : parts_[p].towards) {
        const std::size_t q = static_cast<std::size_t>(other);
        if (q < p) continue;
        InterfaceSpec tie;
        tie.sides = {names_[p] + "." + side, names_[q] + "." + parts_[q].towards.at(int(p))};
        tie.tied.emplace();
        add(names_[p] + "_" + names_[q], std::move(tie));
      }
    }
  }

  /// A side that the interface gives a role.
  static void rename(InterfaceSpec& spec, const std::string& from, const std::string& to) {
    if (auto* unilateral = std::get_if<UnilateralTransmission>(&spec.transmission))
      if (unilateral->kinematic == from) unilateral->kinematic = to;
  }

  void divide_bodies() {
    const auto before = std::exchange(scene_.bodies, {});
    for (const auto& [name, entry] : before) {
      if (name != whole_.name) {
        scene_.bodies.emplace_back(name, entry);
        continue;
      }
      for (const std::string& part : names_) {
        const auto same = [&part](const auto& other) { return other.first == part; };
        if (std::ranges::any_of(before, same))
          throw InputError("is the name that a part would have", document_.where("bodies." + part),
                           "Give the body another name.");
        scene_.bodies.emplace_back(part, entry);
        scene_.bodies.back().second.name = part;
      }
    }
  }

  void divide_what_is_expected() {
    const Division division{whole_, names_, where_, divided_interfaces_, shorter_windows_};
    SplitExpectations expectations = divide_expectations(scene_.meta.expect, division);
    scene_.meta.expect = std::move(expectations.kept);
    left_out_ = std::move(expectations.left_out);
    scene_.meta.title += fmt::format(" ({} in {} parts)", whole_.name, names_.size());
  }

  std::string text() const {
    ResolvedYaml resolved(document_.units());
    resolved.add("", scene_);
    const fs::path from = fs::absolute(document_.name()).parent_path();
    const std::string folder = (from.lexically_proximate(fs::absolute(options_.out)) / "").string();
    for (const auto& [name, entry] : scene_.bodies) {
      const std::string path = "bodies." + name;
      const auto part = std::ranges::find(names_, name);
      if (part != names_.end()) {
        const std::size_t p = static_cast<std::size_t>(part - names_.begin());
        resolved.add(path, part_spec(whole_, where_, p, name + ".msh", parts_[p].towards));
      } else if (entry.external) {
        resolved.copy(path + ".model", document_);
      } else {
        BodySpec spec = read_body(document_, path, entry.context);
        spec.place_files(folder);
        resolved.add(path, spec);
      }
    }
    const SplitKeys keys(document_, whole_, names_);
    resolved.keep("", [&keys](const std::string& path) { return keys.wants(path); });
    return fmt::format("# Made by: abut split {} --bodies {} --body {}\n",
                       fs::path(document_.name()).filename().string(), names_.size(), whole_.name) +
           resolved.text();
  }

  const Document& document_;
  Scene scene_;
  const SplitOptions& options_;
  WholeBody whole_;
  std::vector<std::string> names_;  // of the parts
  std::vector<MeshPart> parts_;
  SplitNames where_;
  std::vector<std::string> divided_interfaces_;  // that are several now
  bool shorter_windows_ = false;
  std::vector<std::pair<std::string, std::string>> left_out_;
};

}  // namespace

SplitScene split_scene(const Document& document, const Scene& scene, const SplitOptions& options) {
  return Splitter(document, scene, options, whole_body(document, scene, options.body)).split();
}

}  // namespace abut
