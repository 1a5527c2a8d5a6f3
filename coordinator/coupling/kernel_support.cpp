#include "coordinator/coupling/kernel_support.hpp"

#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace abut {

PortKernel for_levels(PortKernel kernel) {
  if (kernel.support != ForceSupport::step) return kernel;
  kernel.support = ForceSupport::nodal;
  std::vector<double>& told = kernel.displacement;
  kernel.begin = told;
  for (double& response : kernel.begin) response *= 0.5;
  const std::size_t each = kernel.per_step();
  for (std::size_t v = told.size(); v-- > 0;)
    told[v] = kernel.begin[v] + (v >= each ? kernel.begin[v - each] : 0.0);
  return kernel;
}

void require_for_substeps(const PortKernel& kernel, const Side& pressed, const Side& by,
                          const Bodies& bodies) {
  if (kernel.support == ForceSupport::step || bodies.port(pressed).geometry.dim == 1) return;
  const auto name = [&bodies](const Side& side) {
    return bodies.describe(side.body).name + '.' + bodies.port(side).name;
  };
  throw RunError(
      fmt::format("{} is tied to {}, by forces that are constant in substeps, but tells its port "
                  "kernel for others (NODAL, where STEP belongs)",
                  name(pressed), name(by)),
      "", "let the solver of this body answer probes of tied ports with support STEP");
}

}  // namespace abut
