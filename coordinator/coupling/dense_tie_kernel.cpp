#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/dense.hpp"
#include "coordinator/coupling/tie_kernel.hpp"
#include "coordinator/coupling/tie_probes.hpp"

namespace abut {

namespace {

/// Pivots of rows that say the same twice, at points where three bodies meet, or where both sides
/// are held; in units of their joints. Nodes that meet up to a share d of an edge, as the digits of
/// a file tell them, leave d^2 of such rows: they would have forces 1/d times as large as others.
struct Rounding {
  double singular = 1.0e-8;  // of the largest, below which there may be such
  double nothing = 1.0e-9;   // below which a combination of rows moves nothing
};
/// Of kernels that are differences of motions under a light push.
constexpr Rounding light{1.0e-7, 1.0e-6};
/// Of the softest row of its joint, below which a row is one of those; what gives way more, as
/// nodes with mass do in short steps beside one without, is of its own size.
constexpr double digits = 1.0e-9;
/// Of the softest row: below it a row does not give way.
constexpr double stiffest = 1.0e-18;
/// Of what the rows beside it do to a row, squared over their own, below which its own does not
/// count: no symmetric kernel comes near it.
constexpr double lopsided = 1.0e-6;

/// [rad] about, by which ports turn before kernels follow; and of their entries, so many that
/// nothing is noticed of the time it takes.
constexpr double noticed_turn = 5.0e-3, most_turned = 1.0e6;

/// [m/N] (steps) of (width, width): at the end of a step after a force in the first one.
using Responses = std::vector<Eigen::MatrixXd>;

class DenseTieKernel final : public TieKernel {
 public:
  DenseTieKernel(const TieLayout& layout, int lags, Bodies& bodies);
  Eigen::VectorXd diagonal() const override { return blocks_[0].diagonal(); }
  Eigen::Index size() const override { return blocks_[0].rows(); }
  int lags() const override { return static_cast<int>(blocks_.size()); }
  bool renew(const TieLayout& layout, Bodies& bodies) override;
  void turn(const TieLayout& layout) override;
  std::vector<double> answers() const override;
  void take(const TieLayout& layout, std::span<const double> answers) override;

 private:
  void subtract(int lag, const Eigen::Ref<const Eigen::VectorXd>& force,
                Eigen::VectorXd& left) const override {
    left -= blocks_[lag] * force;
  }
  Eigen::VectorXd invert(const Eigen::VectorXd& jump) const override;
  void find_blocks(const TieLayout& layout, int lags);
  void find_scale(const TieLayout& layout);
  bool redundant() const override { return inverse_.size() > 0; }

  bool rigid_ = false;                   // all parts: rows are redundant however they turn
  std::vector<Responses> responses_;     // by part; kept where bodies bend or turn
  std::vector<Eigen::MatrixXd> turns_;   // (all ends of parts that turn) that blocks are made for
  std::vector<Eigen::MatrixXd> blocks_;  // [m/N] by lag
  // Of the first block: factors, or where rows are redundant the inverse of least size.
  DenseFactors factors_{Factoring::lu};
  Eigen::MatrixXd inverse_;
  Eigen::VectorXd scale_;  // of its unknowns, by which what each does is of the size of one
  Rounding rounding_;
};

/// Of unit forces of the rows, one by one.
Responses responses_of(const TieLayout& layout, const TieLayout::Part& part, int steps,
                       Bodies& bodies) {
  Responses responses(index(steps), Eigen::MatrixXd::Zero(part.width, part.width));
  const auto loose = std::ranges::find_if(
      part.ends, [&layout](const TieLayout::End& end) { return layout.carries(end); });
  const auto list = [](std::span<const double> moved) {
    return Eigen::Map<const Eigen::VectorXd>(moved.data(), static_cast<Eigen::Index>(moved.size()));
  };
  TakeLoose carried;
  carried.motion = [&](int k, int, const TieLayout::End& of, std::span<const double> moved) {
    responses[0].col(loose->first + k).segment(of.first, list(moved).size()) = list(moved);
  };
  // What a loose motion does where forces of rows act, these leave over along it: the transpose.
  carried.acted_on = [&](int k, int, const TieLayout::End& of, std::span<const double> moved) {
    responses[0].row(loose->first + k).segment(of.first, list(moved).size()) =
        list(moved).transpose();
  };
  carried.left = [&](int k, std::span<const double> left) {
    for (std::size_t l = 0; l < left.size(); ++l)
      responses[0](loose->first + static_cast<Eigen::Index>(l), loose->first + k) = left[l];
  };
  for (const TieLayout::End& by : part.ends) {
    if (layout.carries(by)) continue;
    const auto unit = [](int k, std::span<double> forces) { forces[k] = 1.0; };
    const auto take = [&](int k, int later, const TieLayout::End& of,
                          std::span<const double> moved) {
      responses[later].col(by.first + k).segment(of.first, list(moved).size()) = list(moved);
    };
    press(layout, part, by, layout.members[by.member].width, steps, unit, take, bodies, carried);
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
        share.weight * responses[share.later].block(of.first, by.first, row.width, column.width);
  }
}

/// Of a part whose ports have turned, in their order from the first one on.
Responses turned(const TieLayout& layout, const TieLayout::Part& part, Responses responses,
                 std::span<const Eigen::MatrixXd> turns) {
  for (std::size_t e = 0; e < part.ends.size(); ++e) {
    const TieLayout::End& end = part.ends[e];
    const Eigen::MatrixXd& turn = turns[e];
    const Eigen::Index dim = turn.rows();
    for (Eigen::MatrixXd& answer : responses) {
      for (Eigen::Index k = 0; k < layout.members[end.member].width; k += dim) {
        answer.middleRows(end.first + k, dim) =
            (turn * answer.middleRows(end.first + k, dim)).eval();
        answer.middleCols(end.first + k, dim) =
            (answer.middleCols(end.first + k, dim) * turn.transpose()).eval();
      }
    }
  }
  return responses;
}

/// Whether no force bends what hangs on its ends, or none moves it.
bool is_rigid(const TieLayout& layout, const TieLayout::Part& part, const Bodies& bodies) {
  return part.stands || std::ranges::all_of(part.ends, [&](const TieLayout::End& end) {
           return bodies.port(layout.side(end)).geometry.transit == 0.0;
         });
}

DenseTieKernel::DenseTieKernel(const TieLayout& layout, int lags, Bodies& bodies)
    : rigid_(std::ranges::all_of(layout.parts, [&](const TieLayout::Part& part) {
        return is_rigid(layout, part, bodies);
      })) {
  for (const TieLayout::Part& part : layout.parts)
    responses_.push_back(part.stands ? Responses()
                                     : responses_of(layout, part, part.steps * lags, bodies));
  if (std::ranges::any_of(layout.parts, &TieLayout::Part::turns)) rounding_ = light;
  find_blocks(layout, lags);
  const double entries = static_cast<double>(lags) * static_cast<double>(blocks_[0].size());
  const bool turns =
      entries <= most_turned && std::ranges::any_of(layout.parts, &TieLayout::Part::turns);
  if (!turns && std::ranges::none_of(layout.parts, &TieLayout::Part::bends)) responses_.clear();
}

/// Undeformed bodies that have turned by an angle would be wrong by as much. Supports do not turn:
/// where they hold rows of both sides of what deforms, kernels stay as they are.
void DenseTieKernel::turn(const TieLayout& layout) {
  if (responses_.empty() || (redundant() && !rigid_)) return;
  std::vector<Eigen::MatrixXd> now;
  for (const TieLayout::Part& part : layout.parts)
    for (const TieLayout::End& end : part.ends)
      if (part.turns) now.push_back(layout.members[end.member].tie->turn(end.side));
  double most = 0.0;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (now[k].size() == 0) return;
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(now[k].rows(), now[k].cols());
    most = std::max(most, (now[k] - (turns_.empty() ? one : turns_[k])).norm());
  }
  if (most <= noticed_turn) return;
  std::swap(turns_, now);
  find_blocks(layout, lags());
  if (!redundant() || rigid_) return;
  turns_ = std::move(now);
  find_blocks(layout, lags());
}

bool DenseTieKernel::renew(const TieLayout& layout, Bodies& bodies) {
  if (responses_.empty()) return false;
  // What turned when the window began is not asked again, and still better than secants: of halves
  // that spin these need 4.0 calls for its 3.2.
  if (std::ranges::none_of(layout.parts, &TieLayout::Part::bends)) return true;
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const TieLayout::Part& part = layout.parts[p];
    if (part.bends) responses_[p] = responses_of(layout, part, part.steps * lags(), bodies);
  }
  find_blocks(layout, lags());
  return true;
}

std::vector<double> DenseTieKernel::answers() const {
  std::vector<double> all;
  const auto put = [&all](const Eigen::MatrixXd& m) {
    all.insert(all.end(), m.data(), m.data() + m.size());
  };
  for (const Responses& responses : responses_)
    for (const Eigen::MatrixXd& response : responses) put(response);
  for (const Eigen::MatrixXd& turn : turns_) put(turn);
  return all;
}

void DenseTieKernel::take(const TieLayout& layout, std::span<const double> answers) {
  const auto get = [&answers](Eigen::MatrixXd& m) {
    m = Eigen::Map<const Eigen::MatrixXd>(answers.data(), m.rows(), m.cols());
    answers = answers.subspan(static_cast<std::size_t>(m.size()));
  };
  for (Responses& responses : responses_)
    for (Eigen::MatrixXd& response : responses) get(response);
  turns_.clear();
  while (!answers.empty()) {
    const Eigen::Index dim = layout.members.front().tie->rows().dim;
    get(turns_.emplace_back(dim, dim));
  }
  find_blocks(layout, lags());
}

/// A joint of stiff bodies counts as much as one of soft ones, and places of loose motions as
/// forces do.
void DenseTieKernel::find_scale(const TieLayout& layout) {
  std::vector<bool> carries(index(layout.size), false);
  for (const TieLayout::Member& member : layout.members)
    for (Eigen::Index i = 0; member.carried >= 0 && i < Eigen::Index{member.width} * member.steps;
         ++i)
      carries[member.inner + i] = true;
  const Eigen::ArrayXd each = diagonal().array().abs();
  Eigen::ArrayXd own = each;
  for (Eigen::Index k = 0; k < layout.size; ++k)
    if (!carries[k] && each[k] > 0.0)
      own = own.max(lopsided * blocks_[0].col(k).array().square() / each[k]);
  double most = 0.0;
  for (Eigen::Index i = 0; i < layout.size; ++i)
    if (!carries[i]) most = std::max(most, own[i]);
  for (const TieLayout::Member& member : layout.members) {
    if (member.carried >= 0) continue;
    auto rows = own.segment(member.inner, Eigen::Index{member.width} * member.steps);
    const double softest = rows.maxCoeff();
    for (double& row : rows)
      if (row < digits * softest || row >= rounding_.nothing * softest) row = softest;
  }
  scale_.setOnes(layout.size);
  if (most == 0.0) return;
  for (Eigen::Index i = 0; i < layout.size; ++i)
    if (!carries[i]) scale_[i] = 1.0 / std::sqrt(own[i] > stiffest * most ? own[i] : most);
  for (Eigen::Index i = 0; i < layout.size; ++i) {
    if (!carries[i]) continue;
    double moved = 0.0;
    for (Eigen::Index k = 0; k < layout.size; ++k)
      if (!carries[k]) moved = std::max(moved, std::abs(scale_[k] * blocks_[0](k, i)));
    if (moved > 0.0) scale_[i] = 1.0 / moved;
  }
}

void DenseTieKernel::find_blocks(const TieLayout& layout, int lags) {
  blocks_.assign(index(lags), Eigen::MatrixXd::Zero(layout.size, layout.size));
  std::span<const Eigen::MatrixXd> turns = turns_;
  for (std::size_t p = 0; p < layout.parts.size(); ++p) {
    const TieLayout::Part& part = layout.parts[p];
    if (part.stands) continue;
    Responses now;
    if (part.turns && !turns.empty()) {
      now = turned(layout, part, responses_[p], turns);
      turns = turns.subspan(part.ends.size());
    }
    const Responses& responses = now.empty() ? responses_[p] : now;
    for (int lag = 0; lag < lags; ++lag)
      for (const TieLayout::End& of : part.ends)
        for (const TieLayout::End& by : part.ends)
          add(layout, part, responses, of, by, lag, blocks_[lag]);
  }
  for (int lag = 0; lag < lags; ++lag)
    layout.give_way(lag, [&](Eigen::Index of, Eigen::Index by, double value) {
      blocks_[lag](of, by) += value;
    });
  find_scale(layout);
  inverse_.resize(0, 0);
  const Eigen::MatrixXd first = scale_.asDiagonal() * blocks_[0] * scale_.asDiagonal();
  factors_.compute(first);
  // Not by rcond(): of a matrix without some pivots its estimate is any number.
  const Eigen::ArrayXd pivots = factors_.pivots().array().abs();
  if (pivots.minCoeff() > rounding_.singular * pivots.maxCoeff()) return;
  inverse_ = pseudo_inverse(first, rounding_.nothing);
}

Eigen::VectorXd DenseTieKernel::invert(const Eigen::VectorXd& jump) const {
  const Eigen::VectorXd r = scale_.cwiseProduct(jump);
  if (redundant()) return scale_.cwiseProduct(inverse_ * r);
  return scale_.cwiseProduct(factors_.solve(r));
}

}  // namespace

std::unique_ptr<TieKernel> make_dense_tie_kernel(const TieLayout& layout, int lags,
                                                 Bodies& bodies) {
  return std::make_unique<DenseTieKernel>(layout, lags, bodies);
}

}  // namespace abut
