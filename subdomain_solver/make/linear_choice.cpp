#include "subdomain_solver/make/linear_choice.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "subdomain_solver/fe/rigid_motions.hpp"
#include "subdomain_solver/solve/petsc_solver.hpp"

namespace abut {

CoarseMotions coarse_motions(const FeModel& model, const std::vector<int>& held) {
  const int dim = model.mesh().dim;
  Eigen::MatrixXd all = rigid_motions(model);
  for (int c = 0; c < dim; ++c) {
    const auto direction = Eigen::seq(c, Eigen::last, dim);
    if (all(direction, Eigen::all).cwiseAbs().maxCoeff() > 0.0) continue;
    all.conservativeResize(Eigen::NoChange, all.cols() + 1);
    all.rightCols(1).setZero();
    all(direction, Eigen::last).setOnes();
  }
  CoarseMotions out;
  std::vector<int> rows;
  int last = -1;
  for (int dof = 0; dof < model.dofs(); ++dof) {
    if (std::ranges::binary_search(held, dof)) continue;
    rows.push_back(dof);
    const bool another = dof / dim != last;
    last = dof / dim;
    out.nodes.push_back(out.nodes.empty() ? 0 : out.nodes.back() + (another ? 1 : 0));
  }
  out.motions = all(rows, Eigen::all);
  return out;
}

namespace {

/// `threads` may be null.
LinearChoice direct(WorkerThreads* threads) {
  return {[threads](Pivots pivots) { return make_direct_solver(pivots, threads); }, ""};
}

LinearChoice iterated(double tolerance, std::function<CoarseMotions()> motions) {
  return {[tolerance, motions = std::move(motions)](Pivots) {
            return make_conjugate_gradients(tolerance, motions());
          },
          ", by conjugate gradients"};
}

LinearChoice by_petsc(double tolerance) {
  return {[tolerance](Pivots) { return make_petsc_solver(tolerance); }, ", by PETSc"};
}

/// Whether factors of the body's matrix would fill the memory.
bool is_large(const FeModel& model, const std::vector<int>& held,
              const std::vector<SolidInterior::PortNodes>& ports) {
  const bool coupled = std::ranges::any_of(
      ports, [](const SolidInterior::PortNodes& port) { return port.touched || port.joined; });
  const auto unknowns = model.dofs() - static_cast<Eigen::Index>(held.size());
  return model.mesh().dim == 3 && unknowns > (coupled ? 2 : 1) * most_factored;
}

}  // namespace

LinearChoice linear_choice(const EquationsSpec& spec) {
  if (const auto* chosen = std::get_if<ConjugateGradientsSpec>(&spec.linear))
    return iterated(chosen->tolerance, [] { return CoarseMotions(); });
  if (const auto* chosen = std::get_if<PetscSpec>(&spec.linear)) return by_petsc(chosen->tolerance);
  return direct(nullptr);
}

LinearChoice linear_choice(const EquationsSpec& spec, FeModel& model, const std::vector<int>& held,
                           const std::vector<SolidInterior::PortNodes>& ports) {
  const auto motions = [&model, held] { return coarse_motions(model, held); };
  if (const auto* chosen = std::get_if<ConjugateGradientsSpec>(&spec.linear))
    return iterated(chosen->tolerance, motions);
  if (const auto* chosen = std::get_if<PetscSpec>(&spec.linear)) return by_petsc(chosen->tolerance);
  const bool factors = std::holds_alternative<DirectSpec>(spec.linear);
  if (factors || !is_large(model, held, ports)) return direct(model.threads());
  return iterated(ConjugateGradientsSpec().tolerance, motions);
}

}  // namespace abut
