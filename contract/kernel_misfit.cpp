#include "contract/kernel_misfit.hpp"

#include <cmath>

#include <fmt/format.h>

namespace abut {

namespace {

const char* name_of(ForceSupport support) {
  if (support == ForceSupport::linear) return "linear between times";
  return support == ForceSupport::nodal ? "of dual cells around times" : "constant in substeps";
}

}  // namespace

std::string misfit_of(const PortKernel& kernel, double step, ForceSupport support, int values) {
  constexpr double rounding = 1.0e-9;  // as that of steps in a window
  if (step > 0.0 && !(std::abs(kernel.step - step) <= rounding * step))
    return fmt::format("its steps are {} s, where {} s belong, {:.2g} of it off", kernel.step, step,
                       std::abs(kernel.step / step - 1.0));
  if (kernel.support != support)
    return fmt::format("its forces are {}, where those {} belong", name_of(kernel.support),
                       name_of(support));
  if (values > 0 && (kernel.width != values || kernel.patterns != values))
    return fmt::format("it is of {} patterns of {} values, where {} belong", kernel.patterns,
                       kernel.width, values);
  return {};
}

}  // namespace abut
