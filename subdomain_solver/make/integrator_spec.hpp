#pragma once

#include <string_view>
#include <variant>

#include "base/fields.hpp"
#include "subdomain_solver/mass_form.hpp"

namespace abut {

// What a scene says of time integrators; each struct lists its keys once.

struct CentralDifferenceSpec {
  static constexpr std::string_view name = "central_difference";
  double step = 0.0;  // [s]
  int dispersion_terms = 1;
  double bulk_viscosity = 0.0;
  bool clamp = false;  // "above_limit: refuse | clamp"
  double tchamwa = 1.0;
  void fields(Fields& f);
};
struct NewmarkSpec {
  static constexpr std::string_view name = "newmark";
  double step = 0.0, beta = 0.25, gamma = 0.5;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f);
};
struct HhtAlphaSpec {
  static constexpr std::string_view name = "hht_alpha";
  double step = 0.0, alpha = -0.05;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f);
};
struct GeneralizedAlphaSpec {
  static constexpr std::string_view name = "generalized_alpha";
  double step = 0.0, spectral_radius = 0.9;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f);
};

struct QuasiStaticSpec {  // of solids only
  static constexpr std::string_view name = "quasi_static";
  double step = 0.0;
  int halvings = 8;
  void fields(Fields& f);
};
struct RigidMotionSpec {  // of rigid bodies only
  static constexpr std::string_view name = "rigid_motion";
  double step = 0.0;
  MassForm mass = MassForm::consistent;
  void fields(Fields& f);
};
struct BackwardEulerSpec {  // of bar pairs only
  static constexpr std::string_view name = "backward_euler";
  double step = 0.0;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f);
};

/// All there are. Makers refuse those for which they have no branch.
using IntegratorSpec =
    std::variant<CentralDifferenceSpec, NewmarkSpec, HhtAlphaSpec, GeneralizedAlphaSpec,
                 QuasiStaticSpec, RigidMotionSpec, BackwardEulerSpec>;

}  // namespace abut
