#include "coordinator/coupling/banded_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/point_rings.hpp"
#include "coordinator/coupling/kernel_bytes.hpp"
#include "coordinator/coupling/kernel_support.hpp"

namespace abut {

namespace {

/// Of the largest response: what is smaller than this is left to the sweeps.
constexpr double tail = 1.0e-3;
/// Facets around a point that is pressed.
constexpr int most_rings = 12;
/// Bands by which a kernel is no less than so many times as small leave nothing to gain.
constexpr double much_smaller = 4.0;
/// [B] of the answers to a request.
constexpr double answer_bytes = 3.2e7;

class BandedProbe {
 public:
  BandedProbe(const KernelWish& wish, Bodies& bodies)
      : wish_(wish),
        bodies_(bodies),
        surface_(bodies.port({wish.body, wish.port}).geometry),
        dim_(index(surface_.dim)),
        rings_(surface_.count(), surface_.facets, surface_.offsets, wish.points) {}

  /// Rings beyond which a point in the middle of the list answers no more; most_rings + 1: none.
  int reach() {
    const std::int32_t middle = rings_.count() / 2;
    std::vector<double> force(surface_.points.size(), 0.0);
    for (std::size_t d = 0; d < dim_; ++d) force[value(middle, d)] = 1.0;
    const PortKernel answer = bodies_.probe(wish_.body, wish_.port, force, wish_.count, {});
    std::vector<double> largest(index(rings_.count()), 0.0);  // by point
    for (const std::vector<double>* moved : {&answer.displacement, &answer.begin})
      for (std::size_t first = 0; first < moved->size(); first += index(answer.width))
        for (std::int32_t p = 0; p < rings_.count(); ++p)
          for (std::size_t d = 0; d < dim_; ++d)
            largest[index(p)] =
                std::max(largest[index(p)], std::abs((*moved)[first + value(p, d)]));
    const double least = tail * *std::ranges::max_element(largest);
    for (int rings = 0; rings <= most_rings; ++rings) {
      for (const std::int32_t p : rings_.around(middle, rings)) largest[index(p)] = 0.0;
      if (*std::ranges::max_element(largest) <= least) return std::max(rings, fewest_rings);
    }
    return most_rings + 1;
  }

  /// [B] of the kernel.
  double bytes(int rings) {
    double entries = 0.0;
    for (std::int32_t p = 0; p < rings_.count(); ++p)
      entries += static_cast<double>(rings_.around(p, rings).size());
    return entries * 2.0 * sizeof(double) * static_cast<double>(dim_ * dim_) * wish_.count;
  }

  PortKernel probe(int rings) {
    PortKernel kernel = room(rings);
    const std::vector<int> colours = rings_.colours(rings);
    std::vector<std::vector<std::int32_t>> pressed;
    for (std::int32_t p = 0; p < rings_.count(); ++p) {
      const std::size_t colour = index(colours[index(p)]);
      if (colour >= pressed.size()) pressed.resize(colour + 1);
      pressed[colour].push_back(p);
    }
    const std::size_t width = surface_.points.size(), all = pressed.size() * dim_;
    const double each = 2.0 * sizeof(double) * wish_.count * static_cast<double>(width);
    const std::size_t at_once =
        std::clamp<std::size_t>(static_cast<std::size_t>(answer_bytes / each), 1, all);
    std::vector<double> forces;
    for (std::size_t first = 0; first < all; first += at_once) {
      const std::size_t some = std::min(at_once, all - first);
      forces.assign(some * width, 0.0);
      for (std::size_t k = 0; k < some; ++k)
        for (const std::int32_t p : pressed[(first + k) / dim_])
          forces[k * width + value(p, (first + k) % dim_)] = 1.0;
      const PortKernel answer = bodies_.probe(wish_.body, wish_.port, forces, wish_.count, {});
      kernel.support = answer.support;
      kernel.step = answer.step;
      for (std::size_t k = 0; k < some; ++k)
        for (const std::int32_t p : pressed[(first + k) / dim_])
          for (const auto array :
               {&PortKernel::compliance, &PortKernel::displacement, &PortKernel::begin})
            take(answer.*array, k, some, p, (first + k) % dim_, kernel, kernel.*array);
    }
    return for_levels(std::move(kernel));
  }

 private:
  std::size_t value(std::int32_t point, std::size_t d) const {
    const std::int32_t p = wish_.points.empty() ? point : wish_.points[index(point)];
    return index(p) * dim_ + d;
  }

  PortKernel room(int rings) {
    PortKernel kernel;
    kernel.points = wish_.points;
    kernel.patterns = kernel.width = rings_.count() * static_cast<int>(dim_);
    kernel.band.dim = static_cast<int>(dim_);
    kernel.band.offsets.assign(1, 0);
    for (std::int32_t p = 0; p < rings_.count(); ++p) {
      const std::span<const std::int32_t> reached = rings_.around(p, rings);
      kernel.band.reached.insert(kernel.band.reached.end(), reached.begin(), reached.end());
      kernel.band.offsets.push_back(static_cast<std::int32_t>(kernel.band.reached.size()));
    }
    return kernel;
  }

  /// From answers (rows, patterns, width) to one pattern, what one of the points pressed has moved.
  void take(const std::vector<double>& answers, std::size_t pattern, std::size_t patterns,
            std::int32_t point, std::size_t component, const PortKernel& kernel,
            std::vector<double>& to) const {
    const std::size_t width = surface_.points.size(), rows = answers.size() / (patterns * width);
    if (to.size() != rows * kernel.per_step()) to.assign(rows * kernel.per_step(), 0.0);
    const std::size_t first = index(kernel.band.offsets[index(point)]);
    const std::span<const std::int32_t> reached = kernel.band.of(index(point));
    for (std::size_t row = 0; row < rows; ++row) {
      const double* moved = answers.data() + (row * patterns + pattern) * width;
      double* at = to.data() + row * kernel.per_step() + first * dim_ * dim_ + component * dim_;
      for (std::size_t e = 0; e < reached.size(); ++e)
        for (std::size_t d = 0; d < dim_; ++d)
          at[e * dim_ * dim_ + d] = moved[value(reached[e], d)];
    }
  }

  const KernelWish& wish_;
  Bodies& bodies_;
  const PortGeometry& surface_;
  std::size_t dim_;
  PointRings rings_;
};

}  // namespace

PortKernel banded_kernel(const KernelWish& wish, double largest, double full, Bodies& bodies) {
  BandedProbe probe(wish, bodies);
  if (probe.bytes(fewest_rings) > largest) return {};
  int rings = probe.reach();
  if (rings > most_rings) return {};
  if (full <= largest && much_smaller * probe.bytes(rings) > full) return {};
  while (rings > fewest_rings && probe.bytes(rings) > largest) --rings;
  return probe.probe(rings);
}

}  // namespace abut
