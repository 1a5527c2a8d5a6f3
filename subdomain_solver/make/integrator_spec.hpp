#pragma once

#include <optional>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "base/fields.hpp"
#include "subdomain_solver/make/stabilisation_spec.hpp"
#include "subdomain_solver/mass_form.hpp"

namespace abut {

// What a scene says of time integrators. Each struct is all that the makers know of a scheme: its
// name, its kind, its keys and what they mean.

/// What the rest of a body asks of its scheme.
enum class SchemeKind : char {
  explicit_steps,  // no equations are solved, and steps have a stable limit
  implicit_steps,
  statics,  // no inertia: every step is an equilibrium
  exact     // of free motion: nothing deforms
};

constexpr std::string_view step_help = "body's own time step; several fit into a controller window";

inline void mass_key(Fields& f, MassForm& mass) {
  f.word(
      "mass", mass, {"lumped", "averaged", "consistent"},
      "mass matrix; averaged is the mean of the other two with a third of their dispersion error");
}

struct CentralDifferenceSpec {
  static constexpr std::string_view name = "central_difference";
  static constexpr SchemeKind kind = SchemeKind::explicit_steps;
  double step = 0.0;  // [s]
  int dispersion_terms = 1;
  double bulk_viscosity = 0.0;
  bool clamp = false;  // "above_limit: refuse | clamp"
  double tchamwa = 1.0;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    f.optional(
        "dispersion_terms", dispersion_terms, "",
        "number of terms that correct the dispersion of the lumped bar; 1 is the plain scheme, 2 "
        "equals the averaged mass to leading order; each term costs one more internal force",
        between(1, 30));
    f.optional("bulk_viscosity", bulk_viscosity, "",
               "linear bulk viscosity, as the damping ratio of the shortest wave; lowers the "
               "stable step",
               between(0.0, 1.0));
    f.optional("tchamwa", tchamwa, "",
               "parameter phi of Tchamwa and Wielgosz, which damps short waves most; 1 dissipates "
               "nothing; lowers the stable step",
               between(1.0, 2.0));
    f.word("above_limit", clamp, {"refuse", "clamp"},
           "answer to a step of a solid above its stable limit, at the begin or once strain has "
           "lowered it: refuse, or take equal parts of it of at most 0.95 of the limit");
    f.check(tchamwa == 1.0 || (dispersion_terms == 1 && bulk_viscosity == 0.0), "tchamwa",
            fmt::format("is {:g} beside dispersion terms or bulk viscosity", tchamwa),
            "Choose one of them: what they do together has no known stable step.");
  }
};
struct NewmarkSpec {
  static constexpr std::string_view name = "newmark";
  static constexpr SchemeKind kind = SchemeKind::implicit_steps;
  double step = 0.0, beta = 0.25, gamma = 0.5;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    f.optional("beta", beta, "", "Newmark's beta", between(0.25, 1.0));
    f.optional("gamma", gamma, "", "Newmark's gamma", between(0.5, 1.0));
    f.check(2.0 * beta >= gamma, "beta",
            fmt::format("is {:g}, below gamma/2 = {:g}", beta, 0.5 * gamma),
            "Give beta at least gamma/2: below it the scheme is only conditionally stable.");
    mass_key(f, mass);
  }
};
struct HhtAlphaSpec {
  static constexpr std::string_view name = "hht_alpha";
  static constexpr SchemeKind kind = SchemeKind::implicit_steps;
  double step = 0.0, alpha = -0.05;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    f.optional("alpha", alpha, "", "HHT parameter; 0 is the trapezoidal rule",
               between(-1.0 / 3.0, 0.0));
    mass_key(f, mass);
  }
};
struct GeneralizedAlphaSpec {
  static constexpr std::string_view name = "generalized_alpha";
  static constexpr SchemeKind kind = SchemeKind::implicit_steps;
  double step = 0.0, spectral_radius = 0.9;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    f.optional("spectral_radius", spectral_radius, "",
               "spectral radius at infinite frequency; 1 dissipates nothing, 0 annihilates it",
               between(0.0, 1.0));
    mass_key(f, mass);
  }
};

struct QuasiStaticSpec {  // of solids only
  static constexpr std::string_view name = "quasi_static";
  static constexpr SchemeKind kind = SchemeKind::statics;
  double step = 0.0;
  int halvings = 8;
  std::optional<StabilisationSpec> stabilisation;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    f.optional("halvings", halvings, "",
               "number of times that a step may be halved where Newton's method fails",
               between(0, 30));
    f.optional_section("stabilisation", stabilisation,
                       "what holds a body as a whole until contact does; absent: the same with its "
                       "defaults, where constraints and ties leave the body free");
  }
};
struct RigidMotionSpec {  // of rigid bodies only
  static constexpr std::string_view name = "rigid_motion";
  static constexpr SchemeKind kind = SchemeKind::exact;
  double step = 0.0;
  MassForm mass = MassForm::consistent;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    mass_key(f, mass);
  }
};
struct BackwardEulerSpec {  // of bar pairs only
  static constexpr std::string_view name = "backward_euler";
  static constexpr SchemeKind kind = SchemeKind::implicit_steps;
  double step = 0.0;
  MassForm mass = MassForm::averaged;
  void fields(Fields& f) {
    f.required("step", step, "s", step_help, positive);
    mass_key(f, mass);
  }
};

/// All there are. Makers refuse those for which they have no branch.
using IntegratorSpec =
    std::variant<CentralDifferenceSpec, NewmarkSpec, HhtAlphaSpec, GeneralizedAlphaSpec,
                 QuasiStaticSpec, RigidMotionSpec, BackwardEulerSpec>;

}  // namespace abut
