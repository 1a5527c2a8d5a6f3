#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "coordinator/coupling/tie_kernel.hpp"

namespace abut {

/// A port that touches, of a body that ties join to others: what these answer to a force on it
/// [M.121], and how it moves when the forces of the ties change.
class TiedPort {
 public:
  /// Probes the body. `points`: ascending; empty: all. Precondition: the layout's body steps as all
  /// of its net do, `layout.blocks` times in a window.
  TiedPort(const TieLayout& layout, const TieLayout::Part& part, const TieKernel& kernel, int port,
           const std::vector<std::int32_t>& points, Bodies& bodies);

  /// [m/N] as Bodies::full_kernel tells, of the neighbours' answer alone; `begin` is zero.
  const PortKernel& give() const { return give_; }
  /// Adds to the port's points [m] (steps, width) what a change of the ties' forces in a stacked
  /// vector moves them.
  void follow(const TieLayout& layout, const Eigen::VectorXd& change, int width,
              Eigen::Ref<Eigen::VectorXd> motion) const;

 private:
  struct End {
    std::size_t member = 0;
    double sign = 1.0;
    std::vector<Eigen::MatrixXd> rows, port;  // [m/N] by lag: (rows, values), (values, rows)
  };
  void probe(const TieLayout& layout, const TieLayout::Part& part, int port, Bodies& bodies);
  void find_give(const TieLayout& layout, const TieKernel& kernel);

  int steps_;
  std::vector<std::size_t> values_;  // of the port's points that are listed
  std::vector<End> ends_;
  PortKernel give_;
};

}  // namespace abut
