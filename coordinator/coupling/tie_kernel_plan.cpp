#include "coordinator/coupling/tie_kernel_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace abut {

namespace {

/// Of the way of waves.
constexpr double usual_cones = 1.5;
/// Trials that find the widest band that fits.
constexpr int halvings = 5;
/// [B] Kernels of all rows on all others that are larger take longer to probe and to answer than
/// bands as far as waves come, which leave nothing out.
constexpr double largest_dense = 512.0 * 1048576.0;
constexpr double value_bytes = 8.0, entry_bytes = 12.0;

TieKernelPlan dense(const TieLayout& layout) {
  double each = value_bytes * static_cast<double>(layout.size) * static_cast<double>(layout.size);
  TieKernelPlan plan;
  for (const TieLayout::Part& part : layout.parts) {
    const double width = static_cast<double>(part.width);
    each += value_bytes * part.steps * width * width;
    if (!part.stands) plan.probes += static_cast<int>(part.width);
  }
  plan.lags = layout.blocks;
  plan.bytes = each * (layout.blocks + 1);  // and the factors
  return plan;
}

/// Pairs of rows of two ends of a body, by the step from which one answers the other.
using Pairs = std::map<std::pair<std::size_t, std::size_t>, std::vector<double>>;

Pairs count_pairs(const TieLayout& layout, const TieLayout::Part& part, const TieBand& band,
                  int steps) {
  Pairs pairs;
  std::vector<std::size_t> end_of;
  for (std::size_t e = 0; e < part.ends.size(); ++e)
    end_of.insert(end_of.end(), index(layout.rows(part.ends[e]).count()), e);
  for (std::size_t row = 0; row < end_of.size(); ++row) {
    for (const TieBand::Reached& r : band.of(row)) {
      std::vector<double>& count = pairs[{end_of[r.row], end_of[row]}];
      count.resize(index(steps), 0.0);
      count[r.from] += 1.0;
    }
  }
  return pairs;
}

/// Entries of a part in a block.
double entries_of(const TieLayout& layout, const TieLayout::Part& part, const Pairs& pairs, int lag,
                  int steps) {
  double entries = 0.0;
  for (const auto& [ends, count] : pairs) {
    std::map<std::pair<int, int>, int> latest;
    for (const TieLayout::Share& share :
         layout.shares(part, part.ends[ends.first], part.ends[ends.second], lag, steps)) {
      int& later = latest[{share.of, share.by}];
      later = std::max(later, share.later);
    }
    for (const auto& [place, later] : latest)
      for (int from = 0; from <= later; ++from) entries += count[from];
  }
  return entries;
}

void add_cost(const TieLayout& layout, const TieBandWidth& width, int lags, const Bodies& bodies,
              TieKernelPlan& plan) {
  const int dim = layout.members.front().tie->rows().dim;
  for (const TieLayout::Part& part : layout.parts) {
    if (part.stands) continue;
    const int steps = part.steps * lags;
    const TieBand band = make_tie_band(layout, part, width, steps, bodies);
    for (const int colours : band.colours) plan.probes += dim * colours;
    double values = 0.0, entries = 0.0;
    for (const TieBand::Reached& r : band.reached) values += steps - r.from;
    const Pairs pairs = count_pairs(layout, part, band, steps);
    for (int lag = 0; lag < lags; ++lag) entries += entries_of(layout, part, pairs, lag, steps);
    plan.bytes += dim * dim * (value_bytes * values + entry_bytes * entries);
  }
}

TieKernelPlan banded(const TieLayout& layout, const TieBandWidth& width, int lags,
                     const Bodies& bodies) {
  const bool narrow = width.rows || width.cones < usual_cones || lags < layout.blocks;
  TieKernelPlan plan{true, width, lags, 0.0, 0, narrow};
  add_cost(layout, width, lags, bodies, plan);
  return plan;
}

}  // namespace

TieKernelPlan plan_tie_kernel(const TieLayout& layout, const TieKernelOptions& options,
                              const Bodies& bodies) {
  if (!options.used) return banded(layout, {std::nullopt, 0.0}, 1, bodies);
  TieKernelPlan plan = dense(layout);
  const auto at_once = [&bodies](const TieLayout::Part& part) {
    return bodies.describe(part.body).quasi_static;
  };
  if (std::ranges::any_of(layout.parts, at_once)) return plan;
  const double most = std::min(options.memory, largest_dense);
  if (plan.bytes <= most && !options.banded) return plan;
  plan = banded(layout, {options.rows, usual_cones}, layout.blocks, bodies);
  if (plan.bytes <= options.memory) return plan;
  if (!options.rows) {
    plan = banded(layout, {std::nullopt, 0.0}, layout.blocks, bodies);
    double fits = 0.0, too_wide = usual_cones;
    for (int k = 0; k < halvings && plan.bytes <= options.memory; ++k) {
      const double between = 0.5 * (fits + too_wide);
      const TieKernelPlan trial = banded(layout, {std::nullopt, between}, layout.blocks, bodies);
      (trial.bytes <= options.memory ? fits : too_wide) = between;
      if (fits == between) plan = trial;
    }
  }
  while (plan.bytes > options.memory && plan.lags > 1)
    plan = banded(layout, plan.width, (plan.lags + 1) / 2, bodies);
  return plan;
}

}  // namespace abut
