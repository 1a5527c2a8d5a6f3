#include "coordinator/coupling/steps.hpp"

#include <utility>

namespace abut {

namespace {

/// Of the mismatch, from sweep to sweep: where several joints wait for each other, secants that
/// lead to the answer may let it grow before.
constexpr double most_growth = 10.0;
/// Sweeps that may be worse than the best one.
constexpr int patience = 3;

}  // namespace

Steps::Steps(Net& net, Accelerator& accelerator, const Options& options, Bodies& bodies)
    : net_(net),
      accelerator_(accelerator),
      options_(options),
      inverses_{[this](const Eigen::VectorXd& r) { return net_.inverse(r); },
                [this](const Eigen::VectorXd& r) { return net_.relaxed(r); }},
      contracts_(net.contracts()),
      beside_ties_(net.contact_beside_ties()),
      shared_(contracts_ && net.shares_bodies()),
      eased_(net.ease(bodies)) {
  accelerator_.reset(net.layout_key());
  // Bodies that others hold answer a sweep with little of what they would if they were left alone;
  // what a kernel of near points leaves out is nearly what it left out in the windows before.
  if (shared_ || net_.leaves_out()) accelerator_.doubt();
}

bool Steps::enough(const Iterate& it) const {
  if (!it.contradiction.empty() || it.sweep >= options_.max_iterations) return true;
  const bool doubted = shared_ && early(it) && it.residual.largest() > 0.0;
  return it.converged && !doubted;
}

void Steps::next(Iterate& it, Bodies& bodies) {
  it.seen = it.x;
  const double before = std::exchange(mismatch_, it.mismatch);
  const bool grown = it.sweep > 1 && it.mismatch > (shared_ ? most_growth : 1.0) * before;
  if (eased_ && !early(it)) {
    eased_ = false;
    net_.withdraw(bodies);
  }
  // The derivative of ties alone says nothing of contact that sticks beside them.
  const bool derived = net_.renew(it.x, it.g, bodies) && (!beside_ties_ || eased_);
  if (derived || net_.projects() || eased_) {
    it.x += net_.inverse(it.g - it.x);
    return;
  }
  if (astray(it)) {
    accelerator_.forget();
    it.x = accelerator_.next(best_.iterate(), best_.image(), inverses_);
    return;
  }
  if (contracts_ && !beside_ties_ && early(it) && grown) {
    accelerator_.forget();
    if (growths_++ > 0 && careful_ == nullptr)
      careful_ = std::make_unique<Aitken>(Preconditioner::relaxed(), 0.5);
  }
  Accelerator& steps = careful_ != nullptr ? *careful_ : accelerator_;
  steps.weigh(it.s);
  it.x = steps.next(it.x, it.g, inverses_);
}

/// Beside ties by way, from the first sweep on; between joints that share bodies by what ends the
/// iteration, when half of the sweeps have not.
bool Steps::astray(const Iterate& it) {
  if (beside_ties_) return best_.left(it.x, it.g, it.mismatch, patience);
  return shared_ && best_.left(it.x, it.g, it.residual.largest(),
                               early(it) ? options_.max_iterations : patience);
}

bool Steps::arrived(const Iterate& it) const {
  return it.converged && net_.distance(it.seen, it.x) <= options_.tolerance &&
         net_.force(it.seen, it.x) <= options_.tolerance;
}

bool Steps::back(Iterate& it) {
  if (!contracts_ || it.sweep <= 1 || it.sweep >= options_.max_iterations) return false;
  accelerator_.forget();
  share_ *= 0.5;
  if (!beside_ties_) careful_ = std::make_unique<Aitken>(Preconditioner::kernels(), share_);
  it.x = it.seen + share_ * net_.inverse(it.g - it.seen);
  return true;
}

}  // namespace abut
