#pragma once

#include "coordinator/coupling/tie.hpp"
#include "coordinator/coupling/watch.hpp"

namespace abut {

/// Surfaces that are one from the start to the end: always iterated, and nothing to wait for.
class TieWatch final : public Watch {
 public:
  /// The tie must outlive it: both belong to one joint.
  explicit TieWatch(const Tie& tie) : tie_(tie) {}

  Decision decision() const override { return Decision::never; }
  Approach approach(const Joint&, const Bodies&) override { return {}; }
  bool stayed_apart(const Joint&, const Bodies&, double) const override { return true; }
  double peak_force(const Joint&, const Bodies&) const override { return tie_.largest_force(); }
  Shown show(const Joint& joint, const Bodies&) const override {
    return {joint.closed(), tie_.missed(), tie_.largest_force()};
  }
  void settle(Joint& joint, const TimeWindow&, double, ContactRun&, Bodies&,
              ContactChanges&) override {
    ContactState& contact = joint.contact;
    contact.closing_speed = std::max(contact.closing_speed, tie_.speed());
    contact.force_scale = std::max(contact.force_scale, tie_.row_force());
  }
  void see_passing(const Joint&, const Bodies&) override {}
  bool passed(const Joint&, const Bodies&) const override { return false; }
  void state(Archive&) override {}

 private:
  const Tie& tie_;
};

}  // namespace abut
