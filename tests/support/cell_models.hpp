#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "tests/support/materials.hpp"

namespace abut {

/// Cells that may come in batches, by element, formulation and law.
struct BatchCase {
  std::string element;
  Formulation formulation;
  std::string law;
};

inline void PrintTo(const BatchCase& c, std::ostream* out) {
  const char* names[] = {" full ", " mean_dilatation ", " one_point "};
  *out << c.element << names[static_cast<int>(c.formulation)] << c.law;
}

/// Of the moduli and the hardening of tests, and of unit density; unknown names: neo-Hookean.
inline std::unique_ptr<const Material> law_named(const std::string& name) {
  if (name == "linear_elastic") return std::make_unique<LinearElastic>(test_moduli, 1.0);
  if (name == "saint_venant_kirchhoff")
    return std::make_unique<SaintVenantKirchhoff>(test_moduli, 1.0);
  if (name == "mooney_rivlin")
    return std::make_unique<MooneyRivlin>(MooneyRivlinParameters{0.15, 0.1, test_moduli.bulk, 1.0});
  if (name == "hencky") return std::make_unique<Hencky>(test_moduli, 1.0);
  if (name == "j2_plasticity")
    return std::make_unique<J2Plasticity>(test_moduli, test_hardening(), 1.0);
  return std::make_unique<NeoHookean>(test_moduli, 1.0);
}

/// Coordinates by chance, the same in every run.
inline std::vector<double> displaced(const FeModel& model, double size) {
  DrawTensors draw;
  std::vector<double> q(index(model.dofs()));
  for (double& x : q) x = size * draw.between(-1.0, 1.0);
  return q;
}

}  // namespace abut
