#include "coordinator/coupling/roles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/nearly.hpp"
#include "contract/substeps.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/port_jacobian.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {

/// Compliances within this factor count as similar: the mesh decides.
constexpr double similar = 3.0;

/// What a constant unit force moves over a window, summed over its substeps [m/N].
double moved_over(const Side& side, Bodies& bodies, double window) {
  const Substeps grid = Substeps::divide(0.0, window, bodies.describe(side.body).step);
  const PortKernel& kernel = bodies.kernel(side.body, side.port, grid.count);
  return std::accumulate(kernel.displacement.begin(), kernel.displacement.begin() + grid.count,
                         0.0);
}

/// The side that alone takes obstacles; none: both do.
std::optional<int> only_side(const Joint& joint, const Bodies& bodies) {
  for (int s : {0, 1}) {
    if (!bodies.describe(joint.sides[s].body).can.obstacle) return 1 - s;
  }
  return std::nullopt;
}

}  // namespace

bool BodyOrder::comes_before(int before, int after) const {
  std::vector<bool> seen(after_.size(), false);
  std::vector<int> waiting = {before};
  while (!waiting.empty()) {
    const int body = waiting.back();
    waiting.pop_back();
    if (body == after) return true;
    if (seen[body]) continue;
    seen[body] = true;
    waiting.insert(waiting.end(), after_[body].begin(), after_[body].end());
  }
  return false;
}

/// As its two bodies alone would have it; both take obstacles.
int Roles::wish(const Joint& joint) {
  double moved[2], spacing[2], step[2];
  for (std::size_t s : {0u, 1u}) step[s] = bodies_.describe(joint.sides[s].body).step;
  if (joint.tied() && !nearly_equal(step[0], step[1])) return coarser_side(joint, bodies_);
  for (std::size_t s : {0u, 1u}) {
    moved[s] = moved_over(joint.sides[s], bodies_, window_);
    spacing[s] = bodies_.port(joint.sides[s]).geometry.spacing;
  }
  if (moved[0] > similar * moved[1]) return 0;
  if (moved[1] > similar * moved[0]) return 1;
  if (!nearly_equal(spacing[0], spacing[1])) return spacing[0] < spacing[1] ? 0 : 1;
  return bodies_.side_of_less(joint.sides, step[0], step[1]);
}

std::optional<int> shorter_steps(const Joint& joint, const Bodies& bodies) {
  const Description &a = bodies.describe(joint.sides[0].body),
                    &b = bodies.describe(joint.sides[1].body);
  const bool moves = std::isfinite(a.mass) && std::isfinite(b.mass);
  if (!moves || a.step <= 0.0 || b.step <= 0.0 || nearly_equal(a.step, b.step)) return std::nullopt;
  return a.step < b.step ? 0 : 1;
}

/// Of two bodies without inertia, of which one at least is loose.
std::optional<int> nearer_to_support(const Joint& joint, const Bodies& bodies) {
  std::array<std::optional<int>, 2> distance;
  std::array<bool, 2> loose;
  for (const std::size_t s : {0u, 1u}) {
    const Description& body = bodies.describe(joint.sides[s].body);
    if (!body.quasi_static && std::isfinite(body.mass)) return std::nullopt;
    distance[s] = bodies.support_distance(joint.sides[s].body);
    loose[s] = distance[s] != 0;
  }
  if (loose[0] != loose[1]) return loose[0] ? 0 : 1;
  if (!loose[0] || distance[0] == distance[1] || !distance[0] || !distance[1]) return std::nullopt;
  return *distance[0] < *distance[1] ? 0 : 1;
}

int contact_finder(const Joint& joint, const Bodies& bodies) {
  if (joint.role.fixed) return joint.role.kinematic;
  if (const std::optional<int> only = only_side(joint, bodies)) return *only;
  if (joint.role.fitted >= 0) return joint.role.fitted;
  if (joint.role.adjusted >= 0) return joint.role.adjusted;
  if (const std::optional<int> nearer = nearer_to_support(joint, bodies)) return *nearer;
  bool yields[2];
  double spacing[2];
  for (std::size_t s : {0u, 1u}) {
    const Description& body = bodies.describe(joint.sides[s].body);
    yields[s] = (body.can.kernel && body.linear) || std::isinf(body.mass);
    spacing[s] = bodies.port(joint.sides[s]).geometry.spacing;
  }
  if (const std::optional<int> shorter = shorter_steps(joint, bodies)) return *shorter;
  if (yields[0] != yields[1]) return yields[0] ? 1 : 0;
  return bodies.side_of_less(joint.sides, spacing[0], spacing[1]);
}

void Roles::settle(Joint& joint, int kinematic, bool may_turn) {
  joint.role.kinematic = kinematic;
  if (order_.comes_before(joint.neumann_side().body, joint.kinematic_side().body)) {
    if (!may_turn) {
      throw InputError(
          "closes a circle of bodies of which each would have to move before the next",
          "interfaces." + joint.name,
          "Fix fewer roles: leave `kinematic: auto` on at least one interface of the circle.");
    }
    joint.role.kinematic = 1 - kinematic;
  }
  order_.add(joint.kinematic_side().body, joint.neumann_side().body);
}

void Roles::start(std::span<Joint> joints) {
  const auto ordered = [](const Joint& joint) {
    return joint.exchange != nullptr && joint.exchange->ordered();
  };
  for (Joint& joint : joints) {
    const std::optional<int> only = only_side(joint, bodies_);
    if (joint.role.fixed && ordered(joint)) {
      settle(joint, joint.role.kinematic, false);
    } else if (only && ordered(joint)) {
      settle(joint, *only, false);
    }
  }
  for (Joint& joint : joints)
    if (joint.tied()) choose(joint);
  for (const auto& [own, contact, part] : known_exchanges(joints).obstacles) join(joints[part]);
}

bool Roles::keep(std::span<const Joint> joints) {
  BodyOrder order(bodies_.count());
  for (const Joint& joint : joints) {
    const std::optional<int> only = only_side(joint, bodies_);
    if (joint.tied() || (only && *only != joint.role.kinematic)) return false;
    if (joint.exchange != nullptr && joint.exchange->ordered() && joint.role.fixed)
      order.add(joint.kinematic_side().body, joint.neumann_side().body);
  }
  order_ = std::move(order);
  return true;
}

void Roles::join(Joint& joint) {
  if (joint.role.fixed) return;
  const std::optional<int> only = only_side(joint, bodies_);
  settle(joint, only ? *only : contact_finder(joint, bodies_), !only && joint.role.fitted < 0);
  joint.role.fixed = true;
}

bool Roles::choose(Joint& joint) {
  if (joint.role.fixed) return false;
  joint.role.fixed = true;
  if (parallel_) {
    joint.role.kinematic = coarser_side(joint, bodies_);
  } else if (const std::optional<int> only = only_side(joint, bodies_)) {
    // settled at the start; the whole window's kernel will be needed, so that one probe is enough
    moved_over(joint.sides[*only], bodies_, window_);
  } else {
    settle(joint, wish(joint), true);
  }
  return true;
}

double stable_step_in_contact(const Joint& joint, Bodies& bodies, double length) {
  const double none = std::numeric_limits<double>::infinity();
  const Side& k = joint.kinematic_side();
  const Side& n = joint.neumann_side();
  const Description& body = bodies.describe(n.body);
  const Substeps grid = Substeps::divide(0.0, length, body.step);
  if (!std::isfinite(body.stable_step) || body.step <= 0.0 || grid.count < 2) return none;
  // A force at the end of a substep moves a node with mass in the next one only: by step^2 / m.
  const PortKernel& answer = bodies.kernel(n.body, n.port, grid.count);
  if (answer.displacement[0] != 0.0) return none;
  const Substeps spring_grid = Substeps::divide(0.0, length, bodies.describe(k.body).step);
  const PortKernel& spring = bodies.kernel(k.body, k.port, spring_grid.count);
  if (quasi_static(spring) <= 0.0) return none;
  const double own = 2.0 / body.stable_step;
  const double added = answer.displacement[1] / (body.step * body.step * quasi_static(spring));
  return 2.0 / std::sqrt(own * own + added);
}

int coarser_side(const Joint& joint, const Bodies& bodies) {
  const double step0 = bodies.describe(joint.sides[0].body).step;
  const double step1 = bodies.describe(joint.sides[1].body).step;
  return bodies.side_of_less(joint.sides, -step0, -step1);
}

void BodyOrder::state(Archive& archive) {
  list(archive, "order", after_,
       [](Archive& a, std::vector<int>& after) { field(a, "after", after); });
}

}  // namespace abut
