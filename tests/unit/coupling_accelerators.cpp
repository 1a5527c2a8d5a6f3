// Goal: accelerators do on affine maps what theory says they do there.
// Oracle: the fixed point of an affine map, known beforehand.

#include <gtest/gtest.h>

#include "coordinator/coupling/accelerator.hpp"
#include "coordinator/coupling/port_jacobian.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::coupling_accelerators_tests {
namespace {

Eigen::VectorXd one(double x) { return Eigen::VectorXd::Constant(1, x); }

/// G(x) = fixed + A (x - fixed): its fixed point is `fixed`.
struct AffineMap {
  Eigen::MatrixXd a;
  Eigen::VectorXd fixed;

  explicit AffineMap(int n, unsigned seed = 3) {
    std::srand(seed);
    a = Eigen::MatrixXd::Random(n, n);
    fixed = Eigen::VectorXd::Random(n);
  }
  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const { return fixed + a * (x - fixed); }
};

Preconditioner relaxed(double factor) { return Preconditioner::number(factor); }
/// Of a joint that nobody asks.
const Inverses none;

TEST(Relaxation, TakesTheGivenShareOfTheResidual) {
  Relaxation half(relaxed(0.5));
  EXPECT_EQ(half.next(one(2.0), one(4.0), none)[0], 3.0);
  Relaxation plain(relaxed(1.0));
  EXPECT_EQ(plain.next(one(2.0), one(4.0), none)[0], 4.0);
}

TEST(Aitken, IsExactAfterTwoStepsOfAScalarAffineMap) {
  for (double slope : {-0.9, -0.5, 0.3}) {  // 1 / (1 - slope) within the limit of 2
    Aitken aitken(relaxed(1.0), 0.4);
    aitken.reset(1);
    auto image = [slope](const Eigen::VectorXd& x) { return one(7.0 + slope * (x[0] - 7.0)); };
    Eigen::VectorXd x = one(1.0);
    for (int step = 0; step < 2; ++step) x = aitken.next(x, image(x), none);
    EXPECT_NEAR(x[0], 7.0, roundoff(20, 7.0)) << slope;
  }
}

TEST(Aitken, KeepsItsFactorWithinTwo) {
  Aitken aitken(relaxed(1.0), 1.0);
  aitken.reset(1);
  aitken.next(one(0.0), one(1.0), none);
  const Eigen::VectorXd x = aitken.next(one(1.0), one(1.0 + 1.0 - 1e-12), none);  // asks for 1e12
  EXPECT_LE(std::abs(x[0] - 1.0), 2.0);
}

TEST(Aitken, EveryWindowStartsFromTheFirstFactor) {
  Aitken aitken(relaxed(1.0), 0.25);
  for (int window = 0; window < 2; ++window) {
    aitken.reset(1);
    EXPECT_EQ(aitken.next(one(0.0), one(4.0), none)[0], 1.0);
    aitken.next(one(1.0), one(3.0), none);
  }
}

TEST(QuasiNewton, ReachesTheFixedPointOfAnAffineMapInOneStepMoreThanItsSize) {
  for (int n : {1, 2, 5, 8}) {
    const AffineMap map(n);
    QuasiNewton newton(relaxed(0.5), 0, 1e-12, 0);
    newton.reset(1);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    for (int step = 0; step < n + 1; ++step) x = newton.next(x, map(x), none);
    // Secants of a random map: its condition, and that of the secants, stays below 1e6 here.
    EXPECT_LT((x - map.fixed).norm(), roundoff(1e6, 1.0)) << n;
  }
}

/// Units of a window grow with what moves in it: secants must not be differences of units.
TEST(QuasiNewton, WeightsThatChangeFromStepToStepLeaveSecantsAsTheyAre) {
  const int n = 5;
  const AffineMap map(n);
  QuasiNewton newton(relaxed(0.5), 0, 1e-12, 0);
  newton.reset(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int step = 0; step < n + 1; ++step) {
    newton.weigh(Eigen::VectorXd::LinSpaced(n, 1.0, 1.0 + step));
    x = newton.next(x, map(x), none);
  }
  EXPECT_LT((x - map.fixed).norm(), roundoff(1e6, 1.0));  // as above
}

TEST(QuasiNewton, AnExactInverseNeedsOneStep) {
  const AffineMap map(6);
  const Eigen::MatrixXd inverse = (Eigen::MatrixXd::Identity(6, 6) - map.a).inverse();
  const Inverses exact{
      .kernels = [&inverse](const Eigen::VectorXd& r) { return Eigen::VectorXd(inverse * r); },
      .relaxed = {}};
  QuasiNewton newton(Preconditioner::kernels(), 5, 1e-7, 1);
  for (int window = 0; window < 3; ++window) {
    newton.reset(1);
    const Eigen::VectorXd start = Eigen::VectorXd::Constant(6, window + 1.0);
    const Eigen::VectorXd x = newton.next(start, map(start), exact);
    EXPECT_LT((x - map.fixed).norm(), roundoff(1e4, 4.0));  // condition of 1 - A below 100
    newton.accept();
  }
}

TEST(QuasiNewton, SecantsOfEarlierWindowsShortenTheNext) {
  const AffineMap map(4);
  QuasiNewton newton(relaxed(0.5), 5, 1e-12, 0);
  newton.reset(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
  for (int step = 0; step < 5; ++step) x = newton.next(x, map(x), none);
  newton.accept();
  newton.reset(1);
  x = Eigen::VectorXd::Constant(4, 3.0);
  x = newton.next(x, map(x), none);  // four secants are known: the whole map
  EXPECT_LT((x - map.fixed).norm(), roundoff(1e6, 3.0));
}

TEST(QuasiNewton, SecantsOfAnotherLayoutAreNotUsed) {
  const AffineMap map(4);
  QuasiNewton newton(relaxed(0.5), 5, 1e-12, 0);
  newton.reset(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(4);
  for (int step = 0; step < 5; ++step) x = newton.next(x, map(x), none);
  newton.accept();
  newton.reset(2);
  x = Eigen::VectorXd::Constant(4, 3.0);
  const Eigen::VectorXd image = map(x);
  EXPECT_LT((newton.next(x, image, none) - (x + 0.5 * (image - x))).norm(), roundoff(10, 3.0));
  newton.reset(3);
  const Eigen::VectorXd longer = Eigen::VectorXd::Zero(7);  // and a vector of another size is fine
  EXPECT_EQ(newton.next(longer, longer, none).norm(), 0.0);
}

TEST(QuasiNewton, ReuseOfNoneForgetsTheLastWindow) {
  const AffineMap map(3);
  QuasiNewton newton(relaxed(0.5), 0, 1e-12, 0);
  newton.reset(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  for (int step = 0; step < 4; ++step) x = newton.next(x, map(x), none);
  newton.accept();
  newton.reset(1);
  x = Eigen::VectorXd::Constant(3, 2.0);
  const Eigen::VectorXd image = map(x);
  EXPECT_LT((newton.next(x, image, none) - (x + 0.5 * (image - x))).norm(), roundoff(10, 2.0));
}

TEST(QuasiNewton, ForgetsSecantsOfThisAndEarlierWindows) {
  const AffineMap map(3);
  QuasiNewton newton(relaxed(0.5), 5, 1e-12, 0);
  newton.reset(1);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  for (int step = 0; step < 4; ++step) x = newton.next(x, map(x), none);
  newton.accept();
  newton.reset(1);
  for (int step = 0; step < 2; ++step) x = newton.next(x, map(x), none);
  newton.forget();
  x = Eigen::VectorXd::Constant(3, 2.0);
  const Eigen::VectorXd image = map(x);
  EXPECT_LT((newton.next(x, image, none) - (x + 0.5 * (image - x))).norm(), roundoff(10, 2.0));
}

TEST(Toeplitz, SolvesWhatTheMatrixMultiplies) {
  const std::vector<double> column = {2.0, -0.5, 0.25, 1.0, 0.0, 0.125};
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, -1.0, 4.0);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(6);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) r[i] += column[i - j] * x[j];
  }
  EXPECT_LT((solve_toeplitz(column, r) - x).norm(), roundoff(60, 4.0));
}

}  // namespace
}  // namespace abut::coupling_accelerators_tests
