#include "coordinator/coupling/roles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"
#include "contract/substeps.hpp"
#include "coordinator/coupling/port_jacobian.hpp"
#include "coordinator/coupling/transmission.hpp"

namespace abut {

namespace {

/// Compliances within this factor count as similar: the mesh decides.
constexpr double similar = 3.0;

/// A joint's kinematic side as its two bodies alone would have it.
struct Wish {
  std::size_t joint = 0;
  int kinematic = 0;
  bool fixed = false;    // by the scene, or because the other side cannot
  double clarity = 0.0;  // how much there is to say for it
};

/// Which bodies come before which: kinematic sides first.
class Order {
 public:
  explicit Order(int bodies) : after_(index(bodies)) {}
  void add(int before, int after) { after_[index(before)].push_back(after); }
  bool comes_before(int before, int after) const {
    if (before == after) return true;
    return std::ranges::any_of(after_[index(before)],
                               [this, after](int next) { return comes_before(next, after); });
  }

 private:
  std::vector<std::vector<int>> after_;  // by body: without circles
};

/// What a constant unit force moves over a window, summed over its substeps [m/N].
double moved_over(const Side& side, Bodies& bodies, double window) {
  const Substeps grid = Substeps::divide(0.0, window, bodies.describe(side.body).step);
  const PortKernel& kernel = bodies.kernel(side.body, side.port, grid.count);
  return std::accumulate(kernel.displacement.begin(), kernel.displacement.begin() + grid.count,
                         0.0);
}

Wish wish_of(const Joint& joint, Bodies& bodies, double window) {
  Wish wish;
  for (std::size_t s : {0u, 1u}) {
    if (bodies.describe(joint.sides[s].body).can.obstacle) continue;
    wish.kinematic = 1 - static_cast<int>(s);
    wish.fixed = true;
    // the whole window's kernel will be needed: one probe instead of one per length
    moved_over(joint.sides[1 - s], bodies, window);
    return wish;
  }
  const double step[2] = {bodies.describe(joint.sides[0].body).step,
                          bodies.describe(joint.sides[1].body).step};
  if (joint.tied() && step[0] != step[1]) {
    wish.kinematic = coarser_side(joint, bodies);
    wish.clarity = std::numeric_limits<double>::infinity();
    return wish;
  }
  const double moved[2] = {moved_over(joint.sides[0], bodies, window),
                           moved_over(joint.sides[1], bodies, window)};
  const double spacing[2] = {bodies.port(joint.sides[0]).geometry.spacing,
                             bodies.port(joint.sides[1]).geometry.spacing};
  wish.clarity = std::abs(std::log(moved[0] / moved[1]));
  if (moved[0] > similar * moved[1]) {
    wish.kinematic = 0;
  } else if (moved[1] > similar * moved[0]) {
    wish.kinematic = 1;
  } else if (spacing[0] != spacing[1]) {
    wish.kinematic = spacing[0] < spacing[1] ? 0 : 1;
  } else {
    wish.kinematic = step[1] < step[0] ? 1 : 0;
  }
  return wish;
}

}  // namespace

void choose_roles(std::span<Joint> joints, Bodies& bodies, double window, bool parallel) {
  std::vector<Wish> wishes;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    Joint& joint = joints[j];
    if (joint.how == nullptr) continue;
    if (!joint.how->ordered()) {
      if (parallel && !joint.role_fixed) joint.kinematic = coarser_side(joint, bodies);
      continue;
    }
    Wish wish{0, joint.kinematic, true, 0.0};
    if (!joint.role_fixed) wish = wish_of(joint, bodies, window);
    wish.joint = j;
    wishes.push_back(wish);
  }
  std::ranges::stable_sort(wishes, [](const Wish& a, const Wish& b) {
    return a.fixed != b.fixed ? a.fixed : a.clarity > b.clarity;
  });
  Order order(bodies.count());
  for (const Wish& wish : wishes) {
    Joint& joint = joints[wish.joint];
    joint.kinematic = wish.kinematic;
    const int before = joint.kinematic_side().body, after = joint.neumann_side().body;
    if (order.comes_before(after, before)) {
      if (wish.fixed) {
        throw InputError(
            "closes a circle of bodies of which each would have to move before the next",
            "interfaces." + joint.name,
            "Fix fewer roles: leave `kinematic: auto` on at least one interface of the circle.");
      }
      joint.kinematic = 1 - joint.kinematic;
    }
    order.add(joint.kinematic_side().body, joint.neumann_side().body);
  }
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
  return step1 > step0 ? 1 : 0;
}

}  // namespace abut
