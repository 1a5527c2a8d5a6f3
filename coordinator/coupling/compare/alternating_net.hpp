#pragma once

#include "coordinator/coupling/net.hpp"

namespace abut {

/// A net in which bodies answer as if the others stood still, whatever accelerates it: images are
/// what each of them makes of the others' motions (AlternatingTie).
class AlternatingNet final : public Net {
 public:
  explicit AlternatingNet(TieKernelOptions ties) : Net(ties, false), alone_(used(ties)) {}

  void state(Archive& archive) override { alone_.state(archive); }
  bool renew(const Eigen::VectorXd& x, Eigen::VectorXd& g, Bodies& bodies) override {
    alone_.renew(bodies);
    Eigen::VectorXd r = g - x;
    alone_.apply_inverse(r);
    g = x + r;
    return false;
  }

 private:
  static TieKernelOptions used(TieKernelOptions ties) {
    ties.used = true;
    return ties;
  }
  void begin_ties(const KnownExchanges& known, std::span<const Eigen::Index> first,
                  Bodies& bodies) override {
    alone_.begin(known, first, bodies);
  }

  TieNet alone_;  // kernels of what each body alone says of its own side
};

}  // namespace abut
