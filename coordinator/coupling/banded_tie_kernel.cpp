#include "coordinator/coupling/banded_tie_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>

#include "coordinator/coupling/tie_probes.hpp"

namespace abut {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Entries so small beside those of their row and column on the diagonal are round-off.
constexpr double roundoff = 1.0e-14;
/// Of the first block's equations, relative. What is left is for the next call of the bodies.
constexpr double tolerance = 1.0e-13;
/// The same, of what an iteration that ended before has answered.
constexpr double good_enough = 1.0e-3;
/// 6 to 40 are usual, 150 where rows say the same twice.
constexpr int most_iterations = 500;
/// Of the diagonal, added to it: what combinations of rows that move nothing, where they say the
/// same twice, take of round-off is bounded then; and where these contradict each other, which
/// the iteration cannot answer with so little.
constexpr double softness[] = {1.0e-10, 1.0e-6};

int dim_of(const TieLayout& layout) { return layout.members.front().tie->rows().dim; }

/// [m/N] of a body: for every pair of rows that a force reaches (steps from the first, dim, dim).
struct BandedResponses {
  TieBand band;
  int steps = 0;
  std::vector<std::size_t> at;  // by pair
  std::vector<double> values;
};

BandedResponses banded_responses(const TieLayout& layout, const TieLayout::Part& part,
                                 const TieBandWidth& width, int steps, Bodies& bodies) {
  BandedResponses own{make_tie_band(layout, part, width, steps, bodies), steps, {}, {}};
  const int dim = dim_of(layout);
  std::size_t total = 0;
  for (const TieBand::Reached& r : own.band.reached) {
    own.at.push_back(total);
    total += index((steps - r.from) * dim * dim);
  }
  own.values.assign(total, 0.0);
  for (std::size_t e = 0; e < part.ends.size(); ++e) {
    const TieLayout::End& by = part.ends[e];
    const int first = static_cast<int>(by.first) / dim, count = layout.rows(by).count();
    std::vector<std::vector<int>> pressed(index(own.band.colours[e]));  // rows by colour
    for (int r = 0; r < count; ++r) pressed[own.band.colour[index(first + r)]].push_back(r);
    const auto fill = [&](int pattern, std::span<double> forces) {
      for (const int r : pressed[pattern / dim]) forces[r * dim + pattern % dim] = 1.0;
    };
    const auto take = [&](int pattern, int later, const TieLayout::End& of,
                          std::span<const double> moved) {
      const int begin = static_cast<int>(of.first) / dim, end = begin + layout.rows(of).count();
      for (const int r : pressed[pattern / dim]) {
        for (std::size_t p = own.band.offsets[first + r];
             p < own.band.offsets[index(first + r) + 1]; ++p) {
          const auto [row, from] = own.band.reached[p];
          if (row < begin || row >= end || later < from) continue;
          double* to = &own.values[own.at[p] + index((later - from) * dim * dim + pattern % dim)];
          for (int d = 0; d < dim; ++d) to[d * dim] = moved[(row - begin) * dim + d];
        }
      }
    };
    press(layout, part, by, dim * own.band.colours[e], steps, fill, take, bodies);
  }
  return own;
}

/// What forces of one joint in the first block do to the rows of another so many blocks later,
/// through one body.
void add_banded(const TieLayout& layout, const TieLayout::Part& part,
                const BandedResponses& responses, const TieLayout::End& of,
                const TieLayout::End& by, int lag, Triplets& block) {
  const TieLayout::Member& row = layout.members[of.member];
  const TieLayout::Member& column = layout.members[by.member];
  const int dim = dim_of(layout), rows = row.width / dim;
  const int first = static_cast<int>(by.first) / dim, begin = static_cast<int>(of.first) / dim;
  for (const TieLayout::Share& share : layout.shares(part, of, by, lag, responses.steps)) {
    for (int c = 0; c < column.width / dim; ++c) {
      const std::size_t pressed = index(first + c);
      for (std::size_t p = responses.band.offsets[pressed]; p < responses.band.offsets[pressed + 1];
           ++p) {
        const auto [r, from] = responses.band.reached[p];
        if (r < begin || r >= begin + rows || share.later < from) continue;
        const double* value =
            &responses.values[responses.at[p] + index((share.later - from) * dim * dim)];
        const Eigen::Index i = row.inner + share.of * row.width + (r - begin) * dim;
        const Eigen::Index j = column.inner + share.by * column.width + c * dim;
        for (int k = 0; k < dim * dim; ++k)
          if (value[k] != 0.0)
            block.emplace_back(static_cast<int>(i) + k / dim, static_cast<int>(j) + k % dim,
                               share.weight * value[k]);
      }
    }
  }
}

/// The first block is answered by iterations: forces of far rows hardly feel each other, so that
/// their number does not grow with the face, whose factors would fill.
class BandedTieKernel final : public TieKernel {
 public:
  BandedTieKernel(const TieLayout& layout, const TieBandWidth& width, int lags, Bodies& bodies);
  Eigen::VectorXd diagonal() const override { return blocks_[0].diagonal(); }
  Eigen::Index size() const override { return blocks_[0].rows(); }
  int lags() const override { return static_cast<int>(blocks_.size()); }
  bool renew(const TieLayout&, Bodies&) override { return false; }
  void turn(const TieLayout&) override {}
  std::vector<double> answers() const override { return {}; }
  void take(const TieLayout&, std::span<const double>) override {}

 private:
  void subtract(int lag, const Eigen::Ref<const Eigen::VectorXd>& force,
                Eigen::VectorXd& left) const override {
    left -= blocks_[lag] * force;
  }
  Eigen::VectorXd invert(const Eigen::VectorXd& jump) const override;
  /// It is not known: the iteration finds an answer where there is one.
  bool redundant() const override { return true; }

  std::vector<Sparse> blocks_;      // [m/N] by lag
  std::array<Sparse, 2> softened_;  // the first block
  std::array<Eigen::BiCGSTAB<Sparse>, 2> first_;
};

BandedTieKernel::BandedTieKernel(const TieLayout& layout, const TieBandWidth& width, int lags,
                                 Bodies& bodies) {
  std::vector<BandedResponses> responses(layout.parts.size());
  for (std::size_t p = 0; p < responses.size(); ++p) {
    const TieLayout::Part& part = layout.parts[p];
    if (!part.stands)
      responses[p] = banded_responses(layout, part, width, part.steps * lags, bodies);
  }
  Eigen::VectorXd scale;
  for (int lag = 0; lag < lags; ++lag) {
    Triplets entries;
    for (std::size_t p = 0; p < responses.size(); ++p) {
      const TieLayout::Part& part = layout.parts[p];
      if (part.stands) continue;
      for (const TieLayout::End& of : part.ends)
        for (const TieLayout::End& by : part.ends)
          add_banded(layout, part, responses[p], of, by, lag, entries);
    }
    layout.give_way(lag, [&entries](Eigen::Index of, Eigen::Index by, double value) {
      entries.emplace_back(static_cast<int>(of), static_cast<int>(by), value);
    });
    Sparse& block = blocks_.emplace_back(layout.size, layout.size);
    block.setFromTriplets(entries.begin(), entries.end());
    if (lag == 0) scale = block.diagonal().cwiseAbs().cwiseSqrt();
    block.prune([&scale](Eigen::Index i, Eigen::Index j, double value) {
      return std::abs(value) > roundoff * scale[i] * scale[j];
    });
  }
  // What does not give way at all has equations of its own.
  const double most = scale.maxCoeff() > 0.0 ? scale.maxCoeff() : 1.0;
  for (const std::size_t k : {0u, 1u}) {
    Sparse own(layout.size, layout.size);
    own.setIdentity();
    for (Eigen::Index i = 0; i < layout.size; ++i)
      own.coeffRef(i, i) = scale[i] > 0.0 ? softness[k] * scale[i] * scale[i] : most * most;
    softened_[k] = blocks_[0] + own;
    first_[k].setTolerance(tolerance);
    first_[k].setMaxIterations(most_iterations);
    first_[k].compute(softened_[k]);
  }
}

/// Iterations that break down have still every row's share for itself.
Eigen::VectorXd BandedTieKernel::invert(const Eigen::VectorXd& jump) const {
  for (const std::size_t k : {0u, 1u}) {
    const Eigen::VectorXd force = first_[k].solve(jump);
    if (force.allFinite() && (softened_[k] * force - jump).norm() <= good_enough * jump.norm())
      return force;
  }
  return jump.cwiseQuotient(softened_[1].diagonal());
}

}  // namespace

std::unique_ptr<TieKernel> make_banded_tie_kernel(const TieLayout& layout,
                                                  const TieBandWidth& width, int lags,
                                                  Bodies& bodies) {
  return std::make_unique<BandedTieKernel>(layout, width, lags, bodies);
}

}  // namespace abut
