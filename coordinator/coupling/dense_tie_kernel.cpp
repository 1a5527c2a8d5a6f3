#include <utility>
#include <vector>

#include "coordinator/coupling/tie_kernel.hpp"
#include "coordinator/coupling/tie_probes.hpp"

namespace abut {

namespace {

/// Reciprocal condition below which rows say the same twice: at points where three bodies meet, or
/// where both sides are held.
constexpr double singular = 1.0e-13;
/// Of the largest pivot, below which a combination of rows moves nothing.
constexpr double nothing = 1.0e-10;

/// [m/N] (steps) of (width, width): at the end of a step after a force in the first one.
using Responses = std::vector<Eigen::MatrixXd>;

class DenseTieKernel final : public TieKernel {
 public:
  DenseTieKernel(const TieLayout& layout, int lags, Bodies& bodies);
  Eigen::VectorXd diagonal() const override { return blocks_[0].diagonal(); }
  Eigen::Index size() const override { return blocks_[0].rows(); }
  int lags() const override { return static_cast<int>(blocks_.size()); }
  double bytes() const override {
    return 8.0 * static_cast<double>(blocks_.size() + 1) * static_cast<double>(blocks_[0].size());
  }

 private:
  void subtract(int lag, const Eigen::Ref<const Eigen::VectorXd>& force,
                Eigen::VectorXd& left) const override {
    left -= blocks_[index(lag)] * force;
  }
  Eigen::VectorXd invert(const Eigen::VectorXd& jump) const override;

  std::vector<Eigen::MatrixXd> blocks_;  // [m/N] by lag
  // Of the first block: factors, or where rows are redundant the inverse of least size.
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  Eigen::MatrixXd inverse_;
};

/// Of unit forces of the rows, one by one.
Responses responses_of(const TieLayout& layout, const TieLayout::Part& part, int steps,
                       Bodies& bodies) {
  Responses responses(index(steps), Eigen::MatrixXd::Zero(part.width, part.width));
  for (const TieLayout::End& by : part.ends) {
    const auto unit = [](int k, std::span<double> forces) { forces[index(k)] = 1.0; };
    const auto take = [&](int k, int later, const TieLayout::End& of,
                          std::span<const double> moved) {
      const auto count = static_cast<Eigen::Index>(moved.size());
      responses[index(later)].col(by.first + k).segment(of.first, count) =
          Eigen::Map<const Eigen::VectorXd>(moved.data(), count);
    };
    press(layout, part, by, layout.members[by.member].width, steps, unit, take, bodies);
  }
  return responses;
}

/// What forces of one joint in the first block do to the rows of another so many blocks later,
/// through one body.
void add(const TieLayout& layout, const TieLayout::Part& part, const Responses& responses,
         const TieLayout::End& of, const TieLayout::End& by, int lag, Eigen::MatrixXd& block) {
  const TieLayout::Member& row = layout.members[of.member];
  const TieLayout::Member& column = layout.members[by.member];
  for (const TieLayout::Share& share :
       layout.shares(part, of, by, lag, static_cast<int>(responses.size()))) {
    block.block(row.inner + Eigen::Index{share.of} * row.width,
                column.inner + Eigen::Index{share.by} * column.width, row.width, column.width) +=
        share.weight *
        responses[index(share.later)].block(of.first, by.first, row.width, column.width);
  }
}

DenseTieKernel::DenseTieKernel(const TieLayout& layout, int lags, Bodies& bodies) {
  std::vector<Responses> responses;
  for (const TieLayout::Part& part : layout.parts)
    responses.push_back(part.stands ? Responses()
                                    : responses_of(layout, part, part.steps * lags, bodies));
  for (int lag = 0; lag < lags; ++lag) {
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(layout.size, layout.size);
    for (std::size_t p = 0; p < layout.parts.size(); ++p) {
      const TieLayout::Part& part = layout.parts[p];
      if (part.stands) continue;
      for (const TieLayout::End& of : part.ends)
        for (const TieLayout::End& by : part.ends)
          add(layout, part, responses[p], of, by, lag, block);
    }
    blocks_.push_back(std::move(block));
  }
  factors_.compute(blocks_[0]);
  if (factors_.rcond() > singular) return;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> least;
  least.setThreshold(nothing);
  inverse_ = least.compute(blocks_[0]).pseudoInverse();
}

Eigen::VectorXd DenseTieKernel::invert(const Eigen::VectorXd& jump) const {
  if (inverse_.size() > 0) return inverse_ * jump;
  return factors_.solve(jump);
}

}  // namespace

std::unique_ptr<TieKernel> make_dense_tie_kernel(const TieLayout& layout, int lags,
                                                 Bodies& bodies) {
  return std::make_unique<DenseTieKernel>(layout, lags, bodies);
}

}  // namespace abut
