#include "coordinator/coupling/velocity_start.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "coordinator/coupling/exchange_parts.hpp"
#include "coordinator/coupling/tie.hpp"

namespace abut {

namespace {

/// Of the fastest side: velocities are known to it, after sums over some nodes.
constexpr double speed_rounding = 1.0e-13;
/// Masses of faces have condition numbers of ten or so: conjugate residuals take some twenty steps.
constexpr int most_steps = 200, start_patience = 20;

using Tied = KnownExchanges::Entry<Tie>;

bool stands(const Description& body) { return std::isinf(body.mass); }

/// The rows of all ties whose velocities are made one, and the bodies that they join.
class Rows {
 public:
  Rows(std::span<const Joint> joints, double time, Bodies& bodies)
      : bodies_(bodies), instant_{0, time, time} {
    for (const auto& tied : known_exchanges(joints).ties) {
      if (!takes_part(tied)) continue;
      ties_.push_back(tied);
      size_ += tied.exchange->rows().width();
      for (const Side& side : tied.joint->sides)
        if (std::ranges::find(moved_, side.body) == moved_.end()) moved_.push_back(side.body);
    }
    std::ranges::sort(moved_);
  }

  /// Both sides' bodies take impulses, or one of them, where nothing moves the other.
  bool takes_part(const Tied& tied) const {
    if (tied.exchange->energy_account() != EnergyAccount::exact) return false;
    return std::ranges::all_of(tied.joint->sides, [this](const Side& side) {
      const Description& body = bodies_.describe(side.body);
      return body.can.impulse || stands(body);
    });
  }

  bool empty() const { return ties_.empty(); }
  Eigen::Index size() const { return size_; }

  /// [m/s] G v of the last replies, and the largest velocity of a side.
  double differ(Eigen::VectorXd& out) const {
    out.resize(size_);
    double fastest = 0.0;
    Eigen::Index first = 0;
    for (const Tied& tied : ties_) {
      const std::vector<double> seen = velocities_apart(tied, bodies_);
      std::ranges::copy(seen, out.data() + first);
      first += static_cast<Eigen::Index>(seen.size());
      for (const Side& side : tied.joint->sides)
        fastest = std::max(fastest, largest(trace_of(bodies_, side).v));
    }
    return fastest;
  }

  /// Impulses -G^T p [N s] strike; replies then tell the velocities after them.
  [[nodiscard]] std::optional<Failed> strike(const Eigen::VectorXd& p) {
    bodies_.prepare(instant_, 1, Sampling::substeps);
    Eigen::Index first = 0;
    for (const Tied& tied : ties_) {
      const TieRows& rows = tied.exchange->rows();
      const std::span<const double> own(p.data() + first, index(rows.width()));
      first += rows.width();
      for (const int s : {0, 1}) {
        const Side& side = tied.joint->sides[s];
        if (!bodies_.describe(side.body).can.impulse) continue;
        std::vector<double>& impulse = bodies_.boundary(side).impulse;
        impulse.resize(bodies_.port(side).geometry.points.size(), 0.0);
        rows.press(s, s == 0 ? -1.0 : 1.0, own, impulse);
      }
    }
    if (std::optional<Failed> failed = bodies_.advance(moved_)) return failed;
    // Ports show the velocities of a window's begin, impulses come after it.
    bodies_.prepare(instant_, 1, Sampling::substeps);
    return bodies_.advance(moved_);
  }

  static std::vector<double> velocities_apart(const Tied& tied, const Bodies& bodies) {
    const TieRows& rows = tied.exchange->rows();
    std::vector<double> out(index(rows.width()), 0.0), seen(out.size());
    for (const std::size_t s : {0u, 1u}) {
      const Waveform& trace = trace_of(bodies, tied.joint->sides[s]);
      apply(rows.of[s], rows.dim, row(trace, trace.v, trace.size() - 1), seen);
      for (std::size_t k = 0; k < out.size(); ++k) out[k] += s == 0 ? seen[k] : -seen[k];
    }
    return out;
  }

 private:
  Bodies& bodies_;
  TimeWindow instant_;
  std::vector<Tied> ties_;
  std::vector<int> moved_;
  Eigen::Index size_ = 0;
};

/// G M^-1 G^T [1/kg], by what impulses of about the velocities' own size change.
class Mobility {
 public:
  Mobility(Rows& rows, const Eigen::VectorXd& at_first, double speed, Bodies& bodies)
      : rows_(rows), bodies_(bodies), at_first_(at_first), speed_(speed) {}

  [[nodiscard]] std::optional<Failed> apply(const Eigen::VectorXd& p, Eigen::VectorXd& out) {
    if (each_ == 0.0) {  // a first look tells how large impulses are
      if (std::optional<Failed> failed = difference(p, 1.0, out)) return failed;
      each_ = out.norm() / p.norm();
      if (each_ == 0.0) return std::nullopt;
    }
    return difference(p, speed_ / (each_ * p.lpNorm<Eigen::Infinity>()), out);
  }
  double each() const { return each_; }

 private:
  std::optional<Failed> difference(const Eigen::VectorXd& p, double factor, Eigen::VectorXd& out) {
    bodies_.restore_all();
    if (std::optional<Failed> failed = rows_.strike(factor * p)) return failed;
    rows_.differ(out);
    out = (at_first_ - out) / factor;
    return std::nullopt;
  }

  Rows& rows_;
  Bodies& bodies_;
  const Eigen::VectorXd& at_first_;
  double speed_;
  double each_ = 0.0;  // [1/kg] about
};

/// 1 for components that impulses move, 0 for those whose nodes supports hold on both sides: what
/// is given there stays, and would only spoil the digits of the others.
[[nodiscard]] std::optional<Failed> find_free(Mobility& mobility, Eigen::Index size,
                                              Eigen::VectorXd& free) {
  Eigen::VectorXd any(size), moved;
  for (Eigen::Index k = 0; k < size; ++k)  // no combination of rows
    any[k] = 1.0 + std::fmod(0.6180339887498949 * static_cast<double>(k), 1.0);
  if (std::optional<Failed> failed = mobility.apply(any, moved)) return failed;
  const double least = speed_rounding * moved.lpNorm<Eigen::Infinity>();
  free = (moved.array().abs() > least).cast<double>();
  return std::nullopt;
}

/// Conjugate residuals: where rows say the same twice the operator is singular, and what it does
/// not answer takes no part. The end is where S r is nothing, or falls no more. Kinetic energy
/// falls from step to step.
[[nodiscard]] std::optional<Failed> solve(Mobility& mobility, Eigen::VectorXd r, double speed,
                                          Eigen::VectorXd& x) {
  x.setZero(r.size());
  Eigen::VectorXd free, sr, y = x;
  if (std::optional<Failed> failed = find_free(mobility, r.size(), free)) return failed;
  r = r.cwiseProduct(free);
  if (r.lpNorm<Eigen::Infinity>() <= speed_rounding * speed) return std::nullopt;
  Eigen::VectorXd p = r;
  if (std::optional<Failed> failed = mobility.apply(r, sr)) return failed;
  sr = sr.cwiseProduct(free);
  Eigen::VectorXd sp = sr;
  const double nothing =
      mobility.each() * speed_rounding * speed * std::sqrt(static_cast<double>(r.size()));
  double square = r.dot(sr), best = sr.norm();
  int since = 0;
  for (int k = 0; k < most_steps && sr.norm() > nothing && square > 0.0 && since < start_patience;
       ++k) {
    const double length = square / sp.squaredNorm();
    y += length * p;
    r -= length * sp;
    if (r.isZero(0.0)) {  // a single row is answered to the last bit, and nothing has no size
      x = y;
      return std::nullopt;
    }
    if (std::optional<Failed> failed = mobility.apply(r, sr)) return failed;
    sr = sr.cwiseProduct(free);
    since = sr.norm() < best ? 0 : since + 1;
    if (since == 0) {
      best = sr.norm();
      x = y;
    }
    const double next = r.dot(sr);
    p = r + next / square * p;
    sp = sr + next / square * sp;
    square = next;
  }
  return std::nullopt;
}

void find_unlike(const Rows& rows, std::span<const Joint> joints, const Bodies& bodies,
                 std::vector<UnlikeStart>& unlike) {
  for (const Tied& tied : known_exchanges(joints).ties) {
    if (tied.exchange->energy_account() != EnergyAccount::exact || rows.takes_part(tied)) continue;
    const Joint& joint = *tied.joint;
    std::string body;
    bool inert = true;
    double fastest = 0.0;
    for (const Side& side : joint.sides) {
      const Description& about = bodies.describe(side.body);
      inert = inert && !about.quasi_static;
      fastest = std::max(fastest, largest(trace_of(bodies, side).v));
      if (!about.can.impulse && !stands(about)) body = about.name;
    }
    const double speed = largest(Rows::velocities_apart(tied, bodies));
    if (inert && speed > 1.0e-9 * fastest) unlike.push_back({&joint, speed, body});
  }
}

}  // namespace

std::optional<Failed> unite_velocities(std::span<const Joint> joints, double time, Bodies& bodies,
                                       std::vector<UnlikeStart>& unlike) {
  Rows rows(joints, time, bodies);
  find_unlike(rows, joints, bodies, unlike);
  if (rows.empty()) return std::nullopt;
  Eigen::VectorXd apart;
  double speed = rows.differ(apart);
  const auto alike = [&] { return apart.lpNorm<Eigen::Infinity>() <= speed_rounding * speed; };
  if (alike()) return std::nullopt;
  bodies.save_all();
  // Nodes without mass are seen from here on as what has theirs, which is what impulses move.
  if (std::optional<Failed> failed = rows.strike(Eigen::VectorXd::Zero(rows.size()))) {
    bodies.restore_all();
    return failed;
  }
  speed = rows.differ(apart);
  if (alike()) return std::nullopt;
  bodies.save_all();
  Mobility mobility(rows, apart, speed, bodies);
  Eigen::VectorXd impulse;
  std::optional<Failed> failed = solve(mobility, apart, speed, impulse);
  bodies.restore_all();
  if (failed) return failed;
  return rows.strike(impulse);
}

}  // namespace abut
