// What windows must be, whatever acts on the body.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "base/index.hpp"
#include "contract/field.hpp"
#include "coordinator/conformance/clauses.hpp"

namespace abut {

namespace {

constexpr double rounding = 1.0e-9;
constexpr double places = 1.0e-15;  // roundings of a place, of its size

std::vector<Push> pushes(BodyTrial& trial, double length, double sign) {
  std::vector<Push> all;
  for (int p = 0; p < static_cast<int>(trial.about().ports.size()); ++p)
    if (const double force = trial.light_force(p); force > 0.0)
      all.push_back(trial.push(p, 0, length, sign * force));
  return all;
}

using Place = std::array<double, 3>;

Place operator-(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Cells of a grid by the places of their nodes.
class Cells {
 public:
  explicit Cells(const Grid& grid) : grid_(grid) {
    for (std::size_t c = 0; c < grid.types.size(); ++c)
      for (std::int32_t k = grid.offsets[c]; k < grid.offsets[c + 1]; ++k)
        at_[place(grid.connectivity[index(k)])].insert(c);
  }

  /// The middle of the one cell that has all of these nodes; nothing: there is none.
  std::optional<Place> middle_behind(const std::vector<Place>& facet) const {
    std::set<std::size_t> common;
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const auto found = at_.find(facet[i]);
      if (found == at_.end()) return std::nullopt;
      if (i == 0) common = found->second;
      std::erase_if(common, [&](std::size_t c) { return !found->second.contains(c); });
    }
    if (common.size() != 1) return std::nullopt;
    Place sum{};
    const std::size_t c = *common.begin();
    const std::int32_t begin = grid_.offsets[c], end = grid_.offsets[c + 1];
    for (std::int32_t k = begin; k < end; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        sum[a] += place(grid_.connectivity[index(k)])[a] / (end - begin);
    return sum;
  }

 private:
  Place place(std::int32_t node) const {
    const double* x = grid_.points.data() + 3 * index(node);
    return {x[0], x[1], x[2]};
  }

  const Grid& grid_;
  std::map<Place, std::set<std::size_t>> at_;
};

/// Points of a facet, in their order.
std::vector<Place> places_of(const PortGeometry& surface, std::size_t facet) {
  const std::size_t dim = index(surface.dim);
  std::vector<Place> at;
  for (std::int32_t k = surface.offsets[facet]; k < surface.offsets[facet + 1]; ++k) {
    Place& x = at.emplace_back(Place{});
    for (std::size_t a = 0; a < dim; ++a)
      x[a] = surface.points[index(surface.facets[index(k)]) * dim + a];
  }
  return at;
}

/// Where the order of its points makes a facet look.
Place looks(const std::vector<Place>& at) {
  if (at.size() == 2) return {at[1][1] - at[0][1], at[0][0] - at[1][0], 0.0};
  const bool quad = at.size() == 4;
  const Place one = at[quad ? 2 : 1] - at[0], two = quad ? at[3] - at[1] : at[2] - at[0];
  return {one[1] * two[2] - one[2] * two[1], one[2] * two[0] - one[0] * two[2],
          one[0] * two[1] - one[1] * two[0]};
}

/// VTK's kinds of cells that fill space in so many dimensions.
bool fills(int type, int dim) {
  static const std::set<int> line{3, 4, 21, 35};
  static const std::set<int> flat{5, 7, 8, 9, 22, 23, 28, 34};
  static const std::set<int> solid{10, 11, 12, 13, 14, 24, 25, 26, 27, 29, 32};
  return (dim == 1 ? line : dim == 2 ? flat : solid).contains(type);
}

std::string orientation(BodyTrial& trial) {
  const Description& body = trial.about();
  if (body.fields.empty()) return "the body tells no grid to hold its facets or points against";
  const Grid grid = trial.body().grid();
  if (std::none_of(grid.types.begin(), grid.types.end(),
                   [&](int type) { return fills(type, body.dim); }))
    return "the body's grid has no cells that fill it";
  const Cells cells(grid);
  bool found = false;
  for (const Port& port : body.ports) {
    const PortGeometry& surface = port.geometry;
    const std::size_t count = body.dim == 1 ? index(surface.count())
                                            : std::max<std::size_t>(surface.offsets.size(), 1) - 1;
    for (std::size_t f = 0; f < count; ++f) {
      const std::vector<Place> at =
          body.dim == 1 ? std::vector{Place{surface.points[f], 0.0, 0.0}} : places_of(surface, f);
      const std::optional<Place> middle = cells.middle_behind(at);
      if (!middle) continue;
      found = true;
      const Place out = body.dim == 1 ? Place{surface.normals[f], 0.0, 0.0} : looks(at);
      if (dot(out, *middle - at[0]) < 0.0) continue;
      throw BrokenClause(
          fmt::format("{} {} of port {} looks into the body: the cell of its grid that has it lies "
                      "before it",
                      body.dim == 1 ? "point" : "facet", f, port.name),
          "In one dimension the normal of a point leads out of the body; in the plane the body "
          "lies "
          "to the left of who walks along a facet; in space points turn counterclockwise for who "
          "looks at the body from outside.");
    }
  }
  return found ? "" : "no cell of the body's grid has the points of a port";
}

/// Ends of windows, times and sizes: the reader of replies refuses what is wrong.
std::string ends(BodyTrial& trial) {
  const double nominal = trial.about().step;
  const Response reply = trial.window(trial.length(), {}, 2);
  for (std::size_t p = 0; p < reply.ports.size(); ++p) {
    const std::vector<double>& time = reply.ports[p].trace.time;
    for (std::size_t i = 1; i < time.size(); ++i)
      if (nominal > 0.0 && time[i] - time[i - 1] > nominal * (1.0 + 1.0e-6))
        throw BrokenClause(fmt::format("takes a substep of {} s, where its description says {} s",
                                       time[i] - time[i - 1], nominal),
                           "Substeps divide the window and are at most as long as told.");
  }
  return "";
}

/// One window of two lengths against two windows.
std::string parts(BodyTrial& trial) {
  trial.window(trial.length(), pushes(trial, trial.length(), 1.0));  // set in motion
  trial.window(trial.length());
  trial.save();
  trial.window(trial.length());
  const Response last = trial.window(trial.length());
  const Response whole = trial.again(2.0 * trial.length());
  for (std::size_t p = 0; p < whole.ports.size(); ++p) {
    const Waveform &one = whole.ports[p].trace, &other = last.ports[p].trace;
    const std::size_t width = index(one.width);
    double off = 0.0, way = 0.0, size = 0.0;
    for (std::size_t k = 0; k < width; ++k) {
      const double end = one.u[one.u.size() - width + k];
      off = std::max(off, std::abs(end - other.u[other.u.size() - width + k]));
      way = std::max(way, std::abs(end - one.u[k]));
      size = std::max(size, std::abs(end));
    }
    if (off > 1.0e-6 * way + rounding * size && trial.about().step > 0.0)
      throw BrokenClause(
          fmt::format("port {} ends a window {} m from where two windows of half the "
                      "length end",
                      trial.about().ports[p].name, off),
          "The last substep lands on the window's end; nothing of it is kept.");
  }
  return "";
}

std::string no_length(BodyTrial& trial) {
  const Response before = trial.window(trial.length());
  const std::uint64_t hash = trial.body().state_hash();
  const Response told = trial.window(0.0);
  for (std::size_t p = 0; p < told.ports.size(); ++p) {
    const Waveform &now = told.ports[p].trace, &last = before.ports[p].trace;
    if (now.size() != 1)
      throw BrokenClause(fmt::format("a window of no length has {} times", now.size()),
                         "It has one: the present.");
    for (std::size_t k = 0; k < now.u.size(); ++k)
      if (now.u[k] != last.u[last.u.size() - now.u.size() + k])
        throw BrokenClause(
            fmt::format("a window of no length moves port {}", trial.about().ports[p].name),
            "It advances nothing and tells the state.");
  }
  if (trial.body().state_hash() != hash)
    throw BrokenClause("a window of no length changes the state",
                       "It advances nothing and tells the state.");
  return "";
}

std::string restore(BodyTrial& trial) {
  trial.window(trial.length(), pushes(trial, trial.length(), 1.0));  // something to remember
  trial.save();
  const std::vector<Push> there = pushes(trial, trial.length(), 1.0);
  const Response first = trial.window(trial.length(), there);
  const std::uint64_t hash = trial.body().state_hash();
  trial.again(trial.length(), pushes(trial, trial.length(), -2.0));
  trial.window(trial.length());
  const Response second = trial.again(trial.length(), there);
  const std::string other = first_difference(first, second, trial.about());
  const char* remedy =
      "All that a step changes must be saved, copied, and come back; what a step does must follow "
      "from state and request alone.";
  if (!other.empty())
    throw BrokenClause("the same window from the same state ends otherwise: " + other, remedy);
  if (trial.body().state_hash() != hash)
    throw BrokenClause("replies are the same, but the state's hash is another one", remedy);
  return "";
}

std::string hashes(BodyTrial& trial) {
  if (std::isinf(trial.about().mass)) return "nothing moves the body";
  std::set<std::uint64_t> seen{trial.body().state_hash()};
  const std::vector<Push> all = pushes(trial, trial.length(), 1.0);
  const Response reply = trial.window(trial.length(), all);
  const auto moved = [](const PortResponse& port) {
    return std::any_of(port.trace.u.begin(), port.trace.u.end(),
                       [&](double u) { return u != port.trace.u.front(); });
  };
  if (std::none_of(reply.ports.begin(), reply.ports.end(), moved)) return "nothing moved";
  if (!seen.insert(trial.body().state_hash()).second)
    throw BrokenClause("the state has changed, and its hash has not",
                       "A hash is of all the state.");
  return "";
}

/// [m/s] (dim) of a point over a substep.
std::array<double, 3> rate_of(const Waveform& trace, std::size_t substep, std::size_t point,
                              std::size_t dim) {
  const std::size_t width = index(trace.width), now = substep * width + point * dim;
  std::array<double, 3> rate{};
  for (std::size_t k = 0; k < dim; ++k)
    rate[k] = (trace.u[now + k] - trace.u[now - width + k]) /
              (trace.time[substep] - trace.time[substep - 1]);
  return rate;
}

/// Where velocities are told, they are what flights are held against afterwards, and the bound is
/// no more than a forecast.
void hold_velocities(const PortResponse& reply, const Port& port) {
  const std::size_t dim = index(port.geometry.dim);
  for (std::size_t i = 1; i < reply.trace.size(); ++i)
    for (std::size_t p = 0; p < index(port.geometry.count()); ++p) {
      const std::array<double, 3> rate = rate_of(reply.trace, i, p, dim);
      for (std::size_t k = 0; k < dim; ++k) {
        const double step = reply.trace.time[i] - reply.trace.time[i - 1];
        const double rounded =
            rounding * (std::abs(reply.slowest[k]) + std::abs(reply.fastest[k])) +
            places * std::abs(reply.trace.u[i * index(reply.trace.width) + p * dim + k]) / step;
        if (rate[k] < reply.slowest[k] - rounded || rate[k] > reply.fastest[k] + rounded)
          throw BrokenClause(
              fmt::format("point {} of port {} goes at {} m/s along axis {}, where slowest and "
                          "fastest say {} to {} m/s",
                          p, port.name, rate[k], k, reply.slowest[k], reply.fastest[k]),
              "They are of all points, from substep to substep: way over time.");
      }
    }
}

/// A bound that nobody looks at afterwards; outward of a single point, else in any direction.
void hold_bound(const Waveform& trace, const Port& port, double bound) {
  constexpr double slack = 1.0e-3;  // of velocities at half steps
  const PortGeometry& surface = port.geometry;
  const std::size_t dim = index(surface.dim);
  for (std::size_t i = 1; i < trace.size(); ++i)
    for (std::size_t p = 0; p < index(surface.count()); ++p) {
      const std::array<double, 3> rate = rate_of(trace, i, p, dim);
      const double speed = surface.count() == 1 ? rate[0] * surface.normals[0]
                                                : std::hypot(rate[0], rate[1], rate[2]);
      if (speed > bound + slack * std::abs(bound) + 1.0e-12)
        throw BrokenClause(
            fmt::format("point {} of port {} goes at {} m/s, untouched, where its bound was {} "
                        "m/s",
                        p, port.name, speed, bound),
            "Where slowest and fastest are left out, speed_bound must hold from the window's end "
            "on; infinity where it is not known.");
    }
}

std::string speeds(BodyTrial& trial) {
  constexpr int windows = 25;
  trial.window(trial.length(), pushes(trial, trial.length(), 1.0));
  const Response from = trial.window(trial.length());
  const double begin = trial.now();
  bool told = false;
  for (int w = 0; w < windows; ++w) {
    const Response next = trial.window(trial.length());
    for (std::size_t p = 0; p < next.ports.size(); ++p) {
      const PortResponse &reply = next.ports[p], &bound = from.ports[p];
      const Port& port = trial.about().ports[p];
      const bool unknown = reply.slowest.empty() && std::isinf(bound.speed_bound);
      told = told || !unknown;
      if (!reply.slowest.empty()) {
        hold_velocities(reply, port);
      } else if (!unknown) {
        hold_bound(reply.trace, port,
                   bound.speed_bound + bound.acceleration_bound * (trial.now() - begin));
      }
    }
  }
  return told ? "" : "the body tells no velocities and no bound";
}

std::string boxes(BodyTrial& trial) {
  const Response reply = trial.window(trial.length(), pushes(trial, trial.length(), 1.0));
  for (std::size_t p = 0; p < reply.ports.size(); ++p) {
    const PortResponse& port = reply.ports[p];
    const PortGeometry& surface = trial.about().ports[p].geometry;
    const std::size_t dim = index(surface.dim), width = index(port.trace.width);
    for (std::size_t k = 0; k < port.trace.u.size(); ++k) {
      const double x = surface.points[k % width] + port.trace.u[k];
      const double slack = rounding * (std::abs(x) + port.upper[k % dim] - port.lower[k % dim]);
      if (x < port.lower[k % dim] - slack || x > port.upper[k % dim] + slack)
        throw BrokenClause(
            fmt::format("point {} of port {} is at {} m along axis {} in the window, outside of "
                        "the box that it is said to have swept",
                        k % width / dim, trial.about().ports[p].name, x, k % dim),
            "lower and upper are of positions, at all substeps.");
    }
  }
  return "";
}

constexpr Clause clauses_on_windows[] = {
    {"orientation", "facets, and points of lines, look outward", orientation},
    {"ends", "a window ends on its end, in substeps that the description tells", ends},
    {"parts", "two windows are one of twice the length", parts},
    {"no length", "a window of no length advances nothing and tells the state", no_length},
    {"restore", "a state is returned to exactly; a reply is of state and request", restore},
    {"hash", "other states have other hashes", hashes},
    {"boxes", "boxes hold what the points of ports have swept", boxes},
};

constexpr Clause clauses_on_speeds[] = {
    {"speed", "velocities, or a bound of them, hold while nothing touches the body", speeds},
};

}  // namespace

std::span<const Clause> clauses_of_speeds() { return clauses_on_speeds; }
std::span<const Clause> clauses_of_windows() { return clauses_on_windows; }

}  // namespace abut
