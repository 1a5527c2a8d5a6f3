#include "coordinator/coupling/tie_probes.hpp"

#include <algorithm>
#include <vector>

#include "base/one_each.hpp"
#include "coordinator/coupling/kernel_support.hpp"

namespace abut {

namespace {

/// [B] of the answers to a probe, about.
constexpr double reply_bytes = 3.2e7;

/// The ports of a body that are joined, each once.
std::vector<int> joined_ports(const TieLayout& layout, const TieLayout::Part& part) {
  std::vector<int> ports;
  for (const TieLayout::End& end : part.ends) ports.push_back(layout.side(end).port);
  keep_one_each(ports);
  return ports;
}

std::size_t width_of(const Bodies& bodies, int body, int port) {
  return bodies.port({body, port}).geometry.points.size();
}

const SparseRows& rows_read(const TieLayout& layout, const TieLayout::End& end) {
  return layout.members[end.member].tie->kernel_rows(end.side);
}

const SparseRows& rows_pressed(const TieLayout& layout, const TieLayout::End& end) {
  return layout.rows(end).force[end.side];
}

/// Motions (steps, patterns) of the ports that were seen, one after the other, as those of rows.
void read(const TieLayout& layout, const TieLayout::Part& part, decltype(rows_read)& rows_of,
          int from, int patterns, std::span<const double> motions, std::span<const int> seen,
          const TakeMotion& take, const Bodies& bodies) {
  std::vector<double> moved;
  const double* values = motions.data();
  for (int k = 0; values < motions.data() + motions.size(); ++k) {
    for (const int port : seen) {
      const std::size_t width = width_of(bodies, part.body, port);
      for (const TieLayout::End& end : part.ends) {
        if (layout.carries(end) || layout.side(end).port != port) continue;
        const TieRows& rows = layout.rows(end);
        moved.resize(index(rows.width()));
        apply(rows_of(layout, end), rows.dim, std::span(values, width), moved);
        take(from + k % patterns, k / patterns, end, moved);
      }
      values += width;
    }
  }
}

void read(const TieLayout& layout, const TieLayout::Part& part, const PortKernel& kernel,
          std::span<const int> seen, const TakeLoose& take, const Bodies& bodies) {
  const int motions = loose_motions(bodies.describe(part.body));
  read(layout, part, rows_read, 0, motions, kernel.carried, seen, take.motion, bodies);
  read(layout, part, rows_pressed, 0, motions, kernel.carried, seen, take.acted_on, bodies);
  for (int k = 0; k < motions; ++k)
    take.left(k, std::span(kernel.left).subspan(index(k * motions), index(motions)));
}

}  // namespace

void press(const TieLayout& layout, const TieLayout::Part& part, const TieLayout::End& by,
           int patterns, int steps, const FillForces& fill, const TakeMotion& take, Bodies& bodies,
           const TakeLoose& loose) {
  const TieRows& rows = layout.rows(by);
  const int pressed = layout.side(by).port;
  const std::vector<int> seen = joined_ports(layout, part);
  const std::size_t width = width_of(bodies, part.body, pressed);
  std::size_t values = 0;
  for (const int port : seen) values += width_of(bodies, part.body, port);
  const double each = 8.0 * steps * static_cast<double>(values);
  const int at_once = std::clamp(static_cast<int>(reply_bytes / each), 1, patterns);
  for (int from = 0; from < patterns; from += at_once) {
    const int count = std::min(at_once, patterns - from);
    std::vector<double> forces(index(count) * width, 0.0);
    for (int k = 0; k < count; ++k) {
      std::vector<double> unit(index(rows.width()), 0.0);
      fill(from + k, unit);
      rows.press(by.side, 1.0, unit, std::span(forces).subspan(index(k) * width, width));
    }
    const PortKernel kernel = bodies.probe(part.body, pressed, forces, steps, seen);
    require_for_substeps(kernel, layout.side(by), layout.other_side(by), bodies);
    read(layout, part, rows_read, from, kernel.patterns, kernel.displacement, seen, take, bodies);
    if (from == 0 && !kernel.left.empty()) read(layout, part, kernel, seen, loose, bodies);
  }
}

}  // namespace abut
