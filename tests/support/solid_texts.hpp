#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/index.hpp"
#include "tests/support/scenes.hpp"

namespace abut {

/// Numbers of a vector as a scene writes it, those that are not given are zero.
inline std::string components(std::vector<double> values, int dim) {
  values.resize(index(dim), 0.0);
  std::vector<std::string> words;
  for (const double value : values) words.push_back(number(value));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

/// A rectangle or a box of cells; `element` may be empty.
inline std::string block_mesh(const std::vector<double>& lengths, const std::vector<int>& cells,
                              const std::string& element = "") {
  return fmt::format("{}: {{lengths: [{}], elements: [{}]{}}}",
                     lengths.size() == 2 ? "rectangle" : "box", fmt::join(lengths, ", "),
                     fmt::join(cells, ", "), element.empty() ? "" : ", element: " + element);
}

/// A bar of length 1 and height (and breadth) 0.25 with 8 cells along and `across` cells over it.
inline std::string bar_mesh(int dim, int across, const std::string& element = "") {
  if (dim == 2) return block_mesh({1.0, 0.25}, {8, across}, element);
  return block_mesh({1.0, 0.25, 0.25}, {8, across, across}, element);
}

/// A law of unit modulus and density.
inline std::string unit_law(const std::string& law, double poissons_ratio,
                            const std::string& more = "") {
  return fmt::format("{}: {{youngs_modulus: 1.0, poissons_ratio: {}, density: 1.0{}}}", law,
                     number(poissons_ratio), more);
}

/// A scheme by its letter. I: implicit, E: explicit, S: statics, R: of rigid bodies.
inline std::string scheme_named(char letter, double step) {
  return implicit_scheme(letter == 'I'   ? "newmark"
                         : letter == 'S' ? "quasi_static"
                         : letter == 'R' ? "rigid_motion"
                                         : "central_difference",
                         step);
}

/// A body of cells as a scene file writes it. What is empty is left out.
struct SolidText {
  std::string name = {};
  int dim = 2;
  std::string mesh = {};
  std::string material = {}, integrator = {};        // empty: it has none
  std::vector<double> position = {}, velocity = {};  // first components; empty: not told
  std::string port = "face", side = {};
  std::string model = "fe", keys = {};  // kind; keys beside dimension and mesh, with commas
  std::string field = {};               // of velocity, one expression per dimension, or empty
  std::string start = {};               // other keys of initial
  std::vector<std::string> sides = {};  // with ports of their names
  std::string more = {};                // keys of the body, in lines of their own
  struct Block {
    std::vector<double> lengths = {};
    std::vector<int> cells = {};
    std::string element = {};
  } block = {};  // in place of dim and mesh

  std::string text() const {
    if (!block.lengths.empty()) {
      SolidText meshed = *this;
      meshed.dim = static_cast<int>(block.lengths.size());
      meshed.mesh = block_mesh(block.lengths, block.cells, block.element);
      meshed.block = {};
      return meshed.text();
    }
    std::string out = fmt::format("  {}:\n    model: {{{}: {{dimension: {}, {}mesh: {{{}}}}}}}\n",
                                  name, model, dim, keys, mesh);
    if (!material.empty()) out += fmt::format("    material: {{{}}}\n", material);
    if (!integrator.empty()) out += fmt::format("    integrator: {{{}}}\n", integrator);
    std::vector<std::string> initial, ports;
    if (!position.empty()) initial.push_back("position: " + components(position, dim));
    if (!velocity.empty()) initial.push_back("velocity: " + components(velocity, dim));
    if (!field.empty()) initial.push_back(fmt::format("velocity_field: [{}]", field));
    if (!start.empty()) initial.push_back(start);
    if (!side.empty()) ports.push_back(fmt::format("{}: {{side: {}}}", port, side));
    for (const std::string& each : sides) ports.push_back(fmt::format("{0}: {{side: {0}}}", each));
    if (!initial.empty()) out += fmt::format("    initial: {{{}}}\n", fmt::join(initial, ", "));
    if (!ports.empty()) out += fmt::format("    ports: {{{}}}\n", fmt::join(ports, ", "));
    return out + more;
  }
};

inline std::unique_ptr<Subdomain> build(const SolidText& solid) {
  return build(solid.name, solid.text());
}

/// A block in the plane, or in space by the third of its numbers.
inline SolidText::Block block_in(int dim, std::vector<double> lengths, std::vector<int> cells,
                                 const std::string& element = "") {
  lengths.resize(index(dim));
  cells.resize(index(dim));
  return {lengths, cells, element};
}

/// A rigid tool, with one port on this side of it.
inline SolidText tool(const std::string& name, const SolidText::Block& block,
                      const std::vector<double>& position, const std::string& side,
                      const std::string& keys = "") {
  return {.name = name,
          .position = position,
          .side = side,
          .model = "rigid_tool",
          .keys = keys,
          .block = block};
}

inline std::string texts_of(const std::vector<SolidText>& bodies) {
  std::string all;
  for (const SolidText& body : bodies) all += body.text();
  return all;
}

}  // namespace abut
