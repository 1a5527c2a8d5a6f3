#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/index.hpp"
#include "tests/support/runs.hpp"

namespace abut {

/// A strip or bar of unit modulus, density and height, of two bodies that overlap in the middle.
struct OverlappingPair {
  int dim = 2;
  double overlap = 1.0;
  std::vector<int> across = {4, 4};  // cells over the height
  std::string schemes = "II";        // I: newmark, E: central differences, S: statics
  double step = 0.02, ratio = 1.0;   // steps of the right body are smaller by the ratio
  double poissons_ratio = 0.25;
  // Linear: unlike meshes agree on it, and nothing is lost to make velocities one.
  std::string start = "velocity_field: [\"x - 2*y\", \"0.5*x + y\"]";
  std::vector<std::string> cells = {"", ""};
  std::vector<std::string> more = {"", ""};  // keys of the bodies
  std::string tied = "overlap: {}", law = "linear_elastic", schwarz = "",
              seam = "";  // of the interface
  double shift = 0.0;     // of the overlap, from the middle
  double length = 6.0;

  std::string body(std::size_t k) const {
    const double middle = 0.5 * length + shift, half = 0.5 * overlap;
    const double low = k == 0 ? 0.0 : middle - half, high = k == 0 ? middle + half : length;
    std::vector<double> lengths = {high - low, 1.0, 1.0};
    const int n = across[k], along = static_cast<int>(std::lround(n * (high - low)));
    std::vector<int> count = {along, n, n};
    lengths.resize(index(dim));
    count.resize(index(dim));
    return SolidText{.name = k == 0 ? "left" : "right",
                     .material = unit_law(law, poissons_ratio),
                     .integrator = scheme_named(schemes[k], k == 0 ? step : step / ratio),
                     .position = {low},
                     .port = "cut",
                     .side = k == 0 ? "right" : "left",
                     .start = start,
                     .more = more[k],
                     .block = {lengths, count, cells[k]}}
        .text();
  }
  ResultPtr run(double end, double window) const {
    return run_scene(end, window, body(0) + body(1),
                     fmt::format("interfaces:\n  seam: {{sides: [left.cut, right.cut], tied: "
                                 "{{{}}}{}}}\nschwarz: {{{}}}\n",
                                 tied, seam, schwarz));
  }
  /// The undivided body, of the left one's cells and keys and the right one's more.
  ResultPtr run_whole(double end, double window) const {
    OverlappingPair one = *this;
    one.overlap = length;
    one.shift = 0.0;
    one.more[0] += one.more[1];
    return run_scene(end, window, one.body(0));
  }
};

}  // namespace abut
