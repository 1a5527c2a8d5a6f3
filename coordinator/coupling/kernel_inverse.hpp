#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "base/archive.hpp"
#include "base/dense.hpp"
#include "contract/time_window.hpp"
#include "coordinator/coupling/port_jacobian.hpp"

namespace abut {

/// Inverse interface Jacobians by window length: a Toeplitz column where both bodies take the same
/// substeps, factors otherwise, and with them the maps of contact that comes and goes.
class KernelInverse {
 public:
  struct Entry {
    double length = 0.0;  // [s] of the window
    std::vector<double> column = {};
    DenseFactors factors{Factoring::lu};
    ContactMaps maps = {};  // where the substeps are unlike; of the parallel form overlap alone

    Eigen::VectorXd solve(const Eigen::VectorXd& r) const;
  };
  const Entry* find(double length) const;  // null: not there yet
  /// The window by whose substeps those of its length are found: itself, or an earlier one. Equal
  /// windows differ in their last bits, which a run that goes on from its state must not.
  TimeWindow first_of(const TimeWindow& window);
  void state(Archive& archive);
  const Entry* store(double length, const Eigen::MatrixXd& jacobian);
  const Entry* store(double length, ContactMaps maps);
  const Entry* store(double length, std::vector<double> column);

  static constexpr int largest = 1200;  // rows of a dense Jacobian: 11 MiB, factored once in 0.3 s

 private:
  const Entry* add(Entry entry);
  std::vector<std::unique_ptr<Entry>> entries_;
  std::vector<TimeWindow> windows_;  // by which they were found
};

}  // namespace abut
