#include "subdomain_solver/model.hpp"

namespace abut {

SparseMatrix mass_matrix(const Model& model, MassForm form) {
  if (form == MassForm::consistent) return model.mass();
  const Vector& lumped = model.lumped_mass();
  SparseMatrix diagonal(lumped.size(), lumped.size());
  diagonal.reserve(Eigen::VectorXi::Constant(lumped.size(), 1));
  for (int i = 0; i < lumped.size(); ++i) diagonal.insert(i, i) = lumped(i);
  diagonal.makeCompressed();
  if (form == MassForm::lumped) return diagonal;
  return 0.5 * (model.mass() + diagonal);
}

}  // namespace abut
