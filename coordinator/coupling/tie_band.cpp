#include "coordinator/coupling/tie_band.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace abut {

namespace {

/// Spacings by which meshes run ahead of waves: of explicit bodies at most one in a step; of
/// implicit ones the answer falls by some 4 from node to node.
constexpr int ahead = 2, implicit_ahead = 3;
/// Of distances: neighbours at exactly so many spacings are among them.
constexpr double rounding = 1.0e-6;

struct BandPlaces {
  std::vector<std::array<double, 3>> rows;  // [m] where they are
  double own = 0.0;                         // [m] from a row to the farthest of its nodes
  double spacing = 0.0;                     // [m] of the sides that have rows, the largest
};

BandPlaces places_of(const TieLayout& layout, const TieLayout::Part& part, const Bodies& bodies) {
  BandPlaces places;
  for (const TieLayout::End& end : part.ends) {
    const TieRows& rows = layout.rows(end);
    const SparseRows& own = rows.of[end.side];
    const PortGeometry& face = bodies.port(layout.side(end)).geometry;
    const std::size_t dim = index(rows.dim);
    std::vector<double> middle(index(rows.width()));
    apply(own, rows.dim, face.points, middle);
    for (int r = 0; r < rows.count(); ++r) {
      std::array<double, 3>& place = places.rows.emplace_back();
      std::copy_n(&middle[index(r) * dim], dim, place.begin());
      for (auto e = own.offsets[r]; e < own.offsets[index(r) + 1]; ++e) {
        double square = 0.0;
        for (std::size_t d = 0; d < dim; ++d)
          square += std::pow(face.points[index(own.columns[e]) * dim + d] - place[d], 2);
        places.own = std::max(places.own, std::sqrt(square));
      }
    }
    for (const Side& side : layout.members[end.member].joint->sides)
      places.spacing = std::max(places.spacing, bodies.port(side).geometry.spacing);
  }
  return places;
}

/// [m] within which rows answer, by step.
std::vector<double> reach_of(const TieLayout& layout, const TieLayout::Part& part,
                             const BandPlaces& places, const TieBandWidth& width, int steps,
                             const Bodies& bodies) {
  if (width.rows) return std::vector<double>(index(steps), *width.rows * places.spacing);
  const Description& body = bodies.describe(part.body);
  const bool implicit = std::isinf(body.stable_step);
  double speed = 0.0, spacing = 0.0;  // [m/s] [m]
  for (const TieLayout::End& end : part.ends) {
    const PortGeometry& face = bodies.port(layout.side(end)).geometry;
    spacing = std::max(spacing, face.spacing);
    if (face.transit > 0.0) speed = std::max(speed, face.spacing / face.transit);
  }
  const double way = speed * (body.step > 0.0 ? body.step : bodies.window());
  std::vector<double> reach;
  for (int later = 0; later < steps; ++later) {
    const int steps_on = implicit ? later + 1 : later;  // a force is felt at once
    const int meshes = implicit ? implicit_ahead : std::min(later, ahead);
    reach.push_back(2.0 * places.own + meshes * spacing + width.cones * way * steps_on);
  }
  return reach;
}

/// Pairs of rows within the reach of the last step, by a sweep along the longest way.
void find_reached(const BandPlaces& places, const std::vector<double>& reach, TieBand& band) {
  const std::vector<std::array<double, 3>>& at = places.rows;
  std::array<double, 3> low = at.front(), high = at.front();
  for (const std::array<double, 3>& place : at) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], place[d]);
      high[d] = std::max(high[d], place[d]);
    }
  }
  std::size_t along = 0;
  for (const std::size_t d : {1u, 2u})
    if (high[d] - low[d] > high[along] - low[along]) along = d;
  std::vector<std::int32_t> order(at.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::int32_t r) { return at[r][along]; });
  const double slack = rounding * places.spacing, most = reach.back() + slack;
  band.offsets.assign(1, 0);
  for (const std::array<double, 3>& place : at) {
    const auto from = std::ranges::lower_bound(order, place[along] - most, {},
                                               [&](std::int32_t r) { return at[r][along]; });
    for (auto r = from; r != order.end() && at[*r][along] <= place[along] + most; ++r) {
      double square = 0.0;
      for (std::size_t d = 0; d < 3; ++d) square += (at[*r][d] - place[d]) * (at[*r][d] - place[d]);
      if (square > most * most) continue;
      const double far = std::sqrt(square) - slack;
      const auto first = std::ranges::lower_bound(reach, far);
      if (first == reach.end()) continue;
      band.reached.push_back({*r, static_cast<std::int32_t>(first - reach.begin())});
    }
    std::ranges::sort(band.reached.begin() + static_cast<std::ptrdiff_t>(band.offsets.back()),
                      band.reached.end(), {}, &TieBand::Reached::row);
    band.offsets.push_back(band.reached.size());
  }
}

/// Sets of colours, 64 in a word.
using Colours = std::vector<std::uint64_t>;

/// The first colour that none of the rows that a row presses answers yet; they do from now on.
int free_colour(const TieBand& band, std::size_t row, std::vector<Colours>& answers) {
  Colours taken(1, 0);
  for (const TieBand::Reached& r : band.of(row)) {
    const Colours& known = answers[r.row];
    if (taken.size() < known.size()) taken.resize(known.size(), 0);
    for (std::size_t w = 0; w < known.size(); ++w) taken[w] |= known[w];
  }
  std::size_t word = 0;
  while (word < taken.size() && taken[word] == ~std::uint64_t{0}) ++word;
  const std::size_t bit = word < taken.size() ? index(std::countr_one(taken[word])) : 0;
  for (const TieBand::Reached& r : band.of(row)) {
    Colours& known = answers[r.row];
    if (known.size() <= word) known.resize(word + 1, 0);
    known[word] |= std::uint64_t{1} << bit;
  }
  return static_cast<int>(64 * word + bit);
}

}  // namespace

TieBand make_tie_band(const TieLayout& layout, const TieLayout::Part& part,
                      const TieBandWidth& width, int steps, const Bodies& bodies) {
  TieBand band;
  const BandPlaces places = places_of(layout, part, bodies);
  find_reached(places, reach_of(layout, part, places, width, steps, bodies), band);
  band.colour.resize(places.rows.size());
  std::size_t row = 0;
  for (const TieLayout::End& end : part.ends) {
    std::vector<Colours> answers(places.rows.size());
    int colours = 0;
    for (int r = 0; r < layout.rows(end).count(); ++r, ++row) {
      band.colour[row] = free_colour(band, row, answers);
      colours = std::max(colours, band.colour[row] + 1);
    }
    band.colours.push_back(colours);
  }
  return band;
}

}  // namespace abut
