#pragma once

#include <cstdint>
#include <vector>

#include "coordinator/record/force_filter.hpp"

namespace abut {

/// Largest value of a force behind the filter of a channel frequency class: two poles of
/// Butterworth, run forward and then backward, so that nothing is delayed [M.80].
/// The norm filters samples at equal distances. Here these are the means of the force over every
/// 1/(1000 class) s, which substeps of any length make; at the cut-off that is a 481th of a period.
/// The backward run forgets: it starts anew every 6000 samples, 3000 later.
class ChannelClassFilter : public ForceFilter {
 public:
  explicit ChannelClassFilter(int channel_class);

  void add(double from, double to, double force_from, double force_to) override;
  double peak() override;
  void state(Archive& archive) override;
  /// Samples held now.
  std::size_t held() const { return forward_.size(); }

 private:
  // Samples after which the filter has forgotten all but 1e-12: ln(1e12) sqrt(2) / (wd T).
  static constexpr std::size_t memory = 3000;

  void fill(double to, double force_from, double force_to);
  void sample(double force);
  void run_backward(std::size_t wanted);

  double step_;                    // T [s]
  double a0_, a1_, a2_, b1_, b2_;  // of the norm

  bool running_ = false;             // else there is no force, and none is remembered
  double origin_ = 0.0, now_ = 0.0;  // [s] begin of the first sample; how far the force is known
  std::int64_t samples_ = 0;         // since the origin
  double impulse_ = 0.0;             // [N s] of the sample that has begun
  std::size_t silent_ = 0;           // samples since the last one with a force
  double x1_ = 0.0, x2_ = 0.0;       // [N] last samples, and those behind the forward run
  double y1_ = 0.0, y2_ = 0.0;
  std::vector<double> forward_;  // [N] behind the forward run, not yet run backward
  double peak_ = 0.0;            // [N]
};

}  // namespace abut
