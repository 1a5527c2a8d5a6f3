#include "coordinator/coupling/compare/parallel_force.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

void ParallelForce::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  std::vector<Substeps> grids;
  std::vector<const PortKernel*> kernels;
  compliance_ = 0.0;
  projects_ = false;
  unilateral_ = !joint.tied();
  for (const Side& side : joint.sides) {
    grids.push_back(substeps_of(bodies, side, window));
    kernels.push_back(&bodies.kernel(side.body, side.port, grids.back().count));
    compliance_ += kernels.back()->displacement.front();
  }
  const std::size_t source = index(joint.role.kinematic);
  grid_ = grids[source];
  support_ = kernels[source]->support;
  const Waveform& trace = trace_of(bodies, joint.kinematic_side());
  ABUT_ASSERT(trace.width == 1);
  const double f = trace.f[index_at_begin(trace, window.begin)];
  const bool unknown = !joint.closed() || support_ == ForceSupport::step;
  force_begin_ = unknown ? 0.0 : -joint.normal_of(joint.role.kinematic) * f;
  scale_.step = grid_.step;
  scale_.velocity = reference_velocity(joint, compliance_, scale_.step);
  scale_.force = joint.contact.force_scale;
  inverse_ = nullptr;
  find_inverse(kernels, window, joint, bodies);
  window_ = window;
  see_trial({grids[0], grids[1]}, joint, bodies);
  const bool linear = std::ranges::all_of(
      joint.sides, [&bodies](const Side& side) { return bodies.describe(side.body).linear; });
  looks_ = trials_ && linear && inverse_ != nullptr;
}

void ParallelForce::find_inverse(const std::vector<const PortKernel*>& kernels,
                                 const TimeWindow& window, const Joint& joint,
                                 const Bodies& bodies) {
  const TimeWindow first = inverses_.first_of(window);
  const double length = window.length();
  inverse_ = inverses_.find(length);
  if (inverse_ != nullptr) return;
  std::vector<Substeps> grids;
  for (const Side& side : joint.sides) grids.push_back(substeps_of(bodies, side, first));
  if (std::max(grids[0].count, grids[1].count) > KernelInverse::largest) return;
  Eigen::MatrixXd jacobian =
      parallel_jacobian(kernels, grids, grids[joint.role.kinematic], support_);
  inverse_ = unilateral_ ? inverses_.store(length, ContactMaps{std::move(jacobian), {}, {}})
                         : inverses_.store(length, jacobian / compliance_);
}

/// What force leaves no overlap of the trial?
void ParallelForce::see_trial(const std::array<Substeps, 2>& grids, const Joint& joint,
                              Bodies& bodies) {
  predicted_.resize(0);
  if (inverse_ == nullptr || !trial_.see(window_, grids, joint, bodies)) return;
  see_overlap(joint, {&trial_.motion(0), &trial_.motion(1)});
  force_.setZero(values());
  predicted_ = apply_inverse(overlap_ / compliance_);
}

void ParallelForce::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  if (predicted_.size() > 0) {
    x = predicted_;
    return;
  }
  x.setConstant(force_begin_);
  if (!covers(guess_, grid_)) return;
  for (int i = 1; i <= grid_.count; ++i) guess_.force_at(grid_.time(i), {&x[i - 1], 1});
}

void ParallelForce::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                           Bodies& bodies) {
  lay_times(grid_, 1, guess_);
  guess_.support = support_;
  guess_.f.push_back(force_begin_);
  guess_.f.insert(guess_.f.end(), x.begin(), x.end());
  Waveform& force = bodies.force(joint.sides[side]);
  force = guess_;
  for (double& f : force.f) f *= -joint.normal_of(side);
  if (looks_) Trial::ask(window_, joint, bodies);
}

void ParallelForce::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                          const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const double travelled =
      see_overlap(joint, {&trace_of(bodies, joint.sides[0]), &trace_of(bodies, joint.sides[1])});
  g = x + overlap_ / compliance_;
  if (unilateral_) g = g.cwiseMax(0.0);
  force_ = x;
  projects_ = unilateral_ && inverse_ != nullptr && g.minCoeff() <= 0.0;
  scale_.force = std::max(joint.contact.force_scale, x.lpNorm<Eigen::Infinity>());
  balance(scale_, compliance_);
  scale_.roundoff = roundoff_of(travelled, joint.line.reference_gap);
}

/// Of motions of both sides, at the iterate's substeps. Returns [m] how far they went.
double ParallelForce::see_overlap(const Joint& joint,
                                  const std::array<const Waveform*, 2>& motions) {
  double travelled = 0.0;
  overlap_.resize(values());
  double u[2];
  for (int i = 1; i <= grid_.count; ++i) {
    for (std::size_t s : {0u, 1u}) {
      u[s] = value_at(*motions[s], motions[s]->u, grid_.time(i));
      travelled = std::max(travelled, std::abs(u[s]));
    }
    overlap_[i - 1] = -joint.gap(u[0], u[1]);
  }
  return travelled;
}

FieldResiduals ParallelForce::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                      const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const double mismatch = (g - x).lpNorm<Eigen::Infinity>();  // [N]
  FieldResiduals r;
  r.displacement = scaled(mismatch * compliance_, scale_.velocity * scale_.step, scale_.roundoff);
  r.force = scaled(mismatch, scale_.force, scale_.roundoff / compliance_);
  return r;
}

void ParallelForce::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  const double unit = scale_.velocity * scale_.step / compliance_;
  s.setConstant(unit > 0.0 ? 1.0 / unit : 1.0);
}

Eigen::VectorXd ParallelForce::apply_inverse(const Eigen::VectorXd& r) const {
  if (inverse_ == nullptr) return r;
  if (!unilateral_) return inverse_->solve(r);
  return solve_complementarity(inverse_->maps.overlap, overlap_, force_);
}

void ParallelForce::state(Archive& archive) {
  trial_.state(archive);
  inverses_.state(archive);
}

}  // namespace abut
