#include "subdomain_solver/model.hpp"

#include "subdomain_solver/solve/matrix_sum.hpp"

#include "base/assert.hpp"

namespace abut {

const std::vector<int>& Model::massless() const {
  static const std::vector<int> none;
  return none;
}

bool Model::evaluate_layer(std::span<const double>, std::span<const double>, Want,
                           LayerResponse& out) {
  ABUT_ASSERT(massless().empty());  // who has a layer says how it answers
  out.force.resize(0);
  out.tangent.resize(0, 0);
  return true;
}

SparseMatrix mass_matrix(const Model& model, MassForm form) {
  if (form == MassForm::consistent) return model.mass();
  const SparseMatrix diagonal = diagonal_matrix(model.lumped_mass());
  if (form == MassForm::lumped) return diagonal;
  return 0.5 * (model.mass() + diagonal);
}

}  // namespace abut
