#pragma once

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// What all laws here have in common: a density and two moduli at the undeformed state.
class IsotropicMaterial : public Material {
 public:
  /// Throws InputError, with the key's name as `where`, unless all three are positive and finite.
  IsotropicMaterial(const Moduli& moduli, double density);  // [Pa], [kg/m^3]

  double density() const final { return density_; }
  Moduli moduli() const final { return moduli_; }

 protected:
  double bulk() const { return moduli_.bulk; }
  double shear() const { return moduli_.shear; }

 private:
  Moduli moduli_;
  double density_;
};

/// Whether every number of an answer is finite: the last check of every law.
bool is_finite(const PointResponse& answer, Need want);

}  // namespace abut
