#include "subdomain_solver/fe/batched_law.hpp"

#include "subdomain_solver/materials/hencky.hpp"
#include "subdomain_solver/materials/j2_plasticity.hpp"
#include "subdomain_solver/materials/linear_elastic.hpp"
#include "subdomain_solver/materials/mooney_rivlin.hpp"
#include "subdomain_solver/materials/neo_hookean.hpp"
#include "subdomain_solver/materials/saint_venant_kirchhoff.hpp"

namespace abut {

std::optional<BatchedLaw> batched_law_of(const Material& material) {
  if (dynamic_cast<const LinearElastic*>(&material) != nullptr) return BatchedLaw::linear_elastic;
  if (dynamic_cast<const SaintVenantKirchhoff*>(&material) != nullptr)
    return BatchedLaw::saint_venant_kirchhoff;
  if (dynamic_cast<const NeoHookean*>(&material) != nullptr) return BatchedLaw::neo_hookean;
  if (dynamic_cast<const MooneyRivlin*>(&material) != nullptr) return BatchedLaw::mooney_rivlin;
  if (dynamic_cast<const Hencky*>(&material) != nullptr) return BatchedLaw::hencky;
  if (dynamic_cast<const J2Plasticity*>(&material) != nullptr) return BatchedLaw::j2_plasticity;
  return std::nullopt;
}

}  // namespace abut
