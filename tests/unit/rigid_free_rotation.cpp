// Goal: the rotation of a free body is exact to round-off for every body and any time. Oracles: the
// closed forms of tops and of asymmetric bodies (Jacobi's elliptic functions, computed by means,
// and the elliptic integral of the third kind), the hyperbolic motion on the separatrix, an
// independent integration in longer numbers, and what a rotation conserves.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "subdomain_solver/rigid/free_rotation.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::rigid_free_rotation_tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Moments of inertia to second moments of mass.
Vector3d second_moments(const Vector3d& inertia) {
  return Vector3d::Constant(0.5 * inertia.sum()) - inertia;
}

Quaterniond turn_about(const Vector3d& axis, double angle) {
  return Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// Largest angle between what two attitudes make of a vector, nearly.
double distance(const Quaterniond& a, const Quaterniond& b) {
  return 2.0 * (a.conjugate() * b).vec().norm();
}

/// sn, cn and dn by arithmetic-geometric means (Abramowitz and Stegun 16.4).
std::array<double, 3> jacobi(double u, double modulus) {
  std::array<double, 12> a{}, c{};
  a[0] = 1.0;
  c[0] = modulus;
  double b = std::sqrt((1.0 - modulus) * (1.0 + modulus));
  std::size_t n = 0;
  for (; std::abs(c[n]) > 1.0e-17 && n + 1 < a.size(); ++n) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
  }
  double phi = std::ldexp(a[n] * u, static_cast<int>(n)), before = phi;
  for (; n > 0; --n) {
    before = phi;
    phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  }
  const double sn = std::sin(phi), cn = std::cos(phi);
  const bool quarter = std::abs(std::cos(before - phi)) < 0.1;
  return {sn, cn,
          quarter ? std::sqrt(1.0 - modulus * modulus * sn * sn) : cn / std::cos(before - phi)};
}

/// A body with I1 < I2 < I3 that turns about a direction near the third axis (Landau and Lifshitz,
/// Mechanics, section 37): w = (w1 cn, w2 sn, w3 dn)(p t).
struct Asymmetric {
  Vector3d inertia;
  double w1 = 0.0, w3 = 0.0;  // of the start, when w2 = 0

  double momentum() const { return std::hypot(inertia(0) * w1, inertia(2) * w3); }
  double twice_energy() const { return inertia(0) * w1 * w1 + inertia(2) * w3 * w3; }
  double over() const { return momentum() * momentum() - twice_energy() * inertia(0); }
  double under() const { return inertia(0) * (inertia(2) - inertia(0)) * w1 * w1; }
  double rate() const { return std::sqrt((inertia(2) - inertia(1)) * over() / inertia.prod()); }
  double modulus() const {
    return std::sqrt((inertia(1) - inertia(0)) * under() / ((inertia(2) - inertia(1)) * over()));
  }
  double period() const { return 4.0 * std::comp_ellint_1(modulus()) / rate(); }
  Vector3d velocity(double time) const {
    const auto [sn, cn, dn] = jacobi(rate() * time, modulus());
    const double w2 = std::sqrt(under() / (inertia(1) * (inertia(2) - inertia(1))));
    return {w1 * cn, w2 * sn, w3 * dn};
  }
  /// Angle about the angular momentum after a period, when the momentum is back in the body.
  double angle_of_period() const {
    const double i1 = inertia(0), i2 = inertia(1), i3 = inertia(2);
    const double n = i3 * (i2 - i1) / (i1 * (i3 - i2));
    return momentum() / i3 *
           (period() + (i3 - i1) / i1 * 4.0 / rate() * std::comp_ellint_3(modulus(), -n));
  }
  Vector3d start() const { return inertia.cwiseProduct(Vector3d(w1, 0.0, w3)); }
};

/// Independent integration of angular velocity and attitude: the classical rule of fourth order, in
/// numbers of 64 binary digits.
struct LongRotation {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  using Quaternion = Eigen::Quaternion<long double>;
  Vector inertia, velocity;
  Quaternion attitude = Quaternion::Identity();

  void rates(const Vector& w, const Quaternion& q, Vector& dw, Quaternion& dq) const {
    const Vector momentum = inertia.cwiseProduct(w);
    dw = momentum.cross(w).cwiseQuotient(inertia);
    dq = q * Quaternion(0.0L, 0.5L * w(0), 0.5L * w(1), 0.5L * w(2));
  }
  void advance(long double time, int steps) {
    const long double h = time / steps;
    for (int k = 0; k < steps; ++k) {
      std::array<Vector, 4> dw;
      std::array<Quaternion, 4> dq;
      rates(velocity, attitude, dw[0], dq[0]);
      for (std::size_t s = 1; s < 4; ++s) {
        const long double part = s == 3 ? h : 0.5L * h;
        Quaternion q;
        q.coeffs() = attitude.coeffs() + part * dq[s - 1].coeffs();
        rates(Vector(velocity + part * dw[s - 1]), q, dw[s], dq[s]);
      }
      velocity += h / 6.0L * (dw[0] + 2.0L * (dw[1] + dw[2]) + dw[3]);
      attitude.coeffs() +=
          h / 6.0L * (dq[0].coeffs() + 2.0L * (dq[1].coeffs() + dq[2].coeffs()) + dq[3].coeffs());
    }
  }
};

struct Case {
  std::string name;
  Vector3d inertia, momentum;
};

const std::array<Case, 8> cases = {{
    {"asymmetric", {1.0, 2.0, 2.5}, {0.7, -0.4, 1.1}},
    {"long top", {0.1, 2.0, 2.0}, {0.2, 1.0, -0.6}},
    {"flat top", {1.0, 1.0, 1.9}, {0.5, 0.5, 1.0}},
    {"sphere", {1.5, 1.5, 1.5}, {1.0, 2.0, -0.5}},
    {"plate", {1.0, 2.0, 3.0}, {0.3, 2.0, 0.1}},
    {"intermediate axis", {1.0, 2.0, 2.5}, {1.0e-4, 3.0, 1.0e-4}},
    {"separatrix", {1.0, 2.0, 3.0}, {1.0, 0.0, std::sqrt(3.0)}},
    {"principal axis", {1.0, 2.0, 2.5}, {0.0, 0.0, 2.0}},
}};

TEST(FreeRotation, InOneStepIsThatInAThousand) {
  for (const Case& c : cases) {
    const FreeRotation rotation(second_moments(c.inertia));
    const double time = 10.0;
    const Quaterniond once = rotation.turn(c.momentum, time);
    Quaterniond many = Quaterniond::Identity();
    for (int k = 0; k < 1000; ++k)
      many = (many * rotation.turn(many.conjugate() * c.momentum, time / 1000)).normalized();
    // A thousand roundings, which the exponential of the rate of the unstable axis enlarges:
    // sqrt((I2 - I1)(I3 - I2)/(I1 I3)) w2, of at most 0.45 * 1.5 per unit of time, reached by
    // "intermediate axis", where it lasts as long as the axis is near the momentum.
    const double growth = c.name == "intermediate axis" ? std::exp(0.45 * 1.5 * time) : 10.0;
    EXPECT_LT(distance(once, many), roundoff(1000.0 * growth, 1.0)) << c.name;
    // Back in time it returns, by the same bound.
    const Quaterniond back = rotation.turn(once.conjugate() * c.momentum, -time);
    EXPECT_LT(distance(once * back, Quaterniond::Identity()), roundoff(1000.0 * growth, 1.0))
        << c.name;
  }
}

TEST(FreeRotation, OfABodyThatDoesNotTurnIsNone) {
  const FreeRotation rotation(Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(rotation.turn(Vector3d::Zero(), 1.0e9).coeffs(), Quaterniond::Identity().coeffs());
  EXPECT_EQ(rotation.turn(Vector3d(1.0, 2.0, 3.0), 0.0).coeffs(), Quaterniond::Identity().coeffs());
}

TEST(FreeRotation, OfATopIsPrecessionAndSpin) {
  // L/I1 about the momentum, and w3 (1 - I3/I1) about the axis. The attitude of a long top tells
  // w3 to L/I3 = 9 roundings, made anew in 4 series a radian: at random over 300 rad this changes
  // w3 by 35 * 9 of them, which turn the body for 100 s.
  const double time = 100.0;
  for (const Vector3d& inertia :
       {Vector3d(1.0, 1.0, 1.9), Vector3d(2.0, 2.0, 0.1), Vector3d(1.5, 1.5, 1.5)}) {
    const Vector3d momentum(0.5, -0.7, 0.3);
    const FreeRotation rotation(second_moments(inertia));
    const Quaterniond exact =
        turn_about(momentum, momentum.norm() / inertia(0) * time) *
        turn_about(Vector3d::UnitZ(), momentum(2) * (1.0 / inertia(2) - 1.0 / inertia(0)) * time);
    EXPECT_LT(distance(rotation.turn(momentum, time), exact), roundoff(1.0e5, 1.0));
  }
}

TEST(FreeRotation, OfAnAsymmetricBodyIsJacobis) {
  // About the third axis, slightly and widely; near the separatrix at last (k = 0.9999998).
  for (const double w1 : {0.01, 0.5, 1.1, 1.224744}) {
    const Asymmetric body{{1.0, 2.0, 3.0}, w1, std::sqrt(0.5)};
    ASSERT_LT(body.modulus(), 1.0);
    const FreeRotation rotation(second_moments(body.inertia));
    // Near the separatrix the motion is as sensitive as the modulus: k' below 1e-3 loses 6 digits.
    const double lost = 1.0 / (1.0 - body.modulus() * body.modulus());
    for (const double part : {0.1, 0.25, 0.6, 1.0, 3.3}) {
      const double time = part * body.period();
      const Quaterniond turn = rotation.turn(body.start(), time);
      const Vector3d velocity =
          Vector3d(turn.conjugate() * body.start()).cwiseQuotient(body.inertia);
      EXPECT_LT((velocity - body.velocity(time)).norm(), roundoff(200.0 * lost, 1.0))
          << w1 << " " << part;
    }
    // The attitude of a period is a turn about the momentum.
    const Quaterniond period = rotation.turn(body.start(), body.period());
    EXPECT_LT(distance(period, turn_about(body.start(), body.angle_of_period())),
              roundoff(400.0 * lost, 1.0))
        << w1;
  }
}

TEST(FreeRotation, OnTheSeparatrixIsHyperbolic) {
  // M^2 = 2 E I2: the body turns over once, w2 = w tanh(s t), and the others are as 1/cosh(s t).
  const Vector3d inertia(1.0, 2.0, 3.0);
  const double w = 1.0, rate = w * std::sqrt(1.0 / 3.0);
  // From M^2 = 4 w^2 and 2 E = 2 w^2 at w2 = 0: w1^2 + 3 w3^2 = 2, w1^2 + 9 w3^2 = 4.
  const Vector3d start(1.0, 0.0, 3.0 * std::sqrt(1.0 / 3.0));
  const FreeRotation rotation(second_moments(inertia));
  for (const double time : {0.1, 1.0, 3.0, 10.0}) {
    const Quaterniond turn = rotation.turn(start, time);
    const Vector3d velocity = Vector3d(turn.conjugate() * start).cwiseQuotient(inertia);
    const double c = 1.0 / std::cosh(rate * time);
    const Vector3d exact(c, w * std::tanh(rate * time), c * std::sqrt(1.0 / 3.0));
    // The axis is left again as exp(rate t): round-off of the start grows by that.
    EXPECT_LT((velocity - exact).norm(), roundoff(100.0 * std::exp(rate * time), 1.0)) << time;
  }
}

TEST(FreeRotation, AboutTheIntermediateAxisIsThatOfAnIndependentIntegration) {
  // The body turns over within these 20 s. The rule's error is (1.5e-4)^4/120 of 30 rad, 1e-16.
  // Round-off of the 1.5e-3 by which the axis is missed at the start moves the time of turning over
  // by 1e3 roundings, and 120 series add theirs.
  const double time = 20.0;
  const Vector3d inertia = cases[5].inertia;
  const Vector3d momentum(1.0e-3, 3.0, 1.0e-3);
  LongRotation reference{inertia.cast<long double>(),
                         momentum.cwiseQuotient(inertia).cast<long double>()};
  reference.advance(time, 200000);
  const FreeRotation rotation(second_moments(inertia));
  const Quaterniond turn = rotation.turn(momentum, time);
  EXPECT_LT(distance(turn, reference.attitude.cast<double>()), roundoff(1.0e3 * 120.0, 1.0));
  // It has turned over in between.
  bool over = false;
  Quaterniond q = Quaterniond::Identity();
  for (int k = 0; k < 200; ++k) {
    q = q * rotation.turn(q.conjugate() * momentum, 0.1);
    over = over || (q.conjugate() * momentum)(1) < -2.9;
  }
  EXPECT_TRUE(over);
}

TEST(FreeRotation, KeepsItsEnergyOver100000Steps) {
  for (const Case& c : cases) {
    const FreeRotation rotation(second_moments(c.inertia));
    Quaterniond q = Quaterniond::Identity();
    const auto energy = [&] {
      const Vector3d m = q.conjugate() * c.momentum;
      return 0.5 * m.dot(m.cwiseQuotient(c.inertia));
    };
    const double before = energy();
    double drift = 0.0;
    for (int k = 0; k < 100000; ++k) {
      q = (q * rotation.turn(q.conjugate() * c.momentum, 0.01)).normalized();
      drift = std::max(drift, std::abs(energy() - before));
    }
    // Nothing is conserved by force: a rounding of the attitude in each step, all of one sign at
    // worst. A direction that is known to one rounding has an energy known to I_max/I_min of them.
    const double ratio = c.inertia.maxCoeff() / c.inertia.minCoeff();
    EXPECT_LT(drift, roundoff(100000.0 * ratio, before)) << c.name;
  }
}

}  // namespace
}  // namespace abut::rigid_free_rotation_tests
