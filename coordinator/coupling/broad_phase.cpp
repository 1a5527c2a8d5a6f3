#include "coordinator/coupling/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "base/one_each.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/parts_of_ports.hpp"
#include "coordinator/coupling/row_margin.hpp"
#include "coordinator/coupling/tied_wholes.hpp"
#include "surface/inside.hpp"

namespace abut {

namespace {

/// Places of bodies in the order of sweeps: their numbers with the bits reversed. Neighbours in a
/// row, a stack or a lattice alternate, so that few levels follow each other in a sweep.
std::vector<int> ranks(int bodies) {
  const auto reversed = [](int number) {
    std::uint32_t in = static_cast<std::uint32_t>(number), out = 0;
    for (int bit = 0; bit < 32; ++bit, in >>= 1) out = (out << 1) | (in & 1u);
    return out;
  };
  std::vector<int> order(index(bodies)), rank(index(bodies));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, reversed);
  for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = static_cast<int>(k);
  return rank;
}

constexpr Box no_box = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};

/// A box around those between `lower` and `upper`, (parts, dim), larger by `more` [m].
Box box_of(std::span<const double> lower, std::span<const double> upper, std::size_t dim,
           double more) {
  Box box = no_box;
  for (std::size_t i = 0; i < dim; ++i) {
    box.low[i] = std::numeric_limits<double>::infinity();
    box.high[i] = -box.low[i];
    for (std::size_t k = i; k < lower.size(); k += dim) {
      box.low[i] = std::min(box.low[i], lower[k] - more);
      box.high[i] = std::max(box.high[i], upper[k] + more);
    }
  }
  return box;
}

/// The axis along which the boxes' centres are spread most, and the order along it.
std::vector<int> sorted_along(const std::vector<Box>& boxes, std::size_t& axis) {
  double widest = -1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Box& box : boxes) {
      const double centre = 0.5 * (box.low[i] + box.high[i]);
      if (!std::isfinite(centre)) continue;
      low = std::min(low, centre);
      high = std::max(high, centre);
    }
    if (high - low > widest) {
      widest = high - low;
      axis = i;
    }
  }
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&boxes, axis](int k) { return boxes[k].low[axis]; });
  return order;
}

}  // namespace

/// Surfaces that are tied are none any more: they touch nothing. Parts of other ports do not, too.
BroadPhase::BroadPhase(const Bodies& bodies, std::span<const Joint> joined) {
  const auto tied = [joined](int body, std::size_t port) {
    return std::ranges::any_of(joined, [body, port](const Joint& joint) {
      return joint.tied() && std::ranges::any_of(joint.sides, [body, port](const Side& side) {
               return side.body == body && index(side.port) == port;
             });
    });
  };
  const std::vector<int> rank = ranks(bodies.count()), whole = tied_wholes(joined, bodies.count());
  std::vector<Side> sides;
  place_.resize(index(bodies.count()));
  for (int b = 0; b < bodies.count(); ++b) {
    const Description& body = bodies.describe(b);
    const std::vector<bool> parts = parts_of_others(body);
    for (std::size_t p = 0; p < body.ports.size(); ++p) {
      const PortGeometry& surface = body.ports[p].geometry;
      const bool touches = surface.dim > 1 && !surface.facets.empty() && !tied(b, p) && !parts[p];
      place_[b].push_back(touches ? static_cast<int>(ports_.size()) : -1);
      if (!touches) continue;
      ports_.push_back({{b, static_cast<int>(p)},
                        std::isinf(body.mass),
                        rank[b],
                        whole[b],
                        is_closed(posed(surface)) ? 0.0 : surface.spacing});
      sides.push_back(ports_.back().side);
    }
  }
  margin_ = row_margin_of_all(sides, bodies);
  for (const auto& [joint, contact, part] : known_exchanges(joined).obstacles) join(joint->sides);
}

void BroadPhase::join(const PortPair& pair) {
  const int a = place_[pair[0].body][pair[0].port];
  const int b = place_[pair[1].body][pair[1].port];
  joined_.insert(std::minmax(a, b));
}

std::vector<BroadPhase::Places> BroadPhase::boxes_that_overlap() const {
  std::size_t axis = 0;
  const std::vector<int> order = sorted_along(boxes_, axis);
  std::vector<Places> found;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& box = boxes_[order[i]];
    const Surface& one = ports_[order[i]];
    for (std::size_t k = i + 1; k < order.size(); ++k) {
      const Box& other = boxes_[order[k]];
      if (other.low[axis] > box.high[axis]) break;
      const Surface& two = ports_[order[k]];
      if (one.whole == two.whole || (one.stands && two.stands)) continue;
      if (overlap(box, other)) found.push_back(std::minmax(order[i], order[k]));
    }
  }
  return found;
}

std::vector<PortPair> BroadPhase::overlapping() const {
  std::vector<Places> found = boxes_that_overlap();
  found.insert(found.end(), passed_.begin(), passed_.end());
  keep_one_each(found);
  std::vector<PortPair> pairs;
  for (const auto& [a, b] : found) {
    if (joined_.contains({a, b})) continue;
    const Surface &one = ports_[a], &two = ports_[b];
    pairs.push_back(one.rank < two.rank ? PortPair{one.side, two.side}
                                        : PortPair{two.side, one.side});
  }
  return pairs;
}

std::vector<PortPair> BroadPhase::near_at_start(const Bodies& bodies) {
  constexpr double of_facet = 0.01;  // far less than bodies are thick, whose far sides do not meet
  double finest = std::numeric_limits<double>::infinity();
  for (const Surface& port : ports_)
    if (port.open > 0.0) finest = std::min(finest, port.open);
  const auto make_boxes = [&](double widths) {
    boxes_.clear();
    for (const Surface& port : ports_) {
      const PortGeometry& surface = bodies.port(port.side).geometry;
      const double more = port.open > 0.0 ? widths * finest : 0.0;
      boxes_.push_back(
          box_of(surface.points, surface.points, index(surface.dim), 0.5 * margin_ + more));
    }
  };
  make_boxes(of_facet);
  passed_ = boxes_that_overlap();
  make_boxes(0.0);
  const std::vector<Places> touching = boxes_that_overlap();
  std::erase_if(passed_, [&touching](const Places& pair) {
    return std::ranges::find(touching, pair) != touching.end();
  });
  return overlapping();
}

std::vector<PortPair> BroadPhase::near(const Bodies& bodies, double time) {
  boxes_.clear();
  for (const Surface& port : ports_) {
    const PortResponse& reply = port_of(bodies, port.side);
    const std::size_t dim = index(bodies.port(port.side).geometry.dim);
    const double way = (reply.speed_bound + 0.5 * reply.acceleration_bound * time) * time;
    // A body that failed before its first record tells no box. Its pairs were told from where the
    // attempt began, and nothing has moved from there since.
    const std::size_t told = std::min(dim, reply.lower.size());
    boxes_.push_back(box_of(std::span(reply.lower).last(told), std::span(reply.upper).last(told),
                            dim, 0.5 * margin_ + way));
  }
  return overlapping();
}

std::vector<PortPair> BroadPhase::crossed(const Bodies& bodies) {
  boxes_.clear();
  for (const Surface& port : ports_) {
    const PortResponse& reply = port_of(bodies, port.side);
    const std::size_t dim = index(bodies.port(port.side).geometry.dim);
    boxes_.push_back(box_of(reply.lower, reply.upper, dim, 0.5 * margin_));
  }
  return overlapping();
}

int BroadPhase::free_windows(const Bodies& bodies, double length, int most) {
  while (most > 0 && !empty() && !near(bodies, most * length).empty()) most /= 2;
  return most;
}

}  // namespace abut
