#pragma once

#include <deque>
#include <string>
#include <vector>

#include "subdomain_solver/interior.hpp"

namespace abut {

/// A partner's surface before a port of one point in one dimension: the smallest case of contact,
/// one row n (x - y) <= gap.
class PointObstacle {
 public:
  /// Where the surface lies, and how it answers.
  struct Surface {
    double target = 0.0;     // [m] outward displacement of the port at which it touches
    double give = 0.0;       // [m/N] by which the target moves out under this substep's reaction
    bool bilateral = false;  // holds in tension too
  };

  /// `place`: [m] of the port in the reference; `outward`: its normal, 1 or -1. `body`: for people.
  PointObstacle(double place, double outward, std::string body)
      : place_(place), outward_(outward), body_(std::move(body)) {}

  /// Takes what is imposed on the port over a window, which must live until the next. Throws
  /// RunError for what a point cannot take.
  void impose(const BoundaryData& data, const std::deque<Partner>& met, const Substeps& grid);
  /// One acts in this window.
  bool acts() const { return partner_ != nullptr; }
  /// At the end of substep i, 0: at the window's begin. `reaction`: [N] the force on the
  /// partner at the substep before.
  Surface at(int i, double reaction);
  /// The same between substeps, of a surface that does not give way.
  Surface between(double time) const;
  bool yields() const { return acts() && partner_->kernel.count() > 0; }

 private:
  Surface where(double u) const;
  void give_way(int i, double reaction, Surface& surface);

  double place_, outward_;
  std::string body_;
  const Partner* partner_ = nullptr;
  const Waveform* motion_ = nullptr;
  Substeps grid_;
  bool same_times_ = false;     // the motion is given at the substeps
  std::vector<double> excess_;  // [N] (substeps) reactions beyond those under which it was found
};

}  // namespace abut
