#include "coordinator/coupling/transmission.hpp"
#include "base/index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace abut {

namespace {

/// Displacements are known to this many units of round-off of their own size.
constexpr double roundoff_units = 64.0;
/// Factored Jacobians kept per interface; windows cut short by events have lengths of their own.
constexpr std::size_t kept_inverses = 32;

TimeGrid grid_of(const Bodies& bodies, const Side& side, const TimeWindow& window) {
  return TimeGrid(window.begin, window.end, bodies.describe(side.body).step);
}

const PortKernel& kernel_of(Bodies& bodies, const Side& side, int count) {
  return bodies.kernel(side.body, side.port, count);
}

BoundaryData& boundary_of(Bodies& bodies, const Side& side) {
  return bodies.request(side.body).boundary[index(side.port)];
}

/// The partner's reply, turned into the force on this side: equal and opposite.
void hand_over(const Waveform& from, Waveform& to) {
  to.support = from.support;
  to.time = from.time;
  to.f.resize(from.f.size());
  std::transform(from.f.begin(), from.f.end(), to.f.begin(), [](double f) { return -f; });
}

double roundoff_of(double displacement, double travelled) {
  return roundoff_units * std::numeric_limits<double>::epsilon() *
         std::max(std::abs(displacement), std::abs(travelled));
}

/// Velocity against which mismatch is measured: of the first touch, or what the contact force moves
/// in a step.
double reference_velocity(const Interface& interface, double compliance, double step) {
  return std::max(interface.closing_speed, interface.force_scale * compliance / step);
}

/// Velocity and force that go with each other: neither is measured against less than a thousandth
/// of what the other one causes in a step, or the first touch of a window would be asked for digits
/// that it does not have.
void balance(ReferenceScales& scale, double compliance) {
  constexpr double share = 1.0e-3;
  scale.velocity = std::max(scale.velocity, share * scale.force * compliance / scale.step);
  scale.force = std::max(scale.force, share * scale.velocity * scale.step / compliance);
}

/// A window that was cut short starts from the iterate of the longer one.
bool covers(const Waveform& guess, const TimeGrid& grid) {
  return !guess.empty() && guess.time.front() == grid.begin && guess.time.back() >= grid.end;
}

}  // namespace

Eigen::VectorXd KernelInverse::Entry::solve(const Eigen::VectorXd& r) const {
  return column.empty() ? Eigen::VectorXd(factors.solve(r)) : solve_toeplitz(column, r);
}

const KernelInverse::Entry* KernelInverse::find(double length) const {
  for (const std::unique_ptr<Entry>& entry : entries_) {
    // Ends of windows are rounded: equal windows differ in their last bits.
    if (std::abs(entry->length - length) <= 1.0e-9 * length) return entry.get();
  }
  return nullptr;
}

const KernelInverse::Entry* KernelInverse::add(Entry entry) {
  // the first is the whole window's
  if (entries_.size() >= kept_inverses) entries_.erase(entries_.begin() + 1);
  entries_.push_back(std::make_unique<Entry>(std::move(entry)));
  return entries_.back().get();
}

const KernelInverse::Entry* KernelInverse::store(double length, const Eigen::MatrixXd& jacobian) {
  return add({length, {}, jacobian.partialPivLu(), {}});
}

const KernelInverse::Entry* KernelInverse::store(double length, ContactMaps maps) {
  return add({length, {}, {}, std::move(maps)});
}

const KernelInverse::Entry* KernelInverse::store(double length, std::vector<double> column) {
  return add({length, std::move(column), {}, {}});
}

// ---- unilateral, alternating --------------------------------------------------------------------

void Unilateral::begin(const TimeWindow& window, const Interface& interface, Bodies& bodies) {
  const Side& k = interface.kinematic_side();
  const Side& n = interface.neumann_side();
  kinematic_grid_ = grid_of(bodies, k, window);
  neumann_grid_ = grid_of(bodies, n, window);
  const Waveform& trace = trace_of(bodies, n);
  const std::size_t now = index_at_begin(trace, window.begin);
  u_begin_ = trace.u[now];
  v_begin_ = trace.v[now];
  const PortKernel& kernel_k = kernel_of(bodies, k, kinematic_grid_.count);
  const PortKernel& kernel_n = kernel_of(bodies, n, neumann_grid_.count);
  kinematic_compliance_ = kernel_k.displacement.front();
  neumann_compliance_ = kernel_n.displacement.front();
  const double moved = *std::max_element(kernel_n.displacement.begin(),
                                         kernel_n.displacement.begin() + neumann_grid_.count);
  // The reaction is known to the round-off of a displacement over the compliance, and moves the
  // Neumann side by that much.
  roundoff_gain_ = 1.0 + moved / kinematic_compliance_;
  const double step =
      bodies.describe(n.body).step > 0.0 ? neumann_grid_.step : kinematic_grid_.step;
  scale_.step = step;
  scale_.velocity = reference_velocity(interface, kinematic_compliance_, step);
  scale_.force = interface.force_scale;
  first_factor_ = 1.0 / (1.0 + neumann_compliance_ / kinematic_compliance_);
  alike_ = kinematic_grid_.same_as(neumann_grid_) && kernel_k.support == kernel_n.support;
  projects_ = false;
  unilateral_ = !interface.bilateral;
  kernel_k_ = &kernel_k;
  kernel_n_ = &kernel_n;
  outward_n_ = interface.normal_of(1 - interface.kinematic);
  inverse_ = nullptr;
  // a side that does not give way leaves nothing to iterate
  if (std::isinf(bodies.describe(n.body).mass)) return;
  inverse_ = inverses_.find(window.length());
  if (inverse_ != nullptr) return;
  const bool small = std::max(kinematic_grid_.count, neumann_grid_.count) <= KernelInverse::largest;
  if (alike_) {
    inverse_ = inverses_.store(window.length(),
                               unilateral_jacobian_column(kernel_k, kernel_n, neumann_grid_.count));
  } else if (small && interface.bilateral) {
    inverse_ = inverses_.store(
        window.length(), unilateral_jacobian(kernel_k, kinematic_grid_, kernel_n, neumann_grid_));
  } else if (small) {
    inverse_ = inverses_.store(window.length(),
                               contact_maps(kernel_k, kinematic_grid_, kernel_n, neumann_grid_));
  }
}

void Unilateral::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  const bool known = covers(guess_, neumann_grid_);
  for (int i = 1; i <= neumann_grid_.count; ++i) {
    const double time = neumann_grid_.time(i);
    double u = u_begin_ + v_begin_ * (time - neumann_grid_.begin);
    if (known) guess_.interpolate(guess_.u, time, {&u, 1});
    x[i - 1] = u;
  }
}

void Unilateral::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x,
                        const Interface& interface, Bodies& bodies) {
  const Side& here = interface.sides[index(side)];
  BoundaryData& data = boundary_of(bodies, here);
  if (side != interface.kinematic) {
    hand_over(trace_of(bodies, interface.kinematic_side()), data.force);
    return;
  }
  Waveform& motion = data.obstacle.motion;
  motion.clear();
  motion.time.push_back(neumann_grid_.begin);
  motion.u.push_back(u_begin_);
  for (int i = 1; i <= neumann_grid_.count; ++i) {
    motion.time.push_back(neumann_grid_.time(i));
    motion.u.push_back(x[i - 1]);
  }
  data.obstacle.offset.assign(1, interface.offset(side));
  data.obstacle.bilateral = interface.bilateral;
  guess_.time = motion.time;
  guess_.u = motion.u;
}

void Unilateral::image(const Eigen::Ref<const Eigen::VectorXd>&, const Interface& interface,
                       const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  const Waveform& trace = trace_of(bodies, interface.neumann_side());
  const bool same = static_cast<int>(trace.size()) == neumann_grid_.count + 1;
  for (int i = 1; i <= neumann_grid_.count; ++i) {
    if (same) {
      g[i - 1] = trace.u[index(i)];
    } else {
      trace.interpolate(trace.u, neumann_grid_.time(i), {&g[i - 1], 1});
    }
  }
  if (unilateral_ && inverse_ != nullptr) see_contact(interface, bodies);
  scale_.force = std::max(interface.force_scale, 0.0);
  for (double f : trace_of(bodies, interface.kinematic_side()).f)
    scale_.force = std::max(scale_.force, std::abs(f));
  balance(scale_, kinematic_compliance_);
  scale_.roundoff = roundoff_gain_ * roundoff_of(u_begin_, g[neumann_grid_.count - 1]);
}

/// Overlap and force at K's substeps, against the iterate that it was given.
void Unilateral::see_contact(const Interface& interface, const Bodies& bodies) {
  const Waveform& reply = trace_of(bodies, interface.kinematic_side());
  overlap_.resize(kinematic_grid_.count);
  force_.resize(kinematic_grid_.count);
  for (Eigen::Index i = 0; i < force_.size(); ++i) {
    const std::size_t at = index(i) + 1;
    double u[2];
    u[interface.kinematic] = reply.u[at];
    guess_.interpolate(guess_.u, kinematic_grid_.time(static_cast<int>(at)),
                       {&u[1 - interface.kinematic], 1});
    overlap_[i] = -interface.gap(u[0], u[1]);
    force_[i] = -interface.normal_of(interface.kinematic) * reply.f[at];
  }
  projects_ = force_.minCoeff() <= 0.0;
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

// ---- parallel -----------------------------------------------------------------------------------

void ParallelForce::begin(const TimeWindow& window, const Interface& interface, Bodies& bodies) {
  std::vector<TimeGrid> grids;
  std::vector<const PortKernel*> kernels;
  compliance_ = 0.0;
  projects_ = false;
  unilateral_ = !interface.bilateral;
  for (const Side& side : interface.sides) {
    grids.push_back(grid_of(bodies, side, window));
    kernels.push_back(&kernel_of(bodies, side, grids.back().count));
    compliance_ += kernels.back()->displacement.front();
  }
  const std::size_t source = index(interface.kinematic);
  force_grid_ = grids[source];
  support_ = kernels[source]->support;
  const Waveform& trace = trace_of(bodies, interface.kinematic_side());
  force_begin_ =
      -interface.normal_of(interface.kinematic) * trace.f[index_at_begin(trace, window.begin)];
  if (!interface.closed || support_ == ForceSupport::step) force_begin_ = 0.0;
  scale_.step = force_grid_.step;
  scale_.velocity = reference_velocity(interface, compliance_, scale_.step);
  scale_.force = interface.force_scale;
  inverse_ = inverses_.find(window.length());
  if (inverse_ != nullptr) return;
  if (std::max(grids[0].count, grids[1].count) > KernelInverse::largest) return;
  Eigen::MatrixXd jacobian = parallel_jacobian(kernels, grids, force_grid_, support_);
  inverse_ = unilateral_
                 ? inverses_.store(window.length(), ContactMaps{std::move(jacobian), {}, {}})
                 : inverses_.store(window.length(), jacobian / compliance_);
}

void ParallelForce::predict(Eigen::Ref<Eigen::VectorXd> x) const {
  const bool known = covers(guess_, force_grid_);
  for (int i = 1; i <= force_grid_.count; ++i) {
    double force = force_begin_;
    if (known) guess_.force_at(force_grid_.time(i), {&force, 1});
    x[i - 1] = force;
  }
}

void ParallelForce::impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x,
                           const Interface& interface, Bodies& bodies) {
  guess_.clear();
  guess_.support = support_;
  guess_.time.push_back(force_grid_.begin);
  guess_.f.push_back(force_begin_);
  for (int i = 1; i <= force_grid_.count; ++i) {
    guess_.time.push_back(force_grid_.time(i));
    guess_.f.push_back(x[i - 1]);
  }
  Waveform& force = boundary_of(bodies, interface.sides[index(side)]).force;
  force.support = support_;
  force.time = guess_.time;
  force.f = guess_.f;
  for (double& f : force.f) f *= -interface.normal_of(side);
}

void ParallelForce::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Interface& interface,
                          const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  double travelled = 0.0;
  overlap_.resize(force_grid_.count);
  for (int i = 1; i <= force_grid_.count; ++i) {
    double u[2] = {0.0, 0.0};
    for (std::size_t s : {0u, 1u}) {
      const Waveform& trace = trace_of(bodies, interface.sides[s]);
      trace.interpolate(trace.u, force_grid_.time(i), {&u[s], 1});
      travelled = std::max(travelled, std::abs(u[s]));
    }
    overlap_[i - 1] = -interface.gap(u[0], u[1]);
    g[i - 1] = x[i - 1] + overlap_[i - 1] / compliance_;
    if (unilateral_) g[i - 1] = std::max(0.0, g[i - 1]);
  }
  force_ = x;
  projects_ = unilateral_ && inverse_ != nullptr && g.minCoeff() <= 0.0;
  scale_.force = std::max(interface.force_scale, x.lpNorm<Eigen::Infinity>());
  balance(scale_, compliance_);
  scale_.roundoff = roundoff_of(travelled, interface.reference_gap);
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

}  // namespace abut
