#include <array>

#include "subdomain_solver/make/solid_spec.hpp"

namespace abut {

namespace {

/// Of small strains, as these tables are: `{neo_hookean: steel}` is the same under another law.
Preset elastic(std::string_view name, std::string_view modulus, std::string_view poissons_ratio,
               std::string_view density, std::string_view source) {
  return {name,
          LinearElasticSpec::name,
          {{"youngs_modulus", modulus}, {"poissons_ratio", poissons_ratio}, {"density", density}},
          source};
}

}  // namespace

std::span<const Preset> ElasticSpec::presets() {
  static const std::array materials = {
      elastic("steel", "210 GPa", "0.3", "7850 kg/m^3",
              "structural steel: EN 1993-1-1:2005, 3.2.6; EN 1991-1-1:2002, table A.4"),
      elastic("aluminium", "70 GPa", "0.3", "2700 kg/m^3",
              "wrought alloys: EN 1999-1-1:2007, 3.2.5"),
      elastic("titanium", "115.7 GPa", "0.321", "4510 kg/m^3",
              "pure metal: Kaye and Laby, Tables of Physical and Chemical Constants, 16th ed."),
      elastic("copper", "129.8 GPa", "0.343", "8930 kg/m^3", "pure metal: Kaye and Laby, 16th ed."),
      elastic("lead", "16.1 GPa", "0.44", "11340 kg/m^3", "pure metal: Kaye and Laby, 16th ed."),
      elastic("concrete", "33 GPa", "0.2", "2450 kg/m^3",
              "C30/37, uncracked: EN 1992-1-1:2004, table 3.1 and 3.1.3; EN 1991-1-1:2002, table "
              "A.1"),
      elastic("glass", "70 GPa", "0.2", "2500 kg/m^3", "soda lime glass: EN 572-1:2012"),
  };
  return materials;
}

}  // namespace abut
