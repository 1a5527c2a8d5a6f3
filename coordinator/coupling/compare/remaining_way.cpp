#include "coordinator/coupling/compare/remaining_way.hpp"

#include <algorithm>

#include "base/dense.hpp"

namespace abut {

namespace {

/// Two bodies that answer each other at once are two iterations side by side; a third secant sees
/// what falls faster.
constexpr std::size_t least = 2, most = 3;
/// Of a residual, while too few are known: no tolerance takes it.
constexpr double unknown = 1.0e6;

}  // namespace

void RemainingWay::see(const Eigen::VectorXd& y, const Eigen::VectorXd& r) {
  const double last = r.lpNorm<Eigen::Infinity>();
  past_.push_front({y, r});
  if (past_.size() > most + 1) past_.pop_back();
  left_ = last;
  if (last == 0.0) return;
  left_ = unknown * last;
  if (past_.size() <= least) return;
  const auto count = static_cast<Eigen::Index>(past_.size() - 1);
  Eigen::MatrixXd moved(y.size(), count), changed(y.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Sweep& before = past_[static_cast<std::size_t>(k) + 1];
    moved.col(k) = y - before.y;
    changed.col(k) = r - before.r;
  }
  const Eigen::VectorXd shares = least_squares(changed, Eigen::VectorXd(-r));
  const Eigen::VectorXd rest = r + changed * shares;
  left_ = std::max(last, (moved * shares + rest).lpNorm<Eigen::Infinity>());
}

}  // namespace abut
