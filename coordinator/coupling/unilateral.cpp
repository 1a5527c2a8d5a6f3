#include "coordinator/coupling/unilateral.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

namespace {
/// Of the tolerance: where the straight guess misses by less, windows are sure to do without a
/// trial.
constexpr double doubt = 0.1;
/// Times as much as the kinematic side gives way: a trial of a softer partner would be pushed all
/// the way by forces that a stiff side knows with too few digits.
constexpr double softest = 1.0e4;
}  // namespace

void Unilateral::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  const Side& k = joint.kinematic_side();
  const Side& n = joint.neumann_side();
  kinematic_grid_ = substeps_of(bodies, k, window);
  window_ = window;
  neumann_grid_ = substeps_of(bodies, n, window);
  const Waveform& trace = trace_of(bodies, n);
  const std::size_t now = index_at_begin(trace, window.begin);
  ABUT_ASSERT(trace.width == 1);
  u_begin_ = trace.u[now];
  v_begin_ = trace.v[now];
  kernel_k_ = &bodies.kernel(k.body, k.port, kinematic_grid_.count);
  kernel_n_ = &bodies.kernel(n.body, n.port, neumann_grid_.count);
  kinematic_compliance_ = kernel_k_->displacement.front();
  neumann_compliance_ = kernel_n_->displacement.front();
  const double moved = *std::max_element(kernel_n_->displacement.begin(),
                                         kernel_n_->displacement.begin() + neumann_grid_.count);
  // The reaction is known to the round-off of a displacement over the compliance, and moves the
  // Neumann side by that much.
  roundoff_gain_ = 1.0 + moved / kinematic_compliance_;
  scale_.step = bodies.describe(n.body).step > 0.0 ? neumann_grid_.step : kinematic_grid_.step;
  scale_.velocity = reference_velocity(joint, kinematic_compliance_, scale_.step);
  scale_.force = joint.contact.force_scale;
  first_factor_ = 1.0 / (1.0 + neumann_compliance_ / kinematic_compliance_);
  alike_ = kinematic_grid_.same_as(neumann_grid_) && kernel_k_->support == kernel_n_->support;
  projects_ = false;
  unilateral_ = !joint.tied();
  outward_n_ = joint.normal_of(1 - joint.role.kinematic);
  inverse_ = nullptr;
  // A side that does not give way leaves nothing to iterate; of surfaces the inverse is the body's
  // own that maps them, and secants do the rest.
  if (!std::isinf(bodies.describe(n.body).mass)) find_inverse(joint, window.length(), bodies);
  see_trial(window, joint, bodies);
  const bool linear = bodies.describe(k.body).linear && bodies.describe(n.body).linear;
  looks_ = linear && unilateral_ && inverse_ != nullptr &&
           neumann_compliance_ < softest * kinematic_compliance_ &&
           straight_residual_ > doubt * tolerance_;
}

/// What contact makes of the trial.
void Unilateral::see_trial(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  predicted_.resize(0);
  if (!unilateral_ || inverse_ == nullptr) return;
  std::array<Substeps, 2> grids;
  grids[joint.role.kinematic] = kinematic_grid_;
  grids[1 - joint.role.kinematic] = neumann_grid_;
  if (!trial_.see(window, grids, joint, bodies)) return;
  const Waveform& n = trial_.motion(1 - joint.role.kinematic);
  force_.setZero(kinematic_grid_.count);
  see_overlap(joint, trial_.motion(joint.role.kinematic), n);
  predicted_ = Eigen::Map<const Eigen::VectorXd>(n.u.data() + 1, values());
  predicted_ += apply_inverse(Eigen::VectorXd::Zero(values()));
}

void Unilateral::find_inverse(const Joint& joint, double length, const Bodies& bodies) {
  const TimeWindow first = inverses_.first_of(window_);
  inverse_ = inverses_.find(length);
  if (inverse_ != nullptr) return;
  const Substeps neumann = substeps_of(bodies, joint.neumann_side(), first);
  const Substeps kinematic = substeps_of(bodies, joint.kinematic_side(), first);
  const bool small = std::max(kinematic.count, neumann.count) <= KernelInverse::largest;
  if (alike_) {
    inverse_ =
        inverses_.store(length, unilateral_jacobian_column(*kernel_k_, *kernel_n_, neumann.count));
  } else if (small && joint.tied()) {
    inverse_ =
        inverses_.store(length, unilateral_jacobian(*kernel_k_, kinematic, *kernel_n_, neumann));
  } else if (small) {
    inverse_ = inverses_.store(length, contact_maps(*kernel_k_, kinematic, *kernel_n_, neumann));
  }
}

void Unilateral::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  if (predicted_.size() > 0) {
    x = predicted_;
    return;
  }
  x = straight();
  if (!covers(guess_, neumann_grid_)) return;
  for (int i = 1; i <= neumann_grid_.count; ++i)
    x[i - 1] = value_at(guess_, guess_.u, neumann_grid_.time(i));
}

void Unilateral::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                        Bodies& bodies) {
  const Side& here = joint.sides[side];
  if (looks_) Trial::ask(window_, joint, bodies);
  if (side != joint.role.kinematic) {
    bodies.force(here) = bodies.reaction(joint.kinematic_side());
    return;
  }
  lay_times(neumann_grid_, 1, guess_);
  guess_.u.push_back(u_begin_);
  guess_.u.insert(guess_.u.end(), x.begin(), x.end());
  bodies.obstacle(here).motion = guess_;
}

void Unilateral::image(const Eigen::Ref<const Eigen::VectorXd>&, const Joint& joint,
                       const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const Waveform& trace = trace_of(bodies, joint.neumann_side());
  const bool same = static_cast<int>(trace.size()) == neumann_grid_.count + 1;
  for (int i = 1; i <= neumann_grid_.count; ++i)
    g[i - 1] = same ? trace.u[i] : value_at(trace, trace.u, neumann_grid_.time(i));
  if (unilateral_ && inverse_ != nullptr) see_contact(joint, bodies);
  scale_.force =
      std::max(joint.contact.force_scale, largest(trace_of(bodies, joint.kinematic_side()).f));
  balance(scale_, kinematic_compliance_);
  scale_.roundoff = roundoff_gain_ * roundoff_of(u_begin_, g[g.size() - 1]);
  if (inverse_ != nullptr) straight_residual_ = measure(straight(), g).largest();
}

/// Motion at the velocity of the window's begin.
Eigen::VectorXd Unilateral::straight() const {
  Eigen::VectorXd x(values());
  for (int i = 1; i <= neumann_grid_.count; ++i)
    x[i - 1] = u_begin_ + v_begin_ * (neumann_grid_.time(i) - neumann_grid_.begin);
  return x;
}

/// Overlap and force at K's substeps, against the iterate that it was given.
void Unilateral::see_contact(const Joint& joint, const Bodies& bodies) {
  const Waveform& reply = trace_of(bodies, joint.kinematic_side());
  see_overlap(joint, reply, guess_);
  force_.resize(kinematic_grid_.count);
  for (Eigen::Index i = 0; i < force_.size(); ++i)
    force_[i] = -joint.normal_of(joint.role.kinematic) * reply.f[index(i) + 1];
  projects_ = force_.minCoeff() <= 0.0;
}

/// Of motions of K, told at its substeps, and of N.
void Unilateral::see_overlap(const Joint& joint, const Waveform& k, const Waveform& n) {
  overlap_.resize(kinematic_grid_.count);
  for (int i = 1; i <= kinematic_grid_.count; ++i) {
    double u[2];
    u[joint.role.kinematic] = k.u[i];
    u[1 - joint.role.kinematic] = value_at(n, n.u, kinematic_grid_.time(i));
    overlap_[i - 1] = -joint.gap(u[0], u[1]);
  }
}

FieldResiduals Unilateral::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                   const Eigen::Ref<const Eigen::VectorXd>& g) const {
  const double mismatch = (g - x).lpNorm<Eigen::Infinity>();
  FieldResiduals r;
  r.displacement = scaled(mismatch, scale_.velocity * scale_.step, scale_.roundoff);
  // The force that would close the mismatch, both sides giving way within a substep.
  const double compliance = kinematic_compliance_ + neumann_compliance_;
  r.force = scaled(mismatch / compliance, scale_.force, scale_.roundoff / compliance);
  return r;
}

void Unilateral::scales(Eigen::Ref<Eigen::VectorXd> s) const {
  const double unit = scale_.velocity * scale_.step;
  s.setConstant(unit > 0.0 ? 1.0 / unit : 1.0);
}

Eigen::VectorXd Unilateral::apply_inverse(const Eigen::VectorXd& r) const {
  if (inverse_ == nullptr) return first_factor_ * r;
  if (!unilateral_) return inverse_->solve(r);
  if (alike_) {
    return solve_unilateral(kernel_k_->displacement, kernel_n_->displacement, outward_n_, r,
                            overlap_, force_);
  }
  const ContactMaps& maps = inverse_->maps;
  const Eigen::VectorXd left = overlap_ + outward_n_ * (maps.seen * r);
  return r - outward_n_ * (maps.motion * solve_complementarity(maps.overlap, left, force_));
}

/// What the first guess knows of earlier windows: its own, of the same window, is no state.
void Unilateral::state(Archive& archive) {
  archive.field("straight_residual", straight_residual_);
  inverses_.state(archive);
  trial_.state(archive);
}

}  // namespace abut
