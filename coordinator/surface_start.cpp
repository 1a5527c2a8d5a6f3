#include "coordinator/surface_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"
#include "base/index.hpp"
#include "surface/check.hpp"
#include "surface/crossings.hpp"
#include "surface/divided_surface.hpp"
#include "surface/inside.hpp"
#include "surface/overlap_places.hpp"
#include "surface/start_rows.hpp"

namespace abut {

namespace {

/// Of a facet's size: overlaps below it are roundings of the places.
constexpr double tolerance = 1.0e-6;

StartSurface start(const PortGeometry& surface) { return {posed(surface), surface.spacing}; }

PosedSurface outside(const NamedSurface& side) {
  return posed(side.outside != nullptr ? *side.outside : side.geometry);
}

void check_facets(const NamedSurface& surface, const std::string& where) {
  const std::optional<UnsoundSurface> unsound = check(posed(surface.geometry));
  if (!unsound) return;
  throw InputError(fmt::format("{}: {}", surface.name, words(*unsound)), where,
                   "Mend the mesh there, or name another side.");
}

/// Facets of one port that cross each other: nothing parts them.
void check_itself(const NamedSurface& named, const std::string& where) {
  const PosedSurface surface = posed(named.geometry);
  BoxTree tree;
  build(tree, surface, 0.0);
  std::vector<FacetPair> pairs;
  const Crossings found = crossings(surface, tree, pairs);
  if (found.count == 0) return;
  const Eigen::Vector3d at = centre(corners(surface, found.first.k));
  throw InputError(
      fmt::format("{} crosses itself: facets {} and {} of it pass through each other near "
                  "({:.6g}) m, and nothing would part them",
                  named.name, found.first.k, found.first.n,
                  fmt::join(at.data(), at.data() + surface.dim, ", ")),
      where, "Mend the mesh there, or name another side.");
}

/// The row that overlaps most, and by more than what is allowed [m]; -1: none does.
int deepest(const SurfaceRows& rows, double allowed) {
  const auto least = std::ranges::min_element(rows.gaps);
  if (least == rows.gaps.end() || *least >= -allowed) return -1;
  return static_cast<int>(least - rows.gaps.begin());
}

std::string words(const OverlapPlace& place, const std::array<const NamedSurface*, 2>& sides) {
  const NamedSurface& one = *sides[index(place.surface)];
  const std::span<const double> at(place.place.data(), index(one.geometry.dim));
  using What = OverlapPlace::What;
  return fmt::format("{} of {} at ({:.6g}) m {} {}",
                     place.what == What::node    ? "a node"
                     : place.what == What::facet ? "the middle of a facet"
                                                 : "an edge",
                     one.name, fmt::join(at, ", "),
                     place.what == What::edge ? "passes through" : "lies behind",
                     sides[index(1 - place.surface)]->name);
}

/// Places that two sides share, deeper than is allowed of nodes of either [m].
std::vector<OverlapPlace> shared_places(const NamedSurface& one, const NamedSurface& other,
                                        const std::array<double, 2>& allowed) {
  constexpr double reach = 2.0;  // facet sizes: behind an open surface
  const StartSurface k = start(one.geometry), n = start(other.geometry);
  const double size = facet_size(k, n), rounding = tolerance * size;
  std::vector<OverlapPlace> places = overlap_places(
      outside(one), outside(other), {{allowed[0] + rounding, allowed[1] + rounding}, reach * size});
  const std::array sides{&one, &other};
  std::erase_if(places, [&sides](const OverlapPlace& place) {
    const NamedSurface& body = *sides[index(1 - place.surface)];
    return place.what != OverlapPlace::What::edge &&
           std::ranges::any_of(body.beside, [&](const PortGeometry* beside) {
             return is_before(posed(*beside), place.place, place.depth);
           });
  });
  return places;
}

/// Of contact between everything nodes are not moved.
std::string adjusting(const std::string& where) {
  return where.starts_with("interfaces.")
             ? ", or give one of them initial: {adjust: true}"
             : ", or write the pair under interfaces and give one of them initial: {adjust: true}";
}

/// What parts bodies that overlap so deep [m].
std::string remedy(double depth, const NamedSurface& one, const NamedSurface& other,
                   const std::string& where) {
  std::string text = "Move a body with initial.position until they are apart";
  if (depth <= facet_size(start(one.geometry), start(other.geometry))) text += adjusting(where);
  if (depth <= deepest_fit(one, other))
    text += ", or, where a fit is meant, initial: {interference: {over: TIME}}";
  for (const NamedSurface* side : {&one, &other})
    if (side->unturned && !is_closed(outside(*side)))
      text += fmt::format(
          ", or, where {} is a surface alone, turn its facets round: it looks {}", side->name,
          side->geometry.dim == 2 ? "to the right of its lines"
                                  : "to where the nodes of its facets go round anticlockwise");
  return text + ".";
}

/// Refuses bodies that are in each other by more than is allowed of nodes of either [m].
void check_overlap(const NamedSurface& one, const NamedSurface& other,
                   const std::array<double, 2>& allowed, const std::string& where) {
  constexpr double apart = 4.0;  // facet sizes, of places
  constexpr int most_told = 5;
  const std::vector<OverlapPlace> all = shared_places(one, other, allowed);
  if (all.empty()) return;
  const double size = facet_size(start(one.geometry), start(other.geometry));
  const std::array sides{&one, &other};
  const std::vector<OverlapPlace> told = parted_places(all, apart * size, most_told);
  std::string text = fmt::format("its sides overlap by {:.3g} m at the start: {}",
                                 told.front().depth, words(told.front(), sides));
  for (std::size_t i = 1; i < told.size(); ++i)
    text += fmt::format(", and {} by {:.3g} m", words(told[i], sides), told[i].depth);
  throw InputError(text, where, remedy(told.front().depth, one, other, where));
}

/// Rows will be of the nodes of the surface that has edges, divided as finely as the finder's
/// (METHOD.md, [M.93]).
void check_division(const NamedSurface& finder, const NamedSurface& edged,
                    const std::string& where) {
  constexpr double most_facets = 2.0e5;
  const PosedSurface surface = posed(edged.geometry);
  const double parts = parts_for(surface, finder.geometry.spacing);
  const double facets = surface.facet_count() * std::pow(parts, surface.dim - 1);
  if (facets <= most_facets) return;
  throw InputError(
      fmt::format("{} has sharp edges and is to be divided as finely as {}, {:.3g} m, which makes "
                  "{:.3g} facets of it",
                  edged.name, finder.name, finder.geometry.spacing, facets),
      where,
      fmt::format("Name a side of {} without edges, or make the body no larger than what it "
                  "touches.",
                  edged.name));
}

/// Facets of polygons that stand for round bodies overlap on the average of a node's surroundings
/// before any node does: contact would begin with a blow.
void check_averages(const NamedSurface& one, const NamedSurface& other, const std::string& where) {
  const StartSurface k = start(one.geometry), n = start(other.geometry);
  const SurfaceRows rows = average_rows(k, n);
  const int row = deepest(rows, tolerance * facet_size(k, n));
  if (row < 0) return;
  const double overlap = -rows.gaps[row];
  throw InputError(fmt::format("its sides are too near at the start: over the width of a facet {} "
                               "overlaps {} by {:.3g} m",
                               one.name, other.name, overlap),
                   where,
                   fmt::format("Move a body with initial.position by {:.3g} m more, make the mesh "
                               "finer{}.",
                               overlap, adjusting(where)));
}

/// What makes one of two sides useless, whatever the other is.
void check_each(const NamedSurface& one, const NamedSurface& other, const std::string& where) {
  for (const NamedSurface* side : {&one, &other}) check_facets(*side, where);
  for (const NamedSurface* side : {&one, &other}) check_itself(*side, where);
}

}  // namespace

NamedSurface named_surface(const std::string& name, const Description& body, int port) {
  NamedSurface named{name, body.ports[index(port)].geometry};
  named.unturned = !std::isfinite(body.mass) && body.fields.empty();
  for (const Port& other : body.ports)
    if (&other.geometry != &named.geometry && other.geometry.dim == named.geometry.dim)
      named.beside.push_back(&other.geometry);
  return named;
}

double overlap_of(const NamedSurface& finder, const NamedSurface& other) {
  const StartSurface k = start(finder.geometry), n = start(other.geometry);
  const double round = roundness(k, n);
  const std::vector<OverlapPlace> places = shared_places(finder, other, {round, round});
  const double depth = places.empty() ? 0.0 : places.front().depth;
  const SurfaceRows rows = rows_of_other(k, n) ? average_rows(n, k) : average_rows(k, n);
  const int row = deepest(rows, tolerance * facet_size(k, n));
  return row < 0 ? depth : std::max(depth, -rows.gaps[row]);
}

double deepest_fit(const NamedSurface& one, const NamedSurface& other) {
  return 0.5 * std::min(one.geometry.spacing, other.geometry.spacing);
}

void check_surfaces(const NamedSurface& finder, const NamedSurface& other, bool averages,
                    bool meant, const std::string& where) {
  check_each(finder, other, where);
  check_apart(finder, other, meant, where);
  const bool turned = rows_of_other(start(finder.geometry), start(other.geometry));
  if (turned) check_division(finder, other, where);
  if (averages) check_averages(turned ? other : finder, turned ? finder : other, where);
}

void check_apart(const NamedSurface& one, const NamedSurface& other, bool meant,
                 const std::string& where) {
  const double round = roundness(start(one.geometry), start(other.geometry));
  const double allowed = meant ? std::max(round, deepest_fit(one, other)) : round;
  check_overlap(one, other, {allowed, allowed}, where);
}

void check_points(const NamedSurface& finder, const NamedSurface& other, bool meant,
                  const std::string& where) {
  check_each(finder, other, where + ".sides");
  if (has_edges(posed(other.geometry)))
    throw InputError(fmt::format("is point_to_surface, but {} has sharp edges, which would pass "
                                 "between the nodes of {}",
                                 other.name, finder.name),
                     where + ".contact.rows",
                     fmt::format("Leave rows out, or give transmission: {{unilateral: {{kinematic: "
                                 "{}}}}}.",
                                 other.name));
  if (meant) return check_apart(finder, other, true, where + ".sides");
  const double round = roundness(start(finder.geometry), start(other.geometry));
  check_overlap(finder, other, {0.0, round}, where + ".sides");
}

}  // namespace abut
