#include "coordinator/coupling/accelerator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/dense.hpp"
#include "coordinator/coupling/state_fields.hpp"

namespace abut {

namespace {
/// After this many updates in a window the reused secants are dropped: they may be what keeps it
/// from converging.
constexpr int stagnation = 6;
}  // namespace

Eigen::VectorXd Relaxation::next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                                 const Inverses& inverses) {
  return iterate + by_.apply(image - iterate, inverses);
}

void Aitken::reset(std::uint64_t) {
  factor_ = initial_;
  previous_.resize(0);
}

Eigen::VectorXd Aitken::next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                             const Inverses& inverses) {
  const Eigen::VectorXd residual = by_.apply(image - iterate, inverses);
  if (previous_.size() == residual.size()) {
    const Eigen::VectorXd change = weighted(residual - previous_);
    const double squared = change.squaredNorm();
    if (squared > 0.0)
      factor_ = std::clamp(-factor_ * weighted(previous_).dot(change) / squared, -2.0, 2.0);
    if (factor_ == 0.0) factor_ = initial_;
  }
  previous_ = residual;
  return iterate + factor_ * residual;
}

QuasiNewton::QuasiNewton(Preconditioner inverse, int reuse, double filter, int exact_enough)
    : inverse_(inverse), reuse_(reuse), filter_(filter), exact_enough_(exact_enough) {}

void QuasiNewton::reset(std::uint64_t key) {
  if (key != key_) earlier_.clear();  // secants of another window length are noise
  key_ = key;
  updates_ = 0;
  current_.clear();
  previous_residual_.resize(0);
}

QuasiNewton::Selection QuasiNewton::select() const {
  // Modified Gram-Schmidt, newest first: a column that adds less than `filter` of itself is
  // dropped, so that the least-squares problem stays well conditioned.
  std::vector<const Secant*> kept;
  std::vector<Eigen::VectorXd> basis;
  auto offer = [this, &kept, &basis](const std::deque<Secant>& window) {
    for (const Secant& secant : window) {
      Eigen::VectorXd rest = weighted(secant.residual);
      const double whole = rest.norm();
      for (const Eigen::VectorXd& q : basis) rest -= q.dot(rest) * q;
      const double size = rest.norm();
      if (!(size > filter_ * whole)) continue;
      kept.push_back(&secant);
      basis.push_back(rest / size);
    }
  };
  offer(current_);
  const bool trusted = exact_enough_ == 0 || needed_;
  if (trusted && updates_ <= stagnation) {
    for (const std::deque<Secant>& window : earlier_) offer(window);
  }
  Selection selection;
  const Eigen::Index rows = previous_residual_.size();
  selection.weighted.resize(rows, static_cast<Eigen::Index>(kept.size()));
  selection.residuals.resize(rows, static_cast<Eigen::Index>(kept.size()));
  selection.images.resize(rows, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t c = 0; c < kept.size(); ++c) {
    selection.weighted.col(static_cast<Eigen::Index>(c)) = weighted(kept[c]->residual);
    selection.residuals.col(static_cast<Eigen::Index>(c)) = kept[c]->residual;
    selection.images.col(static_cast<Eigen::Index>(c)) = kept[c]->image;
  }
  return selection;
}

Eigen::VectorXd QuasiNewton::next(const Eigen::VectorXd& iterate, const Eigen::VectorXd& image,
                                  const Inverses& inverses) {
  const Eigen::VectorXd residual = image - iterate;
  if (previous_residual_.size() == residual.size()) {
    current_.push_front({residual - previous_residual_, image - previous_image_});
  }
  previous_residual_ = residual;
  previous_image_ = image;
  ++updates_;
  const Selection secants = select();
  if (secants.residuals.cols() == 0) return iterate + inverse_.apply(residual, inverses);
  const Eigen::VectorXd weights = qr_solve(secants.weighted, -weighted(residual));
  const Eigen::VectorXd rest = residual + secants.residuals * weights;
  return iterate + (secants.images - secants.residuals) * weights + inverse_.apply(rest, inverses);
}

void QuasiNewton::forget() {
  current_.clear();
  earlier_.clear();
  previous_residual_.resize(0);
}

void QuasiNewton::accept() {
  needed_ = updates_ > exact_enough_;
  if (reuse_ == 0 || current_.empty()) return;
  earlier_.push_front(std::move(current_));
  current_.clear();
  while (static_cast<int>(earlier_.size()) > reuse_) earlier_.pop_back();
}

/// Between windows: what belongs to one window is not listed.
void QuasiNewton::state(Archive& archive) {
  const auto secants = [](Archive& a, std::deque<Secant>& window) {
    list(a, "secants", window, [](Archive& each, Secant& secant) {
      field(each, "residual", secant.residual);
      field(each, "image", secant.image);
    });
  };
  archive.field("needed", needed_);
  whole(archive, "key", key_);
  list(archive, "windows", earlier_, secants);
}

}  // namespace abut
