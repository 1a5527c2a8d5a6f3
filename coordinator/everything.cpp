#include "coordinator/everything.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/index.hpp"
#include "base/input_errors.hpp"

namespace abut {

namespace {

/// The places of a facet's nodes, in an order of their own.
std::vector<double> places(const PortGeometry& surface, std::size_t facet) {
  const std::size_t dim = index(surface.dim);
  std::vector<std::vector<double>> nodes;
  for (std::int32_t k = surface.offsets[facet]; k < surface.offsets[facet + 1]; ++k) {
    const auto at =
        surface.points.begin() + static_cast<std::ptrdiff_t>(index(surface.facets[index(k)]) * dim);
    nodes.emplace_back(at, at + static_cast<std::ptrdiff_t>(dim));
  }
  std::ranges::sort(nodes);
  std::vector<double> all;
  for (const std::vector<double>& node : nodes) all.insert(all.end(), node.begin(), node.end());
  return all;
}

/// A facet of two ports would touch twice.
void require_single_facets(const Description& body, const Document& document) {
  if (body.ports.size() < 2) return;
  std::map<std::vector<double>, std::string> ports;  // by a facet of theirs
  for (const Port& port : body.ports) {
    for (std::size_t f = 0; f + 1 < port.geometry.offsets.size(); ++f) {
      const auto [entry, fresh] = ports.emplace(places(port.geometry, f), port.name);
      if (fresh) continue;
      throw InputError(
          fmt::format("has the ports {} and {}, which share a facet: everything would touch it "
                      "twice",
                      entry->second, port.name),
          document.where(fmt::format("bodies.{}.ports", body.name)),
          "Leave one of them out, or write interfaces in place of contact.everything.");
    }
  }
}

void validate_body(const Description& body, const Document& document) {
  const std::string where = document.where("bodies." + body.name);
  if (body.dim == 1)
    throw InputError("is a bar, and contact.everything is of surfaces", where,
                     "Write the interfaces of bars one by one under interfaces.");
  const bool touches = std::ranges::any_of(
      body.ports, [](const Port& port) { return !port.geometry.facets.empty(); });
  if (!touches)
    throw InputError("has no port with a surface, so nothing could touch it", where,
                     "Give it one under ports, or write interfaces in place of "
                     "contact.everything.");
  require_single_facets(body, document);
}

}  // namespace

void validate_everything(const Scene& scene, std::span<const Description* const> bodies,
                         const Document& document) {
  if (scene.everything() == nullptr) return;
  InputErrors errors;
  const std::string where = document.where(std::string(everything_path));
  if (bodies.size() < 2)
    errors.add({"has no effect: the scene has one body", where, "Leave it out."});
  for (const auto& [name, interface] : scene.interfaces)
    if (name == everything_name)
      errors.add({"has the name of contact.everything in what a run tells",
                  document.where("interfaces." + name), "Give it another name."});
  for (const Description* body : bodies)
    if (body != nullptr) errors.gather([&] { validate_body(*body, document); });
  errors.raise();
}

}  // namespace abut
