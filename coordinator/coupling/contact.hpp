#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/joint.hpp"

namespace abut {

/// Sides that meet in a window that they were free in.
struct Touch {
  double time = 0.0;   // [s] where the gap crosses zero
  double speed = 0.0;  // [m/s] at which it does
  double state = 0.0;  // [s] end of the substep in which it does
};

/// Where an open interface overlaps by more than `negligible` [m] for the first time. Looks at
/// every substep of both bodies after the window's begin, with motion linear between substeps.
std::optional<Touch> first_overlap(const Joint& joint, const Bodies& bodies, double negligible);

/// One level of time of an interface in contact.
struct ContactLevel {
  double time = 0.0;  // [s]
  // [N] compressive; on substeps of unlike length the mean over the coarser one
  double force = 0.0;
  double gap = 0.0;  // [m]
};

/// What an interface showed in a window, at the substeps of its coarser side, the window's begin
/// first. Judged there, because single values of the finer side spike.
class ContactHistory {
 public:
  /// Reads the latest responses. Reuse it: levels keep their memory. `opened_at` [s]: last release
  /// of a kick layer.
  void read(const Joint& joint, double opened_at, Bodies& bodies);

  std::size_t size() const { return levels_.size(); }
  const ContactLevel& operator[](std::size_t i) const { return levels_[i]; }
  bool kicks() const { return kicks_; }  // a force acts over the substep that ends at its level
  double peak() const;                   // [N] largest force
  double rounding() const { return rounding_; }  // [N] of a force, from that of displacements

  /// [J] that contact gives to the bodies in substep i: gaps and forces alone tell it  [M.25].
  double energy(std::size_t i) const {
    const ContactLevel& a = levels_[i - 1];
    const ContactLevel& b = levels_[i];
    return 0.5 * (a.force * b.gap - b.force * a.gap);
  }
  /// [s] where the gap of free sides crosses zero before level i, at which they push and did not at
  /// the level before, and the speed [m/s] at which it does.
  Touch touch(std::size_t i) const;
  /// [s] where the force crosses zero before level i, at which it is gone.
  double release(std::size_t i) const;
  /// [s] where the force crosses a bound in substep i, linearly.
  double crossing(std::size_t i, double bound) const;

 private:
  Touch touch_between(const ContactLevel& before, const ContactLevel& after) const;
  double release_between(const ContactLevel& before, const ContactLevel& after) const;

  std::vector<ContactLevel> levels_;
  std::vector<ContactLevel> finer_;  // of the kinematic side, where its substeps are shorter
  bool kicks_ = false;
  double compliance_ = 0.0;  // [m/N] of both sides over a substep
  double rounding_ = 0.0;
};

/// [N] length of the sum of a force over all points at its i-th time.
double resultant(const Waveform& force, std::size_t i, int dim);

/// [m/s] What all surfaces together that press on a body, and on which it presses, would give it
/// over a window of this length [s] with the forces of its end; 0: it is moved by nothing.
double push_of_all(int body, const Bodies& bodies, double length);

/// [N] Of two points, the largest force on the kinematic side in the latest responses.
double largest_force(const Joint& joint, const Bodies& bodies);

/// [J] that contact did on both bodies in the latest responses  [M.23].
double contact_work(const Joint& joint, const Bodies& bodies);

/// Impulse [N s] that gives what impulses hit on both sides a common velocity: a plastic impact of
/// massive contact nodes alone, exact in momentum; negative where they part. 0 when a side takes no
/// impulses.
double closing_impulse(const Joint& joint, const Bodies& bodies);
/// [N s] By kicks a step's force acts at its begin as a whole: half the first one belongs to the
/// step that would lie before the begin. Of what the bodies told of the begin, with accelerations.
double opening_kick(const Joint& joint, const Bodies& bodies);

/// Impulse [N s] that gives back, when massive contact nodes part that took kicks, the `debt` [J]:
/// what contact has taken from the bodies [M.13]. 0 when a side takes no impulses.
double release_impulse(const Joint& joint, double debt, const Bodies& bodies);

/// Impulse [N s] between sides in contact, positive where it pushes them apart, that pays what
/// contact owes the bodies  [M.26]. 0 where a side takes no impulses, or where their velocity of
/// approach is too small to pay with: the debt waits.
double paying_impulse(const Joint& joint, double debt, const Bodies& bodies);
/// [J] that such an impulse [N s] gives both bodies.
double work_of_impulse(const Joint& joint, double impulse, const Bodies& bodies);

}  // namespace abut
