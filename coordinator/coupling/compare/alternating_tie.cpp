#include "coordinator/coupling/compare/alternating_tie.hpp"

#include <algorithm>
#include <vector>

namespace abut {

void AlternatingTie::begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) {
  Tie::begin(window, joint, bodies);
  way_.begin();
}

/// Sides may nearly meet far from where they will: how each row's own side moved, and by how much
/// it is to move now.
void AlternatingTie::image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
                           const Bodies& bodies, Eigen::Ref<Eigen::VectorXd> g) {
  Tie::image(x, joint, bodies, g);
  Eigen::VectorXd own = Eigen::VectorXd::Zero(iterate_.size()), step = jump_;
  std::vector<double> u, seen(index(iterate_.width));
  for (const int s : {0, 1}) {
    const Waveform& motion = trace_of(bodies, joint.sides[s]);
    const SparseRows& rows = rows_.force[s];
    u.resize(index(motion.width));
    for (int i = 1; i <= iterate_.steps.count; ++i) {
      motion.interpolate(motion.u, iterate_.steps.time(i), u);
      apply(rows, rows_.dim, u, seen);
      for (int k = 0; k < iterate_.width; ++k) {
        const int r = k / rows_.dim;
        if (rows.offsets[r] == rows.offsets[r + 1]) continue;  // the other side's
        own[iterate_.at(i) + k] = seen[k];
        if (s == joint.role.kinematic) step[iterate_.at(i) + k] *= -1.0;
      }
    }
  }
  if (step.lpNorm<Eigen::Infinity>() <= scale_.roundoff) step.setZero();
  way_.see(own, step);
}

FieldResiduals AlternatingTie::measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                                       const Eigen::Ref<const Eigen::VectorXd>& g) const {
  FieldResiduals r = Tie::measure(x, g);
  r.displacement = std::max(r.displacement, seen_by_motion(way_.left()));
  return r;
}

}  // namespace abut
