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
    const std::size_t dim = index(side.dim), each = dim * dim;
    const KernelBand& band = side.near->band;
    std::vector<double> block(each);
    offsets.assign(1, 0);
    for (std::size_t p = 0; p < side.points; ++p) {
      const std::size_t count = band.empty() ? side.points : band.of(p).size();
      const auto point = [&](std::size_t e) { return band.empty() ? e : index(band.of(p)[e]); };
      const auto at = [&](std::size_t e, std::size_t j) {
        return band.empty() ? side.moved.data() + ((p * dim + j) * side.points + e) * dim
                            : side.moved.data() + ((index(band.offsets[p]) + e) * dim + j) * dim;
      };
      const auto size = [&](std::size_t e) {
        double most = 0.0;
        for (std::size_t j = 0; j < dim; ++j)
          most = std::max(most, largest_entry(at(e, j), static_cast<int>(dim)));
        return most;
      };
      double own = 0.0;
      for (std::size_t e = 0; e < count; ++e)
        if (point(e) == p) own = size(e);
      for (std::size_t e = 0; e < count; ++e) {
        if (size(e) < least_motion * own || own == 0.0) continue;
        reached.push_back(static_cast<std::int32_t>(point(e)));
        for (std::size_t j = 0; j < dim; ++j) moved.insert(moved.end(), at(e, j), at(e, j) + dim);
      }
      offsets.push_back(reached.size());
    }
  }
};

/// A side while rows are gone through: rows by point, and what one row moves.
class SideAnswer {
 public:
  SideAnswer(const PressedSide& side, std::span<const FrictionRow> rows)
      : side_(side), dim_(index(side.dim)), motions_(side), mark_(side.points, 0) {
    moved_.assign(3 * side.points * dim_, 0.0);
    std::vector<std::int32_t> last(side.points, -1);
    const auto each = [&](const auto& see) {  // rows with a term at a point, each once
      std::ranges::fill(last, -1);
      for (std::size_t r = 0; r < rows.size(); ++r) {
        if (!has(rows[r])) continue;
        for (int p = 0; p < rows[r].parts; ++p)
          for (const PressedSide::Term& term : terms(rows[r], p)) {
            const std::size_t point = index(term.value) / dim_;
            if (std::exchange(last[point], static_cast<std::int32_t>(r)) !=
                static_cast<std::int32_t>(r))
              see(point, static_cast<std::int32_t>(r));
          }
      }
    };
    first_row_.assign(side.points + 1, 0);
    each([this](std::size_t point, std::int32_t) { ++first_row_[point + 1]; });
    for (std::size_t p = 0; p < side.points; ++p) first_row_[p + 1] += first_row_[p];
    rows_at_.resize(first_row_.back());
    std::vector<std::size_t> next(first_row_.begin(), first_row_.end() - 1);
    each([&](std::size_t point, std::int32_t row) { rows_at_[next[point]++] = row; });
  }

  /// The row presses: calls `see` with rows that feel it, more than once or not.
  template <class See>
  void press(const FrictionRow& row, const See& see) {
    for (const std::int32_t q : reached_) mark_[index(q)] = 0;
    reached_.clear();
    if (!has(row)) return;
    for (int p = 0; p < row.parts; ++p)
      for (const PressedSide::Term& term : terms(row, p)) move(index(p), index(row.parts), term);
    for (const std::int32_t q : reached_)
      for (std::size_t k = first_row_[index(q)]; k < first_row_[index(q) + 1]; ++k)
        see(rows_at_[k]);
  }

  /// Adds what opens a row, as (parts of it, parts of the one that presses).
  void add(const FrictionRow& row, int parts, double* block) const {
    if (!has(row)) return;
    for (int i = 0; i < row.parts; ++i)
      for (const PressedSide::Term& term : terms(row, i)) {
        if (mark_[index(term.value) / dim_] == 0) continue;
        for (int j = 0; j < parts; ++j)
          block[j * row.parts + i] += term.factor * moved_[at(index(j), index(term.value))];
      }
  }

 private:
  bool has(const FrictionRow& row) const {
    return row.first >= side_.first &&
           row.first < side_.first + static_cast<Eigen::Index>(side_.components());
  }
  std::span<const PressedSide::Term> terms(const FrictionRow& row, int part) const {
    return side_.of(index(row.first - side_.first + part));
  }
  std::size_t at(std::size_t part, std::size_t value) const {
    return part * side_.points * dim_ + value;
  }
  void move(std::size_t part, std::size_t parts, const PressedSide::Term& term) {
    const std::size_t point = index(term.value) / dim_, along = index(term.value) % dim_;
    for (std::size_t e = motions_.offsets[point]; e < motions_.offsets[point + 1]; ++e) {
      const std::size_t q = index(motions_.reached[e]);
      if (mark_[q] == 0) {
        mark_[q] = 1;
        reached_.push_back(motions_.reached[e]);
        for (std::size_t p = 0; p < parts; ++p)
          for (std::size_t i = 0; i < dim_; ++i) moved_[at(p, q * dim_ + i)] = 0.0;
      }
      const double* moved = motions_.moved.data() + (e * dim_ + along) * dim_;
      for (std::size_t i = 0; i < dim_; ++i)
        moved_[at(part, q * dim_ + i)] += term.factor * moved[i];
    }
  }

  const PressedSide& side_;
  std::size_t dim_;
  Motions motions_;
  std::vector<std::size_t> first_row_;  // (points + 1)
  std::vector<std::int32_t> rows_at_;   // by point
  std::vector<char> mark_;              // (points) 1: reached
  std::vector<std::int32_t> reached_;
  std::vector<double> moved_;  // (parts, points, dim)
};

/// What soften_held adds to a row's tangents.
double softness_of(const double* own, int parts) {
  if (parts == 1) return 0.0;
  const auto a = [own, parts](int i, int j) { return own[j * parts + i]; };
  double stiffest = a(1, 1);
  if (parts == 3)
    stiffest = 0.5 * (a(1, 1) + a(2, 2)) - std::hypot(0.5 * (a(1, 1) - a(2, 2)), a(1, 2));
  const double soft = least_tangent * a(0, 0);
  return stiffest >= soft ? 0.0 : soft;
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
  std::vector<SideAnswer> answers;
  for (const PressedSide& side : sides) answers.emplace_back(side, rows);
  NearBlocks out;
  out.offsets.assign(1, 0);
  std::vector<std::int32_t> felt, seen(rows.size(), -1);
  std::vector<double> block;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const int parts = rows[r].parts;
    felt.clear();
    const auto feels = [&](std::int32_t row) {
      if (std::exchange(seen[index(row)], static_cast<std::int32_t>(r)) !=
          static_cast<std::int32_t>(r))
        felt.push_back(row);
    };
    feels(static_cast<std::int32_t>(r));
    for (SideAnswer& answer : answers) answer.press(rows[r], feels);
    std::ranges::sort(felt);
    double least = 0.0;
    const auto find = [&](std::int32_t s) {
      block.assign(index(rows[index(s)].parts * parts), 0.0);
      for (const SideAnswer& answer : answers) answer.add(rows[index(s)], parts, block.data());
    };
    find(static_cast<std::int32_t>(r));
    least = least_block * largest_entry(block.data(), parts * parts);
    for (const std::int32_t s : felt) {
      find(s);
      const bool itself = index(s) == r;
      if (!itself && largest_entry(block.data(), static_cast<int>(block.size())) < least) continue;
      if (itself) {
        out.own.push_back(out.opened.size());
        out.soft.push_back(softness_of(block.data(), parts));
        for (int p = 1; p < parts; ++p) block[index(p * parts + p)] += out.soft.back();
      }
      out.opened.push_back(s);
      out.begins.push_back(out.blocks.size());
      out.blocks.insert(out.blocks.end(), block.begin(), block.end());
    }
    out.offsets.push_back(out.opened.size());
  }
  return out;
}

void turn(NearBlocks& near, std::span<const FrictionRow> rows, int dim,
          std::span<const double> before, std::span<const double> now) {
  using Axes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  std::vector<Axes> turns;
  for (const FrictionRow& row : rows) {
    const auto at = static_cast<std::ptrdiff_t>(row.first) * dim;
    const Eigen::Map<const Eigen::MatrixXd> old(before.data() + at, dim, row.parts),
        next(now.data() + at, dim, row.parts);
    turns.emplace_back(row.parts == 1 ? Axes(Axes::Identity(1, 1)) : Axes(next.transpose() * old));
  }
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t k = near.offsets[r]; k < near.offsets[r + 1]; ++k) {
      const std::size_t s = index(near.opened[k]);
      Eigen::Map<Eigen::MatrixXd> block(near.blocks.data() + near.begins[k], rows[s].parts,
                                        rows[r].parts);
      const Axes turned = turns[s] * block * turns[r].transpose();
      block = turned;
    }
}

double relax(const NearBlocks& near, std::span<const FrictionRow> rows, Vector& rates,
             Vector& force) {
  double change = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const FrictionRow& row = rows[r];
    const Eigen::Index parts = row.parts;
    const double* own = near.blocks.data() + near.begins[near.own[r]];
    double moved[3] = {};
    if (parts == 1) {
      const double old = force(row.first);
      const double now = std::max(0.0, old - rates(row.first) / own[0]);
      moved[0] = now - old;
      force(row.first) = now;
    } else {
      const Eigen::Map<const Eigen::MatrixXd> block(own, parts, parts);
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> old = force.segment(row.first, parts);
      const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> rate =
          rates.segment(row.first, parts) - block * old;
      OneRow(block, row).solve(rate(0), rate.tail(parts - 1), force.segment(row.first, parts));
      for (Eigen::Index p = 0; p < parts; ++p) moved[p] = force(row.first + p) - old(p);
    }
    const double most = largest_entry(moved, row.parts);
    if (most == 0.0) continue;
    change = std::max(change, most);
    for (std::size_t k = near.offsets[r]; k < near.offsets[r + 1]; ++k) {
      const FrictionRow& to = rows[index(near.opened[k])];
      const double* block = near.blocks.data() + near.begins[k];
      for (Eigen::Index j = 0; j < parts; ++j)
        for (Eigen::Index i = 0; i < to.parts; ++i)
          rates(to.first + i) += block[j * to.parts + i] * moved[j];
    }
  }
  return change;
}

}  // namespace abut
