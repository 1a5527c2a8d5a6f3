#pragma once

#include <optional>
#include <string>

#include "base/units.hpp"

namespace abut {

/// In the units of a scene.
struct DensityAndStiffness {
  double density = 0.0, youngs_modulus = 0.0;  // [kg/m^3] [Pa]
};

/// Why numbers cannot both be meant, in words.
struct MaterialDoubt {
  std::string what, remedy;
};

/// Numbers of no solid, where it is known what they are in (`known`); or the digits of a material
/// that abut knows by name with powers of ten that do not go together. Where units are not known,
/// round numbers and materials of one's own raise no doubt, and neither do the consistent sets that
/// engineers use: m kg s, mm t s, mm kg ms, and so on.
std::optional<MaterialDoubt> material_doubt(const DensityAndStiffness& given,
                                            const UnitSystem& units, bool known);

}  // namespace abut
