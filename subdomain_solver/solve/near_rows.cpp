#include "subdomain_solver/solve/near_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "subdomain_solver/solve/friction_row.hpp"

namespace abut {

namespace {

/// Of a row's own block, and of how far a point moves that is pressed itself: smaller ones are left
/// out. Finer matrices cost more than the rounds that they save.
constexpr double least_block = 1.0e-2, least_motion = 2.0e-2;
/// Of a row's normal compliance, as soften_held has it.
constexpr double least_tangent = 1.0e-9;
/// Of the largest of all rows, as soften_unmoved has it.
constexpr double least_normal = 1.0e-12;

double largest_entry(const double* block, int count) {
  double most = 0.0;
  for (int k = 0; k < count; ++k) most = std::max(most, std::abs(block[k]));
  return most;
}

/// The points that a point moves more than a little, and by how much.
struct Motions {
  std::vector<std::size_t> offsets;   // (points + 1)
  std::vector<std::int32_t> reached;  // points
  std::vector<double> moved;          // [m/N] (reached, dim, dim) as blocks of a kernel

  explicit Motions(const PressedSide& side) {
    const std::size_t dim = index(side.dim);
    const KernelBand& band = side.near->band;
    std::vector<double> sizes;
    offsets.assign(1, 0);
    for (std::size_t p = 0; p < side.points; ++p) {
      const std::size_t count = band.empty() ? side.points : band.of(p).size();
      const auto point = [&](std::size_t e) { return band.empty() ? e : index(band.of(p)[e]); };
      const auto at = [&](std::size_t e, std::size_t j) {
        return band.empty() ? side.moved.data() + ((p * dim + j) * side.points + e) * dim
                            : side.moved.data() + ((index(band.offsets[p]) + e) * dim + j) * dim;
      };
      double own = 0.0;
      sizes.assign(count, 0.0);
      for (std::size_t e = 0; e < count; ++e) {
        for (std::size_t j = 0; j < dim; ++j)
          sizes[e] = std::max(sizes[e], largest_entry(at(e, j), static_cast<int>(dim)));
        if (point(e) == p) own = sizes[e];
      }
      for (std::size_t e = 0; e < count; ++e) {
        if (sizes[e] < least_motion * own || own == 0.0) continue;
        reached.push_back(static_cast<std::int32_t>(point(e)));
        for (std::size_t j = 0; j < dim; ++j) moved.insert(moved.end(), at(e, j), at(e, j) + dim);
      }
      offsets.push_back(reached.size());
    }
  }
};

/// A side while rows are gone through: what a row's components move along at a point, by rows and
/// by points, and what one row moves. `Parts`: the most that a row has.
template <int Dim, int Parts>
class SideAnswer {
 public:
  using Motion = Eigen::Matrix<double, Dim, Parts>;

  SideAnswer(const PressedSide& side, std::span<const FrictionRow> rows)
      : side_(side), motions_(side), moved_(side.points), mark_(side.points, 0) {
    begins_.assign(1, 0);
    std::vector<std::size_t> entry(side.points, 0);
    first_.assign(side.points + 1, 0);
    for (const FrictionRow& row : rows) {
      for (int p = 0; has(row) && p < row.parts; ++p)
        for (const PressedSide::Term& term : terms(row, p)) {
          const std::size_t point = index(term.value / Dim);
          if (entry[point] <= begins_.back()) {  // the row's first term there
            along_.push_back({static_cast<std::int32_t>(point), Motion::Zero()});
            entry[point] = along_.size();
            ++first_[point + 1];
          }
          along_[entry[point] - 1].factors(term.value % Dim, p) += term.factor;
        }
      begins_.push_back(along_.size());
    }
    for (std::size_t p = 0; p < side.points; ++p) first_[p + 1] += first_[p];
    at_points_.resize(along_.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t k = begins_[r]; k < begins_[r + 1]; ++k)
        at_points_[next[index(along_[k].point)]++] = {static_cast<std::int32_t>(r),
                                                      static_cast<std::int32_t>(k)};
  }

  /// A row presses: calls `see` with rows that feel it and what opens them, (Parts, Parts), more
  /// than once for a row or not.
  template <class See>
  void press(std::size_t r, const See& see) {
    reached_.clear();
    for (std::size_t k = begins_[r]; k < begins_[r + 1]; ++k) move(along_[k]);
    for (const std::int32_t q : reached_) {
      mark_[index(q)] = 0;
      for (std::size_t k = first_[index(q)]; k < first_[index(q) + 1]; ++k)
        see(at_points_[k].row,
            along_[index(at_points_[k].entry)].factors.transpose() * moved_[index(q)]);
    }
  }

 private:
  struct Along {
    std::int32_t point;
    Motion factors;
  };
  struct AtPoint {
    std::int32_t row, entry;
  };
  using Block = Eigen::Map<const Eigen::Matrix<double, Dim, Dim>>;

  bool has(const FrictionRow& row) const {
    return row.first >= side_.first &&
           row.first < side_.first + static_cast<Eigen::Index>(side_.components());
  }
  std::span<const PressedSide::Term> terms(const FrictionRow& row, int part) const {
    return side_.of(index(row.first - side_.first + part));
  }
  void move(const Along& by) {
    for (std::size_t e = motions_.offsets[index(by.point)];
         e < motions_.offsets[index(by.point) + 1]; ++e) {
      const std::size_t q = index(motions_.reached[e]);
      const Block block(motions_.moved.data() + e * Dim * Dim);
      if (std::exchange(mark_[q], 1) == 0) {
        reached_.push_back(motions_.reached[e]);
        moved_[q].noalias() = block * by.factors;
      } else {
        moved_[q].noalias() += block * by.factors;
      }
    }
  }

  const PressedSide& side_;
  Motions motions_;
  std::vector<Along> along_;
  std::vector<std::size_t> begins_;  // (rows + 1) of a row's entries in along_
  std::vector<std::size_t> first_;   // (points + 1) of a point's entries in at_points_
  std::vector<AtPoint> at_points_;
  std::vector<Motion> moved_;  // [m/N] (points)
  std::vector<char> mark_;     // (points) 1: reached
  std::vector<std::int32_t> reached_;
};

/// What soften_held adds to a row's tangents.
template <class Square>
double softness_of(const Square& a, int parts) {
  if (parts == 1) return 0.0;
  double stiffest = a(1, 1);
  if (parts == 3)
    stiffest = 0.5 * (a(1, 1) + a(2, 2)) - std::hypot(0.5 * (a(1, 1) - a(2, 2)), a(1, 2));
  const double soft = least_tangent * a(0, 0);
  return stiffest >= soft ? 0.0 : soft;
}

/// As of one matrix.
void soften_unmoved(NearBlocks& rows) {
  double most = 0.0;
  for (const std::size_t own : rows.own) most = std::max(most, rows.blocks[rows.begins[own]]);
  for (const std::size_t own : rows.own)
    if (double& normal = rows.blocks[rows.begins[own]]; normal < least_normal * most)
      normal += most;
}

template <int Dim, int Parts>
NearBlocks blocks_of(std::span<const FrictionRow> rows, std::span<const PressedSide> sides) {
  using Square = Eigen::Matrix<double, Parts, Parts>;
  std::vector<SideAnswer<Dim, Parts>> answers;
  for (const PressedSide& side : sides) answers.emplace_back(side, rows);
  NearBlocks out;
  out.offsets.assign(1, 0);
  std::vector<std::int32_t> felt, seen(rows.size(), -1);
  std::vector<Square> opened(rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int parts = rows[r].parts;
    const auto self = static_cast<std::int32_t>(r);
    felt.assign(1, self);
    seen[r] = self;
    opened[r].setZero();
    const auto feels = [&](std::int32_t row, const auto& block) {
      if (std::exchange(seen[index(row)], self) != self) {
        felt.push_back(row);
        opened[index(row)].noalias() = block;
      } else {
        opened[index(row)].noalias() += block;
      }
    };
    for (SideAnswer<Dim, Parts>& answer : answers) answer.press(r, feels);
    const double least = least_block * opened[r].template lpNorm<Eigen::Infinity>();
    std::ranges::sort(felt);
    for (const std::int32_t s : felt) {
      Square& block = opened[index(s)];
      const bool itself = index(s) == r;
      if (!itself && block.template lpNorm<Eigen::Infinity>() < least) continue;
      if (itself) {
        out.own.push_back(out.opened.size());
        out.soft.push_back(softness_of(block, parts));
        for (int p = 1; p < parts; ++p) block(p, p) += out.soft.back();
      }
      out.opened.push_back(s);
      out.begins.push_back(out.blocks.size());
      for (int j = 0; j < parts; ++j)
        for (int i = 0; i < rows[index(s)].parts; ++i) out.blocks.push_back(block(i, j));
    }
    out.offsets.push_back(out.opened.size());
  }
  soften_unmoved(out);
  return out;
}

}  // namespace

void PressedSide::press(const Vector& force, std::span<double> on) const {
  std::ranges::fill(on, 0.0);
  for (std::size_t c = 0; c < components(); ++c) {
    const double pressing = force(first + static_cast<Eigen::Index>(c));
    if (pressing == 0.0) continue;
    for (const Term& term : of(c)) on[index(term.value)] += term.factor * pressing;
  }
}

void PressedSide::open(std::span<const double> by, Vector& opened) const {
  for (std::size_t c = 0; c < components(); ++c) {
    double sum = 0.0;
    for (const Term& term : of(c)) sum += term.factor * by[index(term.value)];
    opened(first + static_cast<Eigen::Index>(c)) += sum;
  }
}

NearBlocks near_rows(std::span<const FrictionRow> rows, std::span<const PressedSide> sides) {
  const bool rubs = std::ranges::any_of(rows, [](const FrictionRow& row) { return row.parts > 1; });
  if (sides.front().dim == 2)
    return rubs ? blocks_of<2, 2>(rows, sides) : blocks_of<2, 1>(rows, sides);
  return rubs ? blocks_of<3, 3>(rows, sides) : blocks_of<3, 1>(rows, sides);
}

void turn(NearBlocks& near, std::span<const FrictionRow> rows, int dim,
          std::span<const double> before, std::span<const double> now, Vector& force) {
  using Axes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  std::vector<Axes> turns;
  for (const FrictionRow& row : rows) {
    const auto at = static_cast<std::ptrdiff_t>(row.first) * dim;
    const Eigen::Map<const Eigen::MatrixXd> old(before.data() + at, dim, row.parts),
        next(now.data() + at, dim, row.parts);
    turns.emplace_back(row.parts == 1 ? Axes(Axes::Identity(1, 1)) : Axes(next.transpose() * old));
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Vector turned_force = turns[r] * force.segment(rows[r].first, rows[r].parts);
    force.segment(rows[r].first, rows[r].parts) = turned_force;
    force(rows[r].first) = std::max(0.0, turned_force(0));
    for (std::size_t k = near.offsets[r]; k < near.offsets[r + 1]; ++k) {
      const std::size_t s = index(near.opened[k]);
      Eigen::Map<Eigen::MatrixXd> block(near.blocks.data() + near.begins[k], rows[s].parts,
                                        rows[r].parts);
      const Axes turned = turns[s] * block * turns[r].transpose();
      block = turned;
    }
  }
}

namespace {

/// rates += block moved, of `to` parts by `by` parts. Sizes that are known make one that rubs a
/// third of the work.
void follow(const double* block, int to, int by, const double* moved, double* rates) {
  if (to == 1 && by == 1) {
    rates[0] += block[0] * moved[0];
  } else if (to == 3 && by == 3) {
    for (int i = 0; i < 3; ++i)
      rates[i] += block[i] * moved[0] + block[3 + i] * moved[1] + block[6 + i] * moved[2];
  } else {
    for (int j = 0; j < by; ++j)
      for (int i = 0; i < to; ++i) rates[i] += block[j * to + i] * moved[j];
  }
}

/// The change [N] of the forces of a row that rubs, to those that fit its rates.
template <int Tangents>
void rub(const double* own, const FrictionRow& row, const Vector& rates, Vector& force,
         double* moved) {
  constexpr int parts = Tangents + 1;
  const Eigen::Map<const Eigen::Matrix<double, parts, parts>> block(own);
  const Eigen::Matrix<double, parts, 1> old = force.segment<parts>(row.first);
  Eigen::Matrix<double, parts, 1> rate;
  for (int i = 0; i < parts; ++i) {
    double sum = block(i, 0) * old(0);
    for (int j = 1; j < parts; ++j) sum += block(i, j) * old(j);
    rate(i) = rates(row.first + i) - sum;
  }
  OneRow<Tangents>(block, row)
      .solve(rate(0), rate.template tail<Tangents>(), force.segment<parts>(row.first));
  for (int p = 0; p < parts; ++p) moved[p] = force(row.first + p) - old(p);
}

}  // namespace

double relax(const NearBlocks& near, std::span<const FrictionRow> rows, Vector& rates,
             Vector& force) {
  double change = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const FrictionRow& row = rows[r];
    const double* own = near.blocks.data() + near.begins[near.own[r]];
    double moved[3] = {};
    if (row.parts == 1) {
      const double old = force(row.first);
      const double now = std::max(0.0, old - rates(row.first) / own[0]);
      moved[0] = now - old;
      force(row.first) = now;
    } else if (row.parts == 2) {
      rub<1>(own, row, rates, force, moved);
    } else {
      rub<2>(own, row, rates, force, moved);
    }
    const double most = largest_entry(moved, row.parts);
    if (most == 0.0) continue;
    change = std::max(change, most);
    for (std::size_t k = near.offsets[r]; k < near.offsets[r + 1]; ++k) {
      const FrictionRow& to = rows[index(near.opened[k])];
      follow(near.blocks.data() + near.begins[k], to.parts, row.parts, moved, &rates(to.first));
    }
  }
  return change;
}

bool too_slow(std::span<const double> changes) {
  constexpr std::size_t rounds = 8;
  constexpr double halved = 0.5;
  return changes.size() > rounds && changes.back() > halved * changes[changes.size() - 1 - rounds];
}

}  // namespace abut
