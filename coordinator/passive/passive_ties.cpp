#include "coordinator/passive/passive_ties.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/one_each.hpp"

namespace abut {

namespace {

/// Of what sides have parted by, taken back in a step: all of it at once would make them swing.
constexpr double taken_back = 0.1;

Eigen::Map<Eigen::VectorXd> view(std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

PassiveTies::PassiveTies(std::vector<PassiveTie> ties, const Bodies& bodies)
    : ties_(std::move(ties)),
      bodies_(bodies),
      cluster_(index(bodies.count())),
      members_(index(bodies.count())),
      clusters_(index(bodies.count())) {
  std::iota(cluster_.begin(), cluster_.end(), 0);
  for (const PassiveTie& tie : ties_) {
    dim_ = tie.rows().dim;
    const int one = cluster_[index(tie.sides[0].body)], other = cluster_[index(tie.sides[1].body)];
    for (int& of : cluster_)
      if (of == one || of == other) of = std::min(one, other);
  }
  for (int b = 0; b < bodies.count(); ++b) members_[index(cluster(b))].push_back(b);
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    Cluster& own = clusters_[index(cluster(ties_[t].sides[0].body))];
    own.ties.push_back(static_cast<int>(t));
    own.first.push_back(own.rows);
    own.rows += ties_[t].rows().width();
    impulses_.push_back(Eigen::VectorXd::Zero(ties_[t].rows().width()));
  }
  start_ = parted_ = aim_ = velocity_ = forces_ = impulses_;
}

/// Rows of one side, of values (points, dim).
Eigen::VectorXd PassiveTies::part(const PassiveTie& tie, std::size_t side,
                                  const std::vector<double>& values) const {
  std::vector<double> out(index(tie.rows().width()), 0.0);
  apply(tie.rows().of[side], dim_, values, out);
  return view(out);
}

void PassiveTies::begin(const Displacements& displacements) {
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    start_[t].setZero();
    for (const std::size_t s : {0u, 1u}) {
      const Side& side = ties_[t].sides[s];
      start_[t] += (s == 0 ? 1.0 : -1.0) *
                   part(ties_[t], s, displacements[index(side.body)][index(side.port)]);
    }
    forces_[t].setZero();
    impulses_[t].setZero();
  }
}

void PassiveTies::aim(double length, const Displacements& displacements,
                      std::span<const PassiveReply> before, double rounding) {
  length_ = length;
  rounding_ = rounding;
  for (Cluster& cluster : clusters_) cluster.share = 1.0;
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    aim_[t] = taken_back / length * start_[t];
    parted_[t] = -start_[t];
    for (const std::size_t s : {0u, 1u}) {
      const Side& side = ties_[t].sides[s];
      const std::size_t b = index(side.body), p = index(side.port);
      const Eigen::VectorXd place = part(ties_[t], s, displacements[b][p]);
      const double sign = s == 0 ? 1.0 : -1.0;
      parted_[t] += sign * place;
      aim_[t] += sign * (0.5 * part(ties_[t], s, before[b].ports[p].velocity) -
                         taken_back / length * place);
    }
    impulses_[t] = length * forces_[t];
  }
}

void PassiveTies::add_points(int body, std::vector<std::vector<std::int32_t>>& pressed) const {
  for (const PassiveTie& tie : ties_) {
    for (const std::size_t s : {0u, 1u}) {
      const Side& side = tie.sides[s];
      if (side.body != body || std::isinf(bodies_.describe(body).mass)) continue;
      std::vector<std::int32_t>& points = pressed[index(side.port)];
      for (const std::int32_t point : tie.rows().of[s].columns) points.push_back(point);
      keep_one_each(points);
    }
  }
}

void PassiveTies::add_impulses(int body, std::vector<std::vector<double>>& impulses) const {
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    for (const std::size_t s : {0u, 1u}) {
      const Side& side = ties_[t].sides[s];
      if (side.body != body || impulses_[t].isZero(0.0)) continue;
      std::vector<double>& port = impulses[index(side.port)];
      if (port.empty()) port.assign(bodies_.port(side).geometry.points.size(), 0.0);
      add_transposed(ties_[t].rows().of[s], dim_, s == 0 ? 1.0 : -1.0,
                     {impulses_[t].data(), index(static_cast<int>(impulses_[t].size()))}, port);
    }
  }
}

void PassiveTies::see(std::span<const PassiveReply> replies, std::span<const PassiveStep> asked) {
  replies_ = replies;
  asked_ = asked;
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    velocity_[t].setZero();
    for (const std::size_t s : {0u, 1u}) {
      const Side& side = ties_[t].sides[s];
      velocity_[t] +=
          (s == 0 ? 1.0 : -1.0) / length_ *
          part(ties_[t], s, replies[index(side.body)].ports[index(side.port)].displacement);
    }
  }
}

double PassiveTies::missed() const {
  double most = 0.0;
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    const double share = clusters_[index(cluster(ties_[t].sides[0].body))].share;
    most = std::max(most, (velocity_[t] - share * aim_[t]).lpNorm<Eigen::Infinity>() * length_);
  }
  return most;
}

bool PassiveTies::passive() const {
  return std::ranges::all_of(clusters_, [this](const Cluster& cluster) {
    double work = 0.0;
    for (const int t : cluster.ties) work += impulses_[index(t)].dot(velocity_[index(t)]);
    return work <= rounding_;
  });
}

double PassiveTies::work() const {
  double sum = 0.0;
  for (std::size_t t = 0; t < ties_.size(); ++t) sum += impulses_[t].dot(velocity_[t]);
  return sum;
}

/// Of all its ties, one after the other.
Eigen::VectorXd PassiveTies::of_cluster(const Cluster& cluster,
                                        std::span<const Eigen::VectorXd> values) const {
  Eigen::VectorXd out(cluster.rows);
  for (std::size_t k = 0; k < cluster.ties.size(); ++k) {
    const Eigen::VectorXd& own = values[index(cluster.ties[k])];
    out.segment(cluster.first[k], own.size()) = own;
  }
  return out;
}

/// Of all values that the cluster's bodies told of, side by side.
Eigen::MatrixXd PassiveTies::block_compliance(const Cluster& cluster) const {
  const Eigen::Index count = static_cast<Eigen::Index>(cluster.values.size()) * dim_;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(count, count);
  Eigen::Index first = 0;
  for (std::size_t v = 0; v < cluster.values.size();) {
    const std::int32_t body = cluster.values[v][0];
    std::size_t end = v;
    while (end < cluster.values.size() && cluster.values[end][0] == body) ++end;
    const Eigen::Index own = static_cast<Eigen::Index>(end - v) * dim_;
    out.block(first, first, own, own) =
        Eigen::Map<const Eigen::MatrixXd>(replies_[index(body)].compliance.data(), own, own);
    first += own;
    v = end;
  }
  return out;
}

/// T: (rows, values).
Eigen::MatrixXd PassiveTies::operator_of(const Cluster& cluster) const {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(cluster.rows, static_cast<Eigen::Index>(cluster.values.size()) * dim_);
  for (std::size_t k = 0; k < cluster.ties.size(); ++k) {
    const PassiveTie& tie = ties_[index(cluster.ties[k])];
    for (const std::size_t s : {0u, 1u}) {
      const SparseRows& rows = tie.rows().of[s];
      for (int r = 0; r < rows.count(); ++r) {
        for (std::int32_t e = rows.offsets[index(r)]; e < rows.offsets[index(r) + 1]; ++e) {
          const std::array<std::int32_t, 3> point = {tie.sides[s].body, tie.sides[s].port,
                                                     rows.columns[index(e)]};
          const auto at = std::ranges::lower_bound(cluster.values, point);
          if (at == cluster.values.end() || *at != point) continue;  // it stands
          const Eigen::Index value = (at - cluster.values.begin()) * dim_;
          for (int i = 0; i < dim_; ++i)
            out(cluster.first[k] + Eigen::Index{r} * dim_ + i, value + i) +=
                (s == 0 ? 1.0 : -1.0) * rows.values[index(e)];
        }
      }
    }
  }
  return out;
}

PassiveTies::Answer PassiveTies::answer(int lead,
                                        std::span<const std::array<std::int32_t, 3>> points) {
  Cluster& cluster = clusters_[index(lead)];
  cluster.values.clear();
  for (const int body : members_[index(lead)]) {
    const auto& pressed = asked_[index(body)].pressed;
    for (std::size_t p = 0; p < pressed.size(); ++p)
      for (const std::int32_t point : pressed[p])
        cluster.values.push_back({body, static_cast<std::int32_t>(p), point});
  }
  const Eigen::MatrixXd compliance = block_compliance(cluster), rows = operator_of(cluster);
  cluster.across = rows * compliance;
  // Rows that say the same, and those of what supports hold, have no unique impulses: the least are
  // theirs. Any others would add up what roundings leave of such rows, step by step.
  const Eigen::MatrixXd own = cluster.across * rows.transpose();
  Eigen::VectorXd units = own.diagonal();  // of a tie, whose rows are those of one surface
  for (std::size_t k = 0; k < cluster.ties.size(); ++k) {
    auto of_tie = units.segment(cluster.first[k], impulses_[index(cluster.ties[k])].size());
    of_tie.setConstant(of_tie.maxCoeff());
  }
  cluster.stiffness.compute(own, units);
  const Eigen::VectorXd seen = of_cluster(cluster, velocity_), aim = of_cluster(cluster, aim_);
  // Of a share s of what is aimed at, impulses that reach it do s (s a - b) of work.
  const Eigen::VectorXd stiff = cluster.stiffness.solve(aim);
  const double a = aim.dot(stiff), b = seen.dot(stiff) - aim.dot(of_cluster(cluster, impulses_));
  cluster.share = a - b > rounding_ ? std::clamp(b / a, 0.0, 1.0) : 1.0;
  const Eigen::VectorXd miss = seen - cluster.share * aim;
  cluster.before = -cluster.stiffness.solve(miss);
  std::vector<Eigen::Index> at;
  for (const std::array<std::int32_t, 3>& point : points) {
    const Eigen::Index value =
        (std::ranges::lower_bound(cluster.values, point) - cluster.values.begin()) * dim_;
    for (int i = 0; i < dim_; ++i) at.push_back(value + i);
  }
  cluster.contact = cluster.across(Eigen::all, at);
  const Eigen::MatrixXd held = cluster.stiffness.solve(cluster.contact);
  Answer out;
  out.compliance = compliance(at, at) - cluster.contact.transpose() * held;
  out.change = cluster.contact.transpose() * cluster.before;
  return out;
}

void PassiveTies::follow(int lead, const Eigen::VectorXd& change) {
  const Cluster& cluster = clusters_[index(lead)];
  Eigen::VectorXd more = cluster.before;
  if (change.size() > 0) more -= cluster.stiffness.solve(Eigen::VectorXd(cluster.contact * change));
  for (std::size_t k = 0; k < cluster.ties.size(); ++k) {
    Eigen::VectorXd& impulse = impulses_[index(cluster.ties[k])];
    impulse += more.segment(cluster.first[k], impulse.size());
  }
}

void PassiveTies::accept() {
  for (std::size_t t = 0; t < ties_.size(); ++t) forces_[t] = impulses_[t] / length_;
}

void PassiveTies::begin_window(double time) const {
  for (const PassiveTie& tie : ties_)
    if (tie.tie != nullptr) tie.tie->begin_passive(time);
}

void PassiveTies::tell(double end) const {
  for (std::size_t t = 0; t < ties_.size(); ++t) {
    if (ties_[t].tie == nullptr) continue;
    const Eigen::VectorXd force = (ties_[t].kinematic == 0 ? 1.0 : -1.0) * forces_[t],
                          parted = parted_[t] + length_ * velocity_[t];
    const std::size_t count = index(static_cast<int>(force.size()));
    ties_[t].tie->see_passive(end, {force.data(), count}, {parted.data(), count});
  }
}

void PassiveTies::state(Archive& archive) {
  for (std::vector<Eigen::VectorXd>* list : {&start_, &forces_}) {
    for (Eigen::VectorXd& of : *list) {
      std::vector<double> values(of.begin(), of.end());
      archive.field("tie", values);
      of = view(values);
    }
  }
}

}  // namespace abut
