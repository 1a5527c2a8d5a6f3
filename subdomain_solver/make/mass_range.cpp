#include "subdomain_solver/make/mass_range.hpp"

#include <fmt/format.h>

namespace abut {

void check_mass(double lightest, double heaviest, const BodySpec& spec, const Place& place) {
  constexpr double least = 1e-200, most = 1e200;
  if (lightest >= least && heaviest <= most) return;
  const std::string law =
      std::visit([](const auto& s) { return std::string(s.name); }, *spec.material);
  throw InputError(
      fmt::format("gives a node the mass of {:g} kg, which is not between {:g} and {:g}",
                  lightest >= least ? heaviest : lightest, least, most),
      place.where("material." + law + ".density"),
      "Give density and lengths in one consistent set of units, in which they are of ordinary "
      "size.");
}

}  // namespace abut
