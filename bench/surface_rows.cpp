/// Cost of joining two surfaces: boxes renewed, pairs found, mortar rows made. K has 3 cells where
/// N has 2, both flat or both waving; nothing matches. Processor time of one thread, medians.
///
///   abut_bench_surface_rows [REPEATS]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <numeric>
#include <vector>

#include "surface/mortar.hpp"
#include "surface/point_rows.hpp"
#include "base/index.hpp"
#include "tests/support/surfaces.hpp"

namespace abut {
namespace {

/// The median of `repeats` samples, each long enough for the clock [s].
double median(int repeats, const std::function<void()>& work) {
  std::vector<double> samples;
  for (int r = 0; r < repeats; ++r) {
    int count = 0;
    const std::clock_t began = std::clock();
    do {
      work();
      ++count;
    } while (std::clock() - began < CLOCKS_PER_SEC / 100);
    samples.push_back(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC / count);
  }
  std::nth_element(samples.begin(), samples.begin() + repeats / 2, samples.end());
  return samples[repeats / 2];
}

struct Kind {
  const char* words;
  double wave;        // height of the waves over the unit square
  double distortion;  // of cells in the plane, in cells
  bool triangles;
  PieceQuadrature quadrature;
};

SurfaceMesh surface(const Kind& kind, int cells, bool of_k) {
  const double bend = kind.distortion / (6.283185307179586 * 2.0);
  const auto place = [&kind, bend](double u, double v) {
    const double x = u + bend * std::sin(6.283185307179586 * (u + v));
    const double y = v + bend * std::sin(6.283185307179586 * (u - v));
    return Eigen::Vector3d(x, y, kind.wave * std::sin(4.0 * x) * std::cos(5.0 * y));
  };
  return grid(cells, cells, place, kind.triangles, of_k);
}

void run(const Kind& kind, int cells, int repeats) {
  const SurfaceMesh k = surface(kind, 3 * cells / 2, true), n = surface(kind, cells, false);
  const double reach = 0.2 / cells;  // a fifth of a facet of N
  const MortarOptions options{.reach = reach, .quadrature = kind.quadrature};
  Join join(k, n, options, reach);
  const double facets = k.pose().facet_count();
  const double refitting = median(repeats, [&] { refit(join.k_tree, k.pose(), reach); });
  const double search =
      median(repeats, [&] { overlapping_pairs(join.k_tree, join.n_tree, join.pairs); });
  const double rows = median(repeats, [&] {
    mortar_rows(k.pose(), n.pose(), join.pairs, options, join.buffers, join.rows);
  });
  const double clipped = static_cast<double>(join.buffers.pieces.pieces.size());
  std::vector<std::int32_t> nodes(index(k.nodes()));
  std::iota(nodes.begin(), nodes.end(), 0);
  PointRowBuffers buffers;
  SurfaceRows points;
  const double closest = median(repeats, [&] {
    point_rows(k.pose(), nodes, n.pose(), join.n_tree, {.reach = reach}, buffers, points);
  });
  fmt::print("{:<24} {:>7} {:>7.2f} {:>7.1f} {:>8.1f} {:>8.3f} {:>9.2f} {:>9.2f}\n", kind.words,
             facets, clipped / facets, refitting * 1e9 / facets,
             search * 1e9 / static_cast<double>(join.pairs.size()), (search + rows) * 1e6 / clipped,
             (search + rows) * 1e6 / facets, closest * 1e6 / k.nodes());
}

void run_all(int repeats) {
  fmt::print("{:<24} {:>7} {:>7} {:>7} {:>8} {:>8} {:>9} {:>9}\n", "", "K", "clipped", "refit",
             "search", "rows", "rows", "points");
  fmt::print("{:<24} {:>7} {:>7} {:>7} {:>8} {:>8} {:>9} {:>9}\n", "", "facets", "each", "ns/K",
             "ns/pair", "us/clip", "us/K", "us/node");
  using enum PieceQuadrature;
  for (const Kind& kind : {Kind{"squares", 0.0, 0.0, false, seven_points},
                           Kind{"waving quadrilaterals", 0.1, 0.4, false, seven_points},
                           Kind{"the same, 4 x 7 points", 0.1, 0.4, false, four_times_seven},
                           Kind{"waving triangles", 0.1, 0.4, true, seven_points}}) {
    for (const int cells : {10, 20, 40, 80, 214}) run(kind, cells, repeats);
  }
}

}  // namespace
}  // namespace abut

int main(int argc, char** argv) {
  abut::run_all(argc > 1 ? std::max(1, std::atoi(argv[1])) : 9);
  return 0;
}
