#include "coordinator/conformance/port_work.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/index.hpp"

namespace abut {

namespace {

/// What schemes tell apart in four steps: mean velocities, half steps; where they weight forces of
/// both ends of a step, a tenth.
double tolerance_of(const Description& body) { return body.conserves ? 0.05 : 0.15; }

/// Force times way [J].
struct Ways {
  double sum = 0.0, size = 0.0;  // and of the parts' sizes
  double open = 0.0;             // by which it may be another one

  void add(double force, double way) {
    sum += force * way;
    size += std::abs(force * way);
  }
};

/// Along the first substeps of a trace that begins where `before` ends. Under forces of instants
/// (NODAL) a surface without mass gives way at once when a force begins, which takes half the force
/// on the mean: before the trace begins, or in its first substep, as an unknown part of that. Under
/// forces of steps what goes by velocities of steps' ends is half of the last step ahead of its
/// energy.
Ways force_times_way(const Waveform& before, const Waveform& trace,
                     const std::vector<double>& force, std::size_t substeps) {
  const std::size_t width = index(trace.width);
  const bool levels = trace.support == ForceSupport::nodal;
  Ways ways;
  for (std::size_t k = 0; k < width; ++k) {
    ways.add(0.5 * force[k], trace.u[k] - before.u[before.u.size() - width + k]);
    for (std::size_t i = 1; i <= substeps; ++i) {
      const double way = trace.u[i * width + k] - trace.u[(i - 1) * width + k];
      ways.add((levels && i == 1 ? 0.75 : 1.0) * force[k], way);
      if (levels && i == 1) ways.open += std::abs(0.25 * force[k] * way);
      if (!levels && i == substeps) ways.open += std::abs(0.5 * force[k] * way);
    }
  }
  return ways;
}

double gained(const BodyRecord& record) {
  const Energy& energy = record.energy;
  return energy.total() + energy.dissipated - energy.external_work;
}

/// The same until a record, of a push and its opposite together.
Ways both_ways(const Worked& worked, const Push& push, std::size_t record) {
  const std::size_t p = index(push.port);
  const Waveform &one = worked.pushed.ports[p].trace, &other = worked.opposite.ports[p].trace;
  Waveform apart = one, none = one;
  for (std::size_t i = 0; i < apart.u.size(); ++i) apart.u[i] -= other.u[i];
  for (double& each : none.u) each = 0.0;
  const std::size_t substeps = (one.size() - 1) * (record + 1) / worked.pushed.records.size();
  return force_times_way(none, apart, push.force.f, substeps);
}

}  // namespace

void hold_work(const Description& body, const Response& before, const Response& free,
               const Response& pushed, const Push& push) {
  const std::size_t p = index(push.port);
  const Waveform& trace = pushed.ports[p].trace;
  const Ways ways = force_times_way(before.ports[p].trace, trace, push.force.f, trace.size() - 1);
  const double told = pushed.ports[p].work;
  const std::string& name = body.ports[p].name;
  const double apart = tolerance_of(body) * ways.size + ways.open;
  if (!body.quasi_static && std::abs(told - ways.sum) > apart)
    throw BrokenClause(
        fmt::format("port {} tells {:.6g} J of work, where force times way is {:.6g} J", name, told,
                    ways.sum),
        "The energy that came through a port is the integral of force times velocity, and "
        "positive where the force acts along the motion.");
  const double stood = gained(free.records.back());
  const double rose = gained(pushed.records.back()) - stood;
  const double rounding = 1.0e4 * one_rounding * std::abs(stood);
  if (body.conserves && std::abs(rose - told) > tolerance_of(body) * ways.size + rounding)
    throw BrokenClause(
        fmt::format("port {} tells {:.6g} J of work, and the energy of the body rises by {:.6g} J "
                    "through it",
                    name, told, rose),
        "A body that conserves changes its energy by what comes through its ports and by "
        "external work; correct energy or work, or do not tell that it conserves.");
}

void hold_energy(const Description& body, const Worked& worked) {
  const std::size_t records = worked.pushed.records.size();
  for (std::size_t r = 0; r < records; ++r) {
    const bool last = r + 1 == records;  // where the work is told
    double came = 0.0, size = 0.0, open = 0.0;
    std::string names;
    for (const Push& push : worked.pushes) {
      const std::size_t p = index(push.port);
      const Ways ways = both_ways(worked, push, r);
      const double told = worked.pushed.ports[p].work + worked.opposite.ports[p].work;
      came += last ? told : ways.sum;
      size += ways.size;
      open += last ? 0.0 : ways.open;
      names += (names.empty() ? "" : ", ") + body.ports[p].name;
    }
    const double free = gained(worked.free.records[r]);
    const double rose =
        gained(worked.pushed.records[r]) + gained(worked.opposite.records[r]) - 2.0 * free;
    const double rounding = 1.0e4 * one_rounding * (std::abs(free) + std::abs(rose));
    if (std::abs(rose - came) > tolerance_of(body) * size + open + rounding)
      throw BrokenClause(
          fmt::format(
              "by work of forces on port {}, and of their opposites, come {:.6g} J, and the "
              "energy of the body rises by {:.6g} J through them",
              names, came, rose),
          "A body that conserves changes its energy by what comes through its ports and by "
          "external "
          "work: correct energy, work or the points that forces act on, or do not tell that it "
          "conserves.");
  }
}

}  // namespace abut
