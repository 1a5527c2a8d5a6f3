#include "subdomain_solver/make/material.hpp"

#include "base/error.hpp"
#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

namespace abut {

namespace {

Moduli moduli_of(const ElasticSpec& s) {
  return moduli_of(ElasticConstants{s.youngs_modulus, s.poissons_ratio, s.bulk_modulus,
                                    s.lame_modulus, s.shear_modulus});
}

/// Under uniaxial stress and small strain Young's modulus is all that matters: where it stands
/// alone, any Poisson's ratio will do.
LinearElasticSpec of_a_bar(LinearElasticSpec s) {
  const bool alone = s.youngs_modulus && !s.poissons_ratio && !s.bulk_modulus && !s.lame_modulus &&
                     !s.shear_modulus;
  if (alone) s.poissons_ratio = 0.0;
  return s;
}

struct LawMaker {
  using Law = std::unique_ptr<const Material>;

  Law operator()(const LinearElasticSpec& s) const {
    return std::make_unique<LinearElastic>(moduli_of(s), s.density);
  }
  Law operator()(const SaintVenantKirchhoffSpec& s) const {
    return std::make_unique<SaintVenantKirchhoff>(moduli_of(s), s.density);
  }
  Law operator()(const NeoHookeanSpec& s) const {
    return std::make_unique<NeoHookean>(moduli_of(s), s.density);
  }
  Law operator()(const HenckySpec& s) const {
    return std::make_unique<Hencky>(moduli_of(s), s.density);
  }
  Law operator()(const MooneyRivlinSpec& s) const {
    return std::make_unique<MooneyRivlin>(
        MooneyRivlinParameters{s.c10, s.c01, s.bulk_modulus, s.density});
  }
  Law operator()(const J2PlasticitySpec& s) const {
    Hardening hardening;
    hardening.yield_stress = s.yield_stress;
    hardening.modulus = s.hardening;
    if (s.saturation) hardening.saturation = Saturation{s.saturation->stress, s.saturation->rate};
    return std::make_unique<J2Plasticity>(moduli_of(s), hardening, s.density);
  }
};

}  // namespace

std::unique_ptr<const Material> make_material(const MaterialSpec& spec, const Place& place,
                                              int dimension) {
  try {
    const LinearElasticSpec* elastic = std::get_if<LinearElasticSpec>(&spec);
    if (dimension == 1 && elastic != nullptr) return LawMaker{}(of_a_bar(*elastic));
    return std::visit(LawMaker{}, spec);
  } catch (const InputError& error) {  // `where` is the constant's name
    const std::string law = std::visit([](const auto& s) { return std::string(s.name); }, spec);
    const std::string key = error.where.empty() ? "" : "." + error.where;
    throw InputError(error.what_is_wrong, place.where("material." + law + key), error.remedy);
  }
}

}  // namespace abut
