// Goal: contact of surfaces takes the kernel of a body whose forces are constant in substeps, too.
// Oracle: the motion of such a body, which sums up its responses to the impulses that it takes.
#include "coordinator/coupling/kernel_support.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "contract/force_means.hpp"
#include "tests/support/scripted.hpp"

namespace abut::coupling_kernel_support_tests {
namespace {

constexpr int steps = 7, width = 3;

std::vector<double> numbers(std::size_t count, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  std::vector<double> out(count);
  for (double& value : out) value = any(random);
  return out;
}

PortKernel for_substeps(std::mt19937& random) {
  PortKernel kernel;
  kernel.step = 0.1;
  kernel.support = ForceSupport::step;
  kernel.patterns = kernel.width = width;
  kernel.displacement = numbers(steps * width * width, random);
  return kernel;
}

/// Sum of the responses to forces (steps, width), each in its substep.
double moved(const PortKernel& kernel, const std::vector<double>& forces, int step, int at) {
  double sum = 0.0;
  for (int j = 0; j <= step; ++j)
    for (int p = 0; p < width; ++p)
      sum += forces[j * width + p] *
             kernel.displacement[((step - j) * width + p) * width + at];
  return sum;
}

TEST(KernelSupport, OfForcesAtLevelsIsTheMotionUnderTheirImpulsesInSubsteps) {
  for (const ForceSupport support : {ForceSupport::linear, ForceSupport::nodal}) {
    std::mt19937 random(11);
    const PortKernel own = for_substeps(random), levels = for_levels(own);
    EXPECT_EQ(levels.support, ForceSupport::nodal);
    ASSERT_EQ(levels.begin.size(), own.displacement.size());
    Waveform force(width);
    force.support = support;
    force.time = levels_of(Substeps::divide(0.0, 0.7, 0.1));
    force.f = numbers((steps + 1) * width, random);
    std::vector<double> means;  // over substeps, as the body takes them
    for (int i = 1; i <= steps; ++i) {
      const double from = force.time[i - 1], to = force.time[i];
      std::vector<double> impulse(width);
      force.impulse(from, to, impulse);
      for (const double value : impulse) means.push_back(value / (to - from));
    }
    for (int i = 0; i < steps; ++i) {
      for (int at = 0; at < width; ++at) {
        double told = 0.0;
        for (int p = 0; p < width; ++p) {
          const auto place = [&](int lag) { return index((lag * width + p) * width + at); };
          told += force.f[p] * levels.begin[place(i)];
          for (int j = 0; j <= i; ++j)
            told += force.f[(j + 1) * width + p] * levels.displacement[place(i - j)];
        }
        EXPECT_NEAR(told, moved(own, means, i, at), 1.0e-13) << i << ' ' << at;  // sums of 48
      }
    }
  }
}

TEST(KernelSupport, OfLevelsStaysAsItIs) {
  std::mt19937 random(5);
  PortKernel kernel = for_substeps(random);
  kernel.support = ForceSupport::nodal;
  kernel.begin = numbers(kernel.displacement.size(), random);
  const PortKernel same = for_levels(kernel);
  EXPECT_EQ(same.displacement, kernel.displacement);
  EXPECT_EQ(same.begin, kernel.begin);
}

class Refusing final : public Scripted {
 public:
  using Scripted::Scripted;
  void meet(const Meeting&) override {
    throw RunError("gives way by a kernel that this body cannot take", "here", "Do.");
  }
};

TEST(KernelSupport, OfWhatIsRefusedBothBodiesAreNamed) {
  Refusing finder(0.0, 1.0, 0.1);
  Scripted other(1.0, -1.0, 0.1);
  finder.description_.name = "finder";
  other.description_.name = "other";
  Bodies bodies({&finder, &other}, 1.0);
  try {
    bodies.meet({0, 0}, 0, {1, 0}, PortKernel{});
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_EQ(error.what_is_wrong,
              "gives way by a kernel that this body cannot take (body 'finder', told how body "
              "'other' gives way)");
  }
}

}  // namespace
}  // namespace abut::coupling_kernel_support_tests
