#include "subdomain_solver/make/integrator_spec.hpp"

#include <fmt/format.h>

namespace abut {

namespace {

constexpr std::string_view step_help = "body's own time step; several fit into a controller window";

void mass_key(Fields& f, MassForm& mass) {
  f.word(
      "mass", mass, {"lumped", "averaged", "consistent"},
      "mass matrix; averaged is the mean of the other two with a third of their dispersion error");
}

}  // namespace

void CentralDifferenceSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  f.optional(
      "dispersion_terms", dispersion_terms, "",
      "number of terms that correct the dispersion of the lumped bar; 1 is the plain scheme, 2 "
      "equals the averaged mass to leading order; each term costs one more internal force",
      between(1, 30));
  f.optional("bulk_viscosity", bulk_viscosity, "",
             "linear bulk viscosity, as the damping ratio of the shortest wave; lowers the stable "
             "step",
             between(0.0, 1.0));
  f.optional("tchamwa", tchamwa, "",
             "parameter phi of Tchamwa and Wielgosz, which damps short waves most; 1 dissipates "
             "nothing; lowers the stable step",
             between(1.0, 2.0));
  f.word(
      "above_limit", clamp, {"refuse", "clamp"},
      "answer to a step of a solid above its stable limit, at the begin or once strain has lowered "
      "it: refuse, or take equal parts of it of at most 0.95 of the limit");
  f.check(tchamwa == 1.0 || (dispersion_terms == 1 && bulk_viscosity == 0.0), "tchamwa",
          fmt::format("is {:g} beside dispersion terms or bulk viscosity", tchamwa),
          "Choose one of them: what they do together has no known stable step.");
}

void NewmarkSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  f.optional("beta", beta, "", "Newmark's beta", between(0.25, 1.0));
  f.optional("gamma", gamma, "", "Newmark's gamma", between(0.5, 1.0));
  f.check(2.0 * beta >= gamma, "beta",
          fmt::format("is {:g}, below gamma/2 = {:g}", beta, 0.5 * gamma),
          "Give beta at least gamma/2: below it the scheme is only conditionally stable.");
  mass_key(f, mass);
}

void HhtAlphaSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  f.optional("alpha", alpha, "", "HHT parameter; 0 is the trapezoidal rule",
             between(-1.0 / 3.0, 0.0));
  mass_key(f, mass);
}

void GeneralizedAlphaSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  f.optional("spectral_radius", spectral_radius, "",
             "spectral radius at infinite frequency; 1 dissipates nothing, 0 annihilates it",
             between(0.0, 1.0));
  mass_key(f, mass);
}

void QuasiStaticSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  f.optional("halvings", halvings, "",
             "number of times that a step may be halved where Newton's method fails",
             between(0, 30));
}

void RigidMotionSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  mass_key(f, mass);
}

void BackwardEulerSpec::fields(Fields& f) {
  f.required("step", step, "s", step_help, positive);
  mass_key(f, mass);
}

}  // namespace abut
