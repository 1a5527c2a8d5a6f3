#include "subdomain_solver/reactions.hpp"
#include "base/index.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace abut {

namespace {

constexpr std::array<const char*, 3> axes = {"x", "y", "z"};

}  // namespace

Eigen::Vector3d direction_of(const FeModel& model, int dof) {
  const int dim = model.mesh().dim;
  const Matrix3* frame = model.frame(dof / dim);
  if (frame == nullptr) return Eigen::Vector3d::Unit(dof % dim);
  return frame->col(dof % dim);
}

NodalReactions::NodalReactions(const FeModel& model, const Problem& problem,
                               const Integrator& integrator, const SparseMatrix& mass, double step,
                               std::vector<HeldCoordinates> constraints)
    : model_(model),
      problem_(problem),
      integrator_(integrator),
      own_loads_(problem.loads.size()),
      step_(step),
      constraints_(std::move(constraints)) {
  const int supports = static_cast<int>(problem.supports.size());
  SparseMatrix columns(mass.cols(), supports);  // those of the symmetric matrix that are held
  for (int k = 0; k < supports; ++k) columns.col(k) = mass.col(problem.supports[k].dof);
  mass_ = columns.transpose();
}

/// Loads of the problem tell forces that partners give, not those of a contact that the body finds.
void NodalReactions::forces(const Motion& motion, double time, const Vector& on_ports,
                            Vector& out) {
  external_.setZero(on_ports.size());
  for (std::size_t k = 0; k < own_loads_; ++k) problem_.loads[k]->add(time, motion.q, external_);
  external_ += on_ports;
  integrator_.acceleration(motion, time, step_, external_, acceleration_);
  inertia_.noalias() = mass_ * acceleration_;
  out.setZero(on_ports.size());
  int k = 0;
  for (const Prescribed& p : problem_.supports)
    out(p.dof) = inertia_(k++) + motion.force[p.dof] - external_(p.dof);
}

void NodalReactions::sums(const Motion& motion, double time, const Vector& on_ports,
                          std::vector<double>& out) {
  forces(motion, time, on_ports, forces_);
  sum_reactions(model_, constraints_, forces_, out);
}

void sum_reactions(const FeModel& model, const std::vector<HeldCoordinates>& constraints,
                   const Eigen::Ref<const Vector>& forces, std::vector<double>& out) {
  out.clear();
  for (const HeldCoordinates& constraint : constraints) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int dof : constraint.dofs) sum += forces(dof) * direction_of(model, dof);
    out.insert(out.end(), sum.data(), sum.data() + model.mesh().dim);
  }
}

std::vector<std::string> reaction_columns(int dim,
                                          const std::vector<HeldCoordinates>& constraints) {
  std::vector<std::string> names;
  for (const HeldCoordinates& constraint : constraints) {
    for (int i = 0; i < dim; ++i) {
      const std::string ending = dim == 1 ? "" : fmt::format("_{}", axes[i]);
      names.push_back(fmt::format("{}.reaction{} [N]", constraint.name, ending));
    }
  }
  return names;
}

std::vector<std::string> reaction_measure_names(int dim,
                                                const std::vector<HeldCoordinates>& constraints) {
  std::vector<std::string> names;
  if (constraints.empty()) return names;
  for (const HeldCoordinates& constraint : constraints) {
    for (int i = 0; i < dim; ++i)
      names.push_back(fmt::format("{}.reaction.{}", constraint.name, axes[i]));
  }
  for (int i = 0; i < dim; ++i) names.push_back(fmt::format("reaction.{}", axes[i]));
  return names;
}

std::vector<double> reaction_measures(int dim, const std::vector<double>& sums) {
  std::vector<double> values = sums;
  if (sums.empty()) return values;
  std::vector<double> total(index(dim), 0.0);
  for (std::size_t k = 0; k < sums.size(); ++k) total[k % index(dim)] += sums[k];
  values.insert(values.end(), total.begin(), total.end());
  return values;
}

}  // namespace abut
