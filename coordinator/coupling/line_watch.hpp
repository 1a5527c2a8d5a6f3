#pragma once

#include "coordinator/coupling/watch.hpp"

namespace abut {

/// What all watches of two points on a line have in common.
class LineWatch : public Watch {
 public:
  Approach approach(const Joint& joint, const Bodies& bodies) override;
  bool stayed_apart(const Joint& joint, const Bodies& bodies, double length) const override;
  double peak_force(const Joint& joint, const Bodies& bodies) const override;
  Shown show(const Joint& joint, const Bodies&) const override { return {joint.closed()}; }
  void see_passing(const Joint&, const Bodies&) override {}
  bool passed(const Joint& joint, const Bodies& bodies) const override;
  void state(Archive&) override {}
};

/// Contact of two points: every substep of the kinematic body decides, and an account is kept of
/// what contact did.
class PointWatch final : public LineWatch {
 public:
  PointWatch() { account_.emplace(); }
  Decision decision() const override { return Decision::every_substep; }
  std::optional<Engagement> touch(const Joint& joint, const TimeWindow& window,
                                  const Bodies& bodies, double negligible) const override;
  Shown show(const Joint& joint, const Bodies& bodies) const override;
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes) override;
};

/// The published form decides when a window begins: contact closes where the sides overlap, and
/// stays while the force handed over compresses.
class PublishedWatch final : public LineWatch {
 public:
  /// `roles_swap`: after every window in contact; `projection`: plastic impact of the contact nodes
  /// at first touch.
  PublishedWatch(bool roles_swap, bool projection)
      : roles_swap_(roles_swap), projection_(projection) {}
  Decision decision() const override { return Decision::window_begin; }
  std::optional<Engagement> begin(Joint& joint, const TimeWindow& window, const Bodies& bodies,
                                  ContactChanges& changes) override;
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes) override;

 private:
  bool roles_swap_, projection_;
};

/// Points that are one from the start: a node that the bodies share.
class SharedNodeWatch final : public LineWatch {
 public:
  /// `roles_swap`: after every window, in the published form.
  explicit SharedNodeWatch(bool roles_swap = false) : roles_swap_(roles_swap) {}
  Decision decision() const override { return Decision::never; }
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes) override;
  bool passed(const Joint&, const Bodies&) const override { return false; }

 private:
  bool roles_swap_;
};

/// Contact that a body solves itself: nothing is exchanged, it is reported as its ports show it.
class InsideWatch final : public LineWatch {
 public:
  Decision decision() const override { return Decision::inside; }
  Shown show(const Joint& joint, const Bodies& bodies) const override;
  void settle(Joint& joint, const TimeWindow& window, double energy, ContactRun& run,
              Bodies& bodies, ContactChanges& changes) override;
  bool passed(const Joint&, const Bodies&) const override { return false; }
};

}  // namespace abut
