#include "subdomain_solver/materials/moduli.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/error.hpp"

namespace abut {

double Moduli::youngs() const { return 9.0 * bulk * shear / (3.0 * bulk + shear); }

double Moduli::poissons_ratio() const {
  return (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
}

namespace {

Moduli of_youngs_lame(double e, double lambda) {
  const double r = std::sqrt(e * e + 9.0 * lambda * lambda + 2.0 * e * lambda);
  // Each modulus is a sum that cancels for one sign of lambda; its conjugate form does not.
  const double shear =
      lambda > 0.0 ? 2.0 * e * lambda / (r + 3.0 * lambda - e) : (r - 3.0 * lambda + e) / 4.0;
  const double bulk = lambda < 0.0 ? -2.0 / 3.0 * e * lambda / (r - 3.0 * lambda - e)
                                   : (r + 3.0 * lambda + e) / 6.0;
  return {bulk, shear};
}

/// The pairs in which nu is one constant.
Moduli of_poissons_ratio(const ElasticConstants& c) {
  const double nu = *c.poissons_ratio;
  if (c.youngs_modulus)
    return {*c.youngs_modulus / (3.0 * (1.0 - 2.0 * nu)), *c.youngs_modulus / (2.0 * (1.0 + nu))};
  if (c.bulk_modulus)
    return {*c.bulk_modulus, 1.5 * *c.bulk_modulus * (1.0 - 2.0 * nu) / (1.0 + nu)};
  if (c.lame_modulus)
    return {*c.lame_modulus * (1.0 + nu) / (3.0 * nu),
            *c.lame_modulus * (1.0 - 2.0 * nu) / (2.0 * nu)};
  return {2.0 / 3.0 * *c.shear_modulus * (1.0 + nu) / (1.0 - 2.0 * nu), *c.shear_modulus};
}

Moduli of_two(const ElasticConstants& c) {
  if (c.poissons_ratio) return of_poissons_ratio(c);
  if (c.bulk_modulus && c.shear_modulus) return {*c.bulk_modulus, *c.shear_modulus};
  if (c.bulk_modulus && c.lame_modulus)
    return {*c.bulk_modulus, 1.5 * (*c.bulk_modulus - *c.lame_modulus)};
  if (c.lame_modulus && c.shear_modulus)
    return {*c.lame_modulus + 2.0 / 3.0 * *c.shear_modulus, *c.shear_modulus};
  const double e = *c.youngs_modulus;
  if (c.lame_modulus) return of_youngs_lame(e, *c.lame_modulus);
  if (c.bulk_modulus)
    return {*c.bulk_modulus, 3.0 * *c.bulk_modulus * e / (9.0 * *c.bulk_modulus - e)};
  return {e * *c.shear_modulus / (3.0 * (3.0 * *c.shear_modulus - e)), *c.shear_modulus};
}

}  // namespace

bool has_derived(const Moduli& m) {
  const bool product = m.youngs() > 0.0 && std::isfinite(m.youngs());  // of two moduli
  return product && std::isfinite(m.p_wave()) && std::isfinite(m.lame()) &&
         std::isfinite(m.poissons_ratio());
}

Moduli moduli_of(const ElasticConstants& c) {
  int count = 0;
  std::string given;
  const auto note = [&count, &given](const std::optional<double>& value, const char* name) {
    if (!value) return;
    given += fmt::format("{}{} = {}", count == 0 ? "" : ", ", name, *value);
    ++count;
  };
  note(c.youngs_modulus, "youngs_modulus");
  note(c.poissons_ratio, "poissons_ratio");
  note(c.bulk_modulus, "bulk_modulus");
  note(c.lame_modulus, "lame_modulus");
  note(c.shear_modulus, "shear_modulus");
  if (count != 2)
    throw InputError(fmt::format("an isotropic solid has two elastic constants, but {} are given",
                                 count == 0 ? "none" : given),
                     "",
                     "Give exactly two of youngs_modulus, poissons_ratio, bulk_modulus, "
                     "lame_modulus, shear_modulus");
  const Moduli m = of_two(c);
  const bool admissible = m.bulk > 0.0 && m.shear > 0.0 && has_derived(m);
  if (!admissible)
    throw InputError(fmt::format("{} give a bulk modulus of {:.6g} Pa and a shear modulus of "
                                 "{:.6g} Pa; both must be positive and finite",
                                 given, m.bulk, m.shear),
                     "",
                     "Correct one of the two: Young's modulus is positive and Poisson's ratio lies "
                     "between -1 and 0.5, both excluded");
  return m;
}

void require_positive(double value, const char* name, const char* unit) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError(fmt::format("must be positive and finite, but is {} {}", value, unit), name,
                   "Give a positive number");
}

}  // namespace abut
