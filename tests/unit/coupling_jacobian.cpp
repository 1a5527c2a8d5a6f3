// Goal: the interface Jacobians made of port kernels are those of the maps that are iterated.
// Oracle: differences of the real maps, which are affine: exact for any size of the difference.

#include <memory>
#include <optional>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "coordinator/coupling/compare/parallel_force.hpp"
#include "coordinator/coupling/joint.hpp"
#include "coordinator/coupling/line_watch.hpp"
#include "coordinator/coupling/unilateral.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::coupling_jacobian_tests {
namespace {

struct Pair {
  std::string name;
  std::string left, left_layer, right, right_layer;  // the left body is the kinematic one

  friend std::ostream& operator<<(std::ostream& out, const Pair& p) { return out << p.name; }
};

const std::string massless = "massless: {stiffness_factor: 1.4}";
const std::string kick = "kick: {}";
const std::string solid = "solid";  // a bar by the model of solids

BarText bar(const std::string& name, const std::string& integrator, const std::string& layer) {
  BarText b = unit_bar(name, 30.0, 30, integrator, name == "left" ? -30.0 : 0.0,
                       name == "left" ? 0.01 : -0.02);
  b.sides = {name == "left" ? "right" : "left"};
  b.solid = layer == solid;
  if (!b.solid) b.layer = layer;
  if (name == "right") b.modulus = 2.0;  // not the symmetric special case
  return b;
}

std::vector<Pair> pairs() {
  std::vector<Pair> all;
  struct Steps {
    const char* name;
    double left, right;
  };
  // The right bar's wave speed is sqrt(2): its limit is 0.707.
  for (const Steps& s :
       {Steps{"1to1", 0.6, 0.6}, {"10to1", 0.6, 0.06}, {"1to10", 0.06, 0.6}, {"2to3", 0.4, 0.6}}) {
    auto add = [&all, &s](const std::string& name, const std::string& a, const std::string& al,
                          const std::string& b, const std::string& bl) {
      all.push_back({name + "_" + s.name, a, al, b, bl});
    };
    const std::string el = explicit_scheme(s.left), er = explicit_scheme(s.right);
    const std::string pl = explicit_scheme(s.left, 6), pr = explicit_scheme(s.right, 6);
    const std::string nl = implicit_scheme("newmark", s.left);
    const std::string nr = implicit_scheme("newmark", s.right);
    add("massless_massless", el, massless, er, massless);
    add("kick_kick", el, kick, er, kick);
    add("massless_kick", el, massless, er, kick);
    add("kick_massless", el, kick, er, massless);
    add("six_terms", pl, massless, pr, massless);
    add("six_terms_kick", pl, kick, pr, massless);
    add("implicit_implicit", nl, massless, nr, massless);
    add("implicit_explicit", nl, massless, er, massless);
    add("explicit_implicit", el, massless, nr, massless);
    add("kick_implicit", el, kick, nr, massless);
    add("implicit_kick", nl, massless, er, kick);
    add("massless_solid", el, massless, er, solid);
    add("six_terms_solid", pl, massless, er, solid);
    add("implicit_solid", el, massless, nr, solid);
    add("hht_alpha", implicit_scheme("hht_alpha", s.left), massless,
        implicit_scheme("generalized_alpha", s.right), massless);
  }
  return all;
}

/// Two bodies in contact over one window, and the map G of a transmission.
class Contact {
 public:
  /// `gap` [m] at the begin; without one contact stays, and the map is linear.
  Contact(const Pair& pair, Exchange& transmission, int kinematic,
          std::optional<double> gap = std::nullopt)
      : left_(build(bar("left", pair.left, pair.left_layer))),
        right_(build(bar("right", pair.right, pair.right_layer))),
        bodies_({left_.get(), right_.get()}),
        transmission_(transmission) {
    bodies_.prepare({0, 0.0, 0.0}, 1, Sampling::substeps);
    EXPECT_FALSE(bodies_.advance_all());
    bodies_.save_all();
    joint_ = make_joint("impact", {Side{0, 0}, Side{1, 0}}, bodies_);
    if (!gap) joint_.watch = std::make_unique<SharedNodeWatch>();
    joint_.line.reference_gap = gap.value_or(0.0);
    joint_.role.kinematic = kinematic;
    joint_.engage(0.03);
    for (std::size_t s : {0u, 1u}) {  // the bodies see the gap in the places of the surfaces
      PortGeometry partner = bodies_.port(joint_.sides[1 - s]).geometry;
      partner.points[0] =
          bodies_.port(joint_.sides[s]).geometry.points[0] + joint_.offset(static_cast<int>(s));
      bodies_.meet(joint_.sides[s], partner, {joint_.tied()});
    }
    bodies_.prepare(window_, 1, Sampling::substeps);
    transmission_.begin(window_, joint_, bodies_);
  }

  Eigen::VectorXd predict() const {
    Eigen::VectorXd x(transmission_.values());
    transmission_.predict(x);
    return x;
  }
  Eigen::VectorXd image(const Eigen::VectorXd& x) {
    bodies_.restore_all();
    bodies_.prepare(window_, 1, Sampling::substeps);
    const int k = joint_.role.kinematic;
    if (transmission_.ordered()) {
      for (int side : {k, 1 - k}) {
        transmission_.impose(side, x, joint_, bodies_);
        EXPECT_FALSE(bodies_.advance(std::span<const int>(&side, 1)));
      }
    } else {
      for (int side : {0, 1}) transmission_.impose(side, x, joint_, bodies_);
      EXPECT_FALSE(bodies_.advance_all());
    }
    Eigen::VectorXd g(x.size());
    transmission_.image(x, joint_, bodies_, g);
    return g;
  }
  /// J = -d(G - x) / dx, column by column, with differences of size 1.
  Eigen::MatrixXd jacobian(double about = 0.0) {
    const Eigen::VectorXd x = predict() + Eigen::VectorXd::Constant(transmission_.values(), about);
    const Eigen::VectorXd base = image(x) - x;
    Eigen::MatrixXd j(x.size(), x.size());
    for (Eigen::Index c = 0; c < x.size(); ++c) {
      Eigen::VectorXd moved = x;
      moved[c] += 1.0;
      j.col(c) = base - (image(moved) - moved);
    }
    return j;
  }
  Bodies& bodies() { return bodies_; }
  const TimeWindow& window() const { return window_; }
  Substeps grid(int body) {
    return Substeps::divide(window_.begin, window_.end, bodies_.describe(body).step);
  }

 private:
  std::unique_ptr<Subdomain> left_, right_;
  Bodies bodies_;
  Joint joint_;
  Exchange& transmission_;
  TimeWindow window_{0, 0.0, 3.6};
};

std::string pair_name(const testing::TestParamInfo<Pair>& info) { return info.param.name; }

class PortJacobian : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Coupling, PortJacobian, testing::ValuesIn(pairs()), pair_name);

/// Round-off of a map's difference: a few hundred operations per entry on numbers of the size of
/// the largest, which 60 substeps may carry on.
double rounding(const Eigen::MatrixXd& j) {
  return roundoff(60.0 * 300.0, std::max(1.0, j.lpNorm<Eigen::Infinity>()));
}

TEST_P(PortJacobian, OfTheUnilateralMapIsItsDifference) {
  Unilateral transmission;
  Contact contact(GetParam(), transmission, 0);
  const Eigen::MatrixXd measured = contact.jacobian();
  const Substeps k = contact.grid(0), n = contact.grid(1);
  const Eigen::MatrixXd closed = unilateral_jacobian(contact.bodies().kernel(0, 0, k.count), k,
                                                     contact.bodies().kernel(1, 0, n.count), n);
  ASSERT_EQ(closed.rows(), measured.rows());
  EXPECT_LT((closed - measured).lpNorm<Eigen::Infinity>(), rounding(measured));
  // what the accelerator is given is its inverse
  const Eigen::VectorXd r = Eigen::VectorXd::LinSpaced(measured.rows(), -1.0, 2.0);
  const Eigen::VectorXd expected = measured.partialPivLu().solve(r);
  EXPECT_LT((transmission.apply_inverse(r) - expected).norm(),
            rounding(measured) * measured.inverse().norm() * r.norm());
}

TEST_P(PortJacobian, SolvesTheUnilateralWindowInOneCorrection) {
  Unilateral transmission;
  Contact contact(GetParam(), transmission, 0);
  Eigen::VectorXd x = contact.predict();
  const Eigen::VectorXd first = contact.image(x) - x;
  x += transmission.apply_inverse(first);
  const Eigen::VectorXd second = contact.image(x) - x;
  const Eigen::MatrixXd j = contact.jacobian();
  EXPECT_LT(second.lpNorm<Eigen::Infinity>(),
            rounding(j) * std::max(first.norm() * j.inverse().norm(), 0.1));
  // G's own values of 0.1 m are rounded, too
}

TEST_P(PortJacobian, AnswersContactThatBeginsInTheWindowInOneCorrection) {
  // Where a kick layer begins to be held its dispersion correction changes, which the kernel does
  // not know: corrections go on to converge there, and elsewhere the first one is exact.
  const bool switches = GetParam().name.starts_with("six_terms_kick");
  const int corrections = switches ? 12 : 1;
  for (double gap : {0.0, 0.02, 0.045, 0.07}) {  // closing at 0.03 m/s, 3.6 s
    Unilateral alternating;
    ParallelForce parallel;
    for (Exchange* transmission : std::initializer_list<Exchange*>{&alternating, &parallel}) {
      Contact contact(GetParam(), *transmission, 0, gap);
      Eigen::VectorXd x = contact.predict();
      const Eigen::VectorXd first = contact.image(x) - x;
      Eigen::VectorXd second = first;
      for (int k = 0; k < corrections; ++k) {
        x += transmission->apply_inverse(second);
        second = contact.image(x) - x;
      }
      // Kicks finer than their partner's steps are settled to 1e-3 at once.
      const bool creeps = GetParam().left_layer == kick && GetParam().name.ends_with("1to10");
      const double digits = creeps ? 1.0e-3 : 1.0e-9;
      EXPECT_LT(second.lpNorm<Eigen::Infinity>(), digits * std::max(first.norm(), 0.1)) << gap;
    }
  }
}

TEST_P(PortJacobian, OfTheParallelMapIsItsDifference) {
  ParallelForce transmission;
  Contact contact(GetParam(), transmission, 0);
  // Kick layers smooth a node that is held otherwise: the map is linear about forces that all push.
  const Eigen::MatrixXd measured = contact.jacobian(1.0);
  const Eigen::VectorXd r = Eigen::VectorXd::LinSpaced(measured.rows(), -1.0, 2.0);
  const Eigen::VectorXd expected = measured.partialPivLu().solve(r);
  EXPECT_LT((transmission.apply_inverse(r) - expected).norm(),
            rounding(measured) * measured.inverse().norm() * r.norm());
}

TEST(Complementarity, IsSettledAlsoWhereForcesReachBackInTime) {
  // Substeps of unlike length see forces of a little later: A is not quite lower triangular.
  const Eigen::Index n = 7;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) a(i, j) = 2.0 / static_cast<double>(1 + i - j);
    if (i + 1 < n) a(i, i + 1) = 0.5;
  }
  Eigen::VectorXd overlap(n), force(n);
  overlap << -1.0, 2.0, 3.0, -4.0, 0.5, -0.1, 1.0;
  force << 0.0, 0.2, 1.0, 2.0, 0.0, 0.3, 0.0;
  const Eigen::VectorXd change = solve_complementarity(a, overlap, force);
  const Eigen::VectorXd left = overlap - a * change, now = force + change;
  int pressed = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    EXPECT_GE(now[i], 0.0);
    EXPECT_LE(left[i], 1e-11);  // passes end at 1e-13 of the largest change
    EXPECT_NEAR(now[i] * left[i], 0.0, 1e-11);
    pressed += now[i] > 1e-12 ? 1 : 0;
  }
  EXPECT_GT(pressed, 0);
  EXPECT_LT(pressed, n);
}

TEST(UnilateralSolution, MakesForcesAndGapsComplementary) {
  // kernels of two softening ports; contact at some substeps of the last sweep, gaps at others
  const std::vector<double> ck = {2.0, 1.5, 1.2, 1.0, 0.9, 0.85},
                            cn = {1.0, 1.1, 1.2, 1.2, 1.1, 1.0};
  const Eigen::Index n = 6;
  Eigen::VectorXd overlap(n), force(n), r(n);
  overlap << 0.0, -0.4, 0.0, -0.1, 0.0, -2.0;
  force << 0.5, 0.0, 2.0, 0.0, 0.1, 0.0;
  r << -3.0, 1.0, 0.5, 2.0, -4.0, 0.3;
  for (double normal : {1.0, -1.0}) {
    const Eigen::VectorXd motion = solve_unilateral(ck, cn, normal, r, overlap, force);
    // the change of force that this motion belongs to, and what it leaves of the overlap
    const Eigen::VectorXd change = solve_toeplitz(cn, normal * (r - motion));
    Eigen::VectorXd left = overlap + normal * r;
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) left[i] -= (ck[i - j] + cn[i - j]) * change[j];
    const Eigen::VectorXd now = force + change;
    int pressed = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      EXPECT_GE(now[i], -1e-12);
      // Passes end at 1e-13 of the largest change, which is 4 here.
      EXPECT_LE(left[i], 1e-12);
      EXPECT_NEAR(now[i] * left[i], 0.0, 1e-12);
      pressed += now[i] > 1e-12 ? 1 : 0;
    }
    EXPECT_GT(pressed, 0);
    EXPECT_LT(pressed, n);
  }
}

}  // namespace
}  // namespace abut::coupling_jacobian_tests
