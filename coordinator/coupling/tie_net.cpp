#include "coordinator/coupling/tie_net.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/assert.hpp"
#include "coordinator/coupling/transmission_parts.hpp"

namespace abut {

namespace {

/// Reciprocal condition below which rows say the same twice: at points where three bodies meet, or
/// where both sides are held.
constexpr double singular = 1.0e-13;
/// Of the largest pivot, below which a combination of rows moves nothing.
constexpr double nothing = 1.0e-10;
/// [B] of the answers to a probe, about.
constexpr double reply_bytes = 3.2e7;

/// Share of cell i of `here` equal cells that cell k of `there` cells of the same time takes: W of
/// [M.107].
double shared(int i, int here, int k, int there) {
  const double begin = std::max(i / static_cast<double>(here), k / static_cast<double>(there));
  const double end =
      std::min((i + 1) / static_cast<double>(here), (k + 1) / static_cast<double>(there));
  return std::max(0.0, end - begin) * here;
}

Eigen::Map<const Eigen::VectorXd> vector_of(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

void TieNet::begin(const Island& island, std::span<const Joint> joints,
                   std::span<const Eigen::Index> first, Bodies& bodies) {
  find_members(island, joints, first);
  if (members_.empty()) return;
  find_parts(bodies);
  std::vector<int> pattern;
  for (const Part& part : parts_) pattern.insert(pattern.end(), {part.body, part.steps});
  for (const Member& member : members_) pattern.insert(pattern.end(), {member.steps, member.width});
  if (pattern != pattern_) blocks_.clear();
  pattern_ = pattern;
  const int wanted = std::min(count_, lags_that_fit(count_));
  if (static_cast<int>(blocks_.size()) < wanted) {
    find_kernels(wanted, bodies);
    blocks_.clear();
    for (int lag = 0; lag < wanted; ++lag) find_block(lag);
    for (Part& part : parts_) part.kernel.clear();
    factor();
  }
  for (const Member& member : members_) {
    const auto own = blocks_[0].diagonal().segment(member.inner, member.width);
    member.tie->set_unit(own.maxCoeff() > 0.0 ? own.maxCoeff() : 1.0);
  }
}

void TieNet::find_members(const Island& island, std::span<const Joint> joints,
                          std::span<const Eigen::Index> first) {
  members_.clear();
  for (std::size_t i = 0; i < island.joints.size(); ++i) {
    const Joint& joint = joints[index(island.joints[i])];
    Tie* tie = joint.how->tie();
    if (tie == nullptr) continue;
    members_.push_back(
        {&joint, tie, first[i], 0, tie->rows().width(), 0, tie->grid(joint.kinematic).count});
  }
}

void TieNet::find_parts(const Bodies& bodies) {
  parts_.clear();
  count_ = 0;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    for (const int s : {0, 1}) {
      const int body = members_[m].joint->sides[index(s)].body;
      auto part = std::ranges::find(parts_, body, &Part::body);
      if (part == parts_.end()) {
        parts_.push_back({body, members_[m].tie->grid(s).count, 0, {}, {}});
        part = parts_.end() - 1;
        if (bodies.describe(body).can.kernel) count_ = std::gcd(count_, part->steps);
      }
      part->ends.push_back({m, s, part->width});
      part->width += members_[m].width;
    }
  }
  for (const Member& member : members_) count_ = std::gcd(count_, member.total);
  for (Part& part : parts_) part.steps = std::max(1, part.steps / count_);
  size_ = 0;
  for (Member& member : members_) {
    member.steps = member.total / count_;
    member.inner = size_;
    size_ += Eigen::Index{member.width} * member.steps;
  }
}

/// Blocks that kernels and their products may be kept for; at least one.
int TieNet::lags_that_fit(int blocks) const {
  double each = 8.0 * static_cast<double>(size_) * static_cast<double>(size_);
  for (const Part& part : parts_)
    each += 8.0 * part.steps * static_cast<double>(part.width) * static_cast<double>(part.width);
  const double fit = largest_ / each - 1.0;  // the factors
  return fit >= blocks ? blocks : std::max(1, static_cast<int>(fit));
}

void TieNet::find_kernels(int lags, Bodies& bodies) {
  for (Part& part : parts_) {
    part.kernel.clear();
    if (!bodies.describe(part.body).can.kernel) continue;
    part.kernel.assign(index(part.steps * lags), Eigen::MatrixXd::Zero(part.width, part.width));
    std::vector<int> seen;
    for (const End& end : part.ends)
      seen.push_back(members_[end.member].joint->sides[index(end.side)].port);
    std::ranges::sort(seen);
    seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
    for (const End& by : part.ends) press(part, by, seen, bodies);
  }
}

/// Answers to unit forces of the rows of one end, so many in a request that its reply is no burden.
void TieNet::press(Part& part, const End& by, std::span<const int> seen, Bodies& bodies) const {
  const Member& pressed = members_[by.member];
  const Side& side = pressed.joint->sides[index(by.side)];
  const TieRows& rows = pressed.tie->rows();
  const std::size_t width = bodies.port(side).geometry.points.size();
  std::size_t values = 0;
  for (const int port : seen) values += bodies.port({part.body, port}).geometry.points.size();
  const int steps = static_cast<int>(part.kernel.size());
  const double each = 8.0 * steps * static_cast<double>(values);
  const int at_once = std::clamp(static_cast<int>(reply_bytes / each), 1, pressed.width);
  for (int from = 0; from < pressed.width; from += at_once) {
    const int count = std::min(at_once, pressed.width - from);
    std::vector<double> patterns(index(count) * width, 0.0);
    for (int k = 0; k < count; ++k) {
      std::vector<double> unit(index(pressed.width), 0.0);
      unit[index(from + k)] = 1.0;
      add_transposed(rows.of[index(by.side)], rows.dim, 1.0, unit,
                     std::span(patterns).subspan(index(k) * width, width));
    }
    const PortKernel kernel = bodies.probe(part.body, side.port, patterns, steps, seen);
    read(part, by, from, kernel, seen, bodies);
  }
}

/// Columns of a body's kernel from one on, out of what its ports answered.
void TieNet::read(Part& part, const End& by, int from, const PortKernel& kernel,
                  std::span<const int> seen, const Bodies& bodies) const {
  std::vector<double> moved;
  const double* values = kernel.displacement.data();
  for (Eigen::MatrixXd& later : part.kernel) {
    for (int k = 0; k < kernel.patterns; ++k) {
      for (const int port : seen) {
        const std::size_t width = bodies.port({part.body, port}).geometry.points.size();
        for (const End& end : part.ends) {
          const Member& member = members_[end.member];
          if (member.joint->sides[index(end.side)].port != port) continue;
          const TieRows& rows = member.tie->rows();
          moved.resize(index(member.width));
          apply(rows.of[index(end.side)], rows.dim, std::span(values, width), moved);
          later.col(by.first + from + k).segment(end.first, member.width) = vector_of(moved);
        }
        values += width;
      }
    }
  }
}

void TieNet::find_block(int lag) {
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size_, size_);
  for (const Part& part : parts_) {
    if (part.kernel.empty()) continue;
    for (const End& of : part.ends)
      for (const End& by : part.ends) add(part, of, by, lag, block);
  }
  blocks_.push_back(std::move(block));
}

/// What forces of one joint in the first block do to the rows of another so many blocks later,
/// through one body: motion is read at the ends of the force's steps, linear between the body's.
void TieNet::add(const Part& part, const End& of, const End& by, int lag,
                 Eigen::MatrixXd& block) const {
  const Member &row = members_[of.member], &column = members_[by.member];
  const auto sign = [](const Member& member, const End& end) {
    return end.side == member.joint->kinematic ? 1.0 : -1.0;
  };
  const double turn = sign(row, of) * sign(column, by);
  for (int k = 0; k < row.steps; ++k) {
    const double place = (lag + (k + 1) / static_cast<double>(row.steps)) * part.steps;
    const int whole = static_cast<int>(std::floor(place + 1.0e-9));
    const double share = std::max(0.0, place - whole);
    for (int a = 0; a < column.steps; ++a) {
      auto to = block.block(row.inner + Eigen::Index{k} * row.width,
                            column.inner + Eigen::Index{a} * column.width, row.width, column.width);
      for (int i = 0; i < part.steps; ++i) {
        const double part_of = turn * shared(i, part.steps, a, column.steps);
        if (part_of == 0.0) continue;
        for (const auto& [later, weight] :
             {std::pair(whole - 1 - i, 1.0 - share), std::pair(whole - i, share)}) {
          if (later < 0 || weight < 1.0e-9 || index(later) >= part.kernel.size()) continue;
          to += part_of * weight *
                part.kernel[index(later)].block(of.first, by.first, row.width, column.width);
        }
      }
    }
  }
}

void TieNet::factor() {
  factors_.compute(blocks_[0]);
  inverse_.resize(0, 0);
  // Not by rcond(): of a matrix without some pivots its estimate is any number.
  const Eigen::ArrayXd pivots = factors_.matrixLU().diagonal().array().abs();
  if (pivots.minCoeff() > singular * pivots.maxCoeff()) return;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> least;
  least.setThreshold(nothing);
  inverse_ = least.compute(blocks_[0]).pseudoInverse();
}

/// Forces that make up for jumps; both (blocks, size).
Eigen::VectorXd TieNet::solve(const Eigen::VectorXd& jump) const {
  Eigen::VectorXd force(jump.size());
  for (int m = 0; m < count_; ++m) {
    Eigen::VectorXd left = jump.segment(m * size_, size_);
    for (int lag = 1; lag <= m && index(lag) < blocks_.size(); ++lag)
      left -= blocks_[index(lag)] * force.segment((m - lag) * size_, size_);
    if (inverse_.size() > 0) {
      force.segment(m * size_, size_) = inverse_ * left;
    } else {
      force.segment(m * size_, size_) = factors_.solve(left);
    }
  }
  return force;
}

void TieNet::predict(Eigen::VectorXd& x) const {
  if (members_.empty()) return;
  Eigen::VectorXd jump(count_ * size_);
  for (const Member& member : members_) {
    if (member.tie->trial().size() == 0) return;
    spread(member, member.tie->trial(), jump);
  }
  const Eigen::VectorXd force = -solve(jump);
  for (const Member& member : members_)
    gather(member, force, x.segment(member.first, values_of(member)));
}

void TieNet::apply_inverse(Eigen::VectorXd& r) const {
  if (members_.empty()) return;
  Eigen::VectorXd jump(count_ * size_);
  for (const Member& member : members_)
    spread(member, member.tie->unit() * r.segment(member.first, values_of(member)), jump);
  const Eigen::VectorXd force = solve(jump);
  for (const Member& member : members_)
    gather(member, force, r.segment(member.first, values_of(member)));
}

/// From a joint's own list (steps, rows) to that of blocks, and back.
void TieNet::spread(const Member& member, const Eigen::VectorXd& own, Eigen::VectorXd& all) const {
  const Eigen::Index length = Eigen::Index{member.width} * member.steps;
  for (int m = 0; m < count_; ++m)
    all.segment(m * size_ + member.inner, length) = own.segment(m * length, length);
}

void TieNet::gather(const Member& member, const Eigen::VectorXd& all,
                    Eigen::Ref<Eigen::VectorXd> own) const {
  const Eigen::Index length = Eigen::Index{member.width} * member.steps;
  for (int m = 0; m < count_; ++m)
    own.segment(m * length, length) = all.segment(m * size_ + member.inner, length);
}

}  // namespace abut
