#pragma once

#include <optional>

#include "subdomain_solver/materials/isotropic.hpp"

namespace abut {

struct PrincipalModulus;

/// The part of hardening that saturates (Voce).
struct Saturation {
  double stress = 0.0;  // [Pa] at least the yield stress: what hardening tends to
  double rate = 0.0;    // [1] positive: over a plastic strain of 1/rate
};

/// Yield stress over the equivalent plastic strain a, linear plus Voce [M.36]:
/// s(a) = yield + modulus a + (saturation - yield)(1 - exp(-rate a)), of the Kirchhoff stress.
struct Hardening {
  double yield_stress = 0.0;  // [Pa] positive
  double modulus = 0.0;       // [Pa] not negative
  std::optional<Saturation> saturation;

  double stress(double a) const;  // s(a) [Pa]
  double slope(double a) const;   // ds/da [Pa]
  double stored(double a) const;  // integral of s - yield_stress from 0 to a [J/m^3]
};

/// J2 plasticity at finite strain [M.36]: F = F_e F_p, Hencky elasticity, exponential return map
/// (Simo 1992; de Souza Neto, Peric, Owen 2008, chapter 14), isotropic hardening.
///
/// History: the inverse plastic right Cauchy-Green tensor minus I (xx yy zz xy yz zx), then the
/// equivalent plastic strain. Energy: elastic energy and what hardening stores; dissipation: yield
/// stress times the increment of plastic strain. With that split P is the gradient of their sum
/// also while the point yields, and the consistent tangent is symmetric.
class J2Plasticity final : public IsotropicMaterial {
 public:
  /// Throws InputError, with the key's name as `where`, when a number is inadmissible.
  J2Plasticity(const Moduli& moduli, const Hardening& hardening, double density);

  const Hardening& hardening() const { return hardening_; }
  int history_size() const override { return 7; }
  std::vector<NamedHistory> named_history() const override {
    return {{"equivalent_plastic_strain", 6}};
  }
  [[nodiscard]] bool evaluate(const Matrix3& f, std::span<const double> before,
                              std::span<double> after, Need want,
                              PointResponse& out) const override;

 private:
  struct Return;
  [[nodiscard]] bool return_to_surface(Return& r) const;
  PrincipalModulus modulus(const Return& r) const;

  Hardening hardening_;
};

}  // namespace abut
