#pragma once

#include <optional>

namespace abut {

/// Small-strain moduli of an isotropic solid [Pa].
struct Moduli {
  double bulk = 0.0, shear = 0.0;
  double p_wave() const { return bulk + 4.0 / 3.0 * shear; }
  double youngs() const;                                    // E
  double poissons_ratio() const;                            // nu [1]
  double lame() const { return bulk - 2.0 / 3.0 * shear; }  // lambda
};

/// The constants by which data sheets give an isotropic solid; two of them say it all.
struct ElasticConstants {
  std::optional<double> youngs_modulus;  // E [Pa]
  std::optional<double> poissons_ratio;  // nu [1]
  std::optional<double> bulk_modulus;    // kappa [Pa]
  std::optional<double> lame_modulus;    // lambda [Pa]
  std::optional<double> shear_modulus;   // mu [Pa]
};

/// Moduli from any two constants [M.30]. Throws InputError (its `where` is the constant's name)
/// unless exactly two are given and the bulk and shear modulus that follow are positive and finite.
Moduli moduli_of(const ElasticConstants& constants);

/// Whether what follows from the moduli (P-wave modulus, E, lambda) is finite: numbers at the end
/// of their range do not give it.
bool has_derived(const Moduli& moduli);

/// Throws InputError, with `where` = `name`, unless the value is positive and finite.
void require_positive(double value, const char* name, const char* unit);

}  // namespace abut
