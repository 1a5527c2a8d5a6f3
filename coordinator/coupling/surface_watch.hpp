#pragma once

#include "coordinator/coupling/watch.hpp"

namespace abut {

/// Contact of surfaces: the bodies find out in every substep which points press; what is watched is
/// how near the sides are, and when a push begins and ends.
class SurfaceWatch final : public Watch {
 public:
  /// `margin` [m]: rows of facets may press before these touch; `rubs`: the law has friction.
  SurfaceWatch(double margin, bool rubs) : margin_(margin), rubs_(rubs) {}

  Decision decision() const override { return Decision::every_substep; }
  /// How far the sides are apart at the end of the last replies, the margin counted as theirs. What
  /// was measured before stays where these were of an attempt that was taken back.
  Approach approach(const Joint& joint, const Bodies& bodies) override;
  /// Surfaces that may meet in the window are iterated, also where they do not: their bodies find
  /// out. They are free again when they would need several windows to meet.
  std::optional<Engagement> begin(Joint& joint, const TimeWindow& window, const Bodies& bodies,
                                  ContactChanges& changes) override;
  /// Their swept boxes stayed apart in every record's part, or what the sides were apart at both
  /// ends is more than they can have come together in between. `length` [s]: from where the
  /// approach was measured.
  bool stayed_apart(const Joint& joint, const Bodies& bodies, double length) const override;
  std::optional<Engagement> touch(const Joint& joint, const TimeWindow& window,
                                  const Bodies& bodies, double negligible) const override;
  double peak_force(const Joint& joint, const Bodies& bodies) const override;
  Shown show(const Joint& joint, const Bodies& bodies) const override;
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes) override;
  void see_passing(const Joint& joint, const Bodies& bodies) override;
  bool passed(const Joint& joint, const Bodies& bodies) const override;
  void state(Archive& archive) override;

 private:
  double margin_;
  bool rubs_;
  Approach approach_;
  bool near_ = false;  // the boxes that the sides swept have overlapped
};

}  // namespace abut
