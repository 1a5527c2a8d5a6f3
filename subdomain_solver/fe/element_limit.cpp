#include "subdomain_solver/fe/element_limit.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/machine_memory.hpp"

namespace abut {

void require_room(double elements, double bytes, const std::string& where) {
  constexpr double most = 2e8;  // hex20 has 4 nodes per cell, and node numbers have 32 bits
  constexpr const char* remedy = "Make the mesh coarser.";
  if (!(elements <= most)) {
    throw InputError(fmt::format("asks for {:.3g} elements, more than {:.3g}", elements, most),
                     where, remedy);
  }
  constexpr double gigabyte = 1e9;
  const double there = machine_memory();
  if (elements * bytes > there) {
    throw InputError(
        fmt::format("asks for {:.3g} elements, which take {:.1f} GB or more, and there are {:.1f}",
                    elements, elements * bytes / gigabyte, there / gigabyte),
        where, remedy);
  }
}

}  // namespace abut
