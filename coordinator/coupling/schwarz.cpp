#include "coordinator/coupling/schwarz.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/span.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {

/// Islands of the past whose secants are kept. Many bodies hang together in ever new ways.
constexpr std::size_t most_kept = 256;

SchwarzReport report_of(const Iterate& it, const Net& net) {
  return {it.converged, it.sweep, it.residual, net.contact_beside_ties(), it.contradiction};
}

void restore(const Island& island, Bodies& bodies) {
  for (const std::vector<int>& level : island.levels)
    for (const int body : level) bodies[body].restore();
}

std::string names_of(const Island& island, const Bodies& bodies) {
  std::string names;
  for (const std::vector<int>& level : island.levels)
    for (const int body : level) names += (names.empty() ? "" : ", ") + bodies.describe(body).name;
  return names;
}

/// No body of it has inertia.
bool has_no_inertia(const Island& island, const Bodies& bodies) {
  return std::ranges::all_of(island.levels, [&bodies](const std::vector<int>& level) {
    return std::ranges::all_of(level, [&bodies](int body) {
      const Description& of = bodies.describe(body);
      return of.quasi_static || std::isinf(of.mass);
    });
  });
}

}  // namespace

std::variant<SchwarzReport, Failed> Schwarz::solve(const TimeWindow& window, const Island& island,
                                                   std::span<const Joint> joints, Bodies& bodies) {
  SpanScope span(bodies.spans(), "island");
  if (span.heard()) span.label(names_of(island, bodies));
  const auto& [accelerator, net] = memory_of(island.joints);
  net->begin(window, island, joints, bodies);
  for (Eigen::VectorXd* v : {&it_.x, &it_.g, &it_.s}) v->resize(net->size());
  const int usual = has_no_inertia(island, bodies) ? Steps::usual_most_of_statics
                    : net->contact_beside_ties()   ? Steps::usual_most_beside_ties
                                                   : Steps::usual_most;
  Steps steps(*net, *accelerator, {most_.value_or(usual), tolerance_}, bodies);
  if (std::optional<Failed> failed = net->predict(it_.x, bodies)) return *failed;
  for (it_.sweep = 1;; ++it_.sweep) {
    SpanScope iteration(bodies.spans(), "iteration", it_.sweep);
    if (std::optional<Failed> failed = sweep(*net, bodies)) {
      if (!steps.back(it_)) return *failed;
    } else {
      see(*net, bodies);
      if (steps.enough(it_)) return report_of(it_, *net);
      steps.next(it_, bodies);
      if (steps.arrived(it_)) return report_of(it_, *net);
    }
    restore(island, bodies);
  }
}

std::optional<Failed> Schwarz::sweep(Net& net, Bodies& bodies) {
  const std::vector<std::vector<int>>& levels = net.island().levels;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    net.impose(level, it_.x, bodies);
    if (std::optional<Failed> failed = bodies.advance(levels[level])) return failed;
  }
  return std::nullopt;
}

void Schwarz::see(Net& net, const Bodies& bodies) {
  net.image(it_.x, bodies, it_.g, it_.s);
  it_.mismatch = net.distance(it_.x, it_.g);
  bool stays_open = false;
  it_.contradiction = net.contradiction(it_.g - it_.x, tolerance_, bodies, stays_open);
  it_.residual = net.residual(it_.x, it_.g);
  it_.converged = it_.contradiction.empty() && it_.residual.largest() <= tolerance_;
}

Schwarz::Memory& Schwarz::memory_of(const std::vector<int>& joints) {
  Memory& memory = memories_[joints];
  if (memory.net == nullptr) memory = make_(joints);
  return memory;
}

void Schwarz::keep(std::span<const Island> islands) {
  if (memories_.size() <= most_kept + islands.size()) return;
  std::map<std::vector<int>, Memory> kept;
  for (const Island& island : islands) {
    auto node = memories_.extract(island.joints);
    if (!node.empty()) kept.insert(std::move(node));
  }
  memories_ = std::move(kept);
}

void Schwarz::accept(const Island& island) { memories_.at(island.joints).accelerator->accept(); }

void Schwarz::state(Archive& archive) {
  std::vector<std::vector<int>> islands;
  for (const auto& [joints, memory] : memories_) islands.push_back(joints);
  list(archive, "islands", islands,
       [](Archive& a, std::vector<int>& joints) { field(a, "joints", joints); });
  for (const std::vector<int>& joints : islands) {
    Memory& memory = memory_of(joints);
    memory.accelerator->state(archive);
    memory.net->state(archive);
  }
}

}  // namespace abut
