#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "contract/boundary_data.hpp"
#include "subdomain_solver/port_map.hpp"
#include "subdomain_solver/substeps.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// Forces imposed by partners on the ports of a body over a window, as its own substeps take them:
/// values at their ends, equal to those of the waveform where it is sampled there, else means over
/// the dual cells [M.8], so that the impulse is exact; linear in between. Lists of values are those
/// of PortMap. On ports that are joined, forces are constant in every substep: means over it
/// [M.107]; on nodes without mass, linear in the partner's steps [M.164], [M.166].
class PortForces final : public Load {
 public:
  /// The map must outlive the load.
  explicit PortForces(const PortMap& map) : map_(map) {}

  /// What the substep before a window has left on nodes without mass [N] (light): the mean of the
  /// force, and what it came to.
  struct Left {
    std::vector<double> mean, end;
  };
  /// What is imposed over a window that the body divides like this.
  void impose(const std::vector<BoundaryData>& boundary, const Substeps& grid,
              const Left& before = {});
  /// From now on, forces on this port are those of joined sides; massless: those of its values that
  /// belong to nodes without mass; alike: both sides take the same steps.
  void join(std::size_t port, const std::vector<std::size_t>& massless, bool alike);
  const std::vector<std::size_t>& light() const { return light_; }  // of all joined ports
  /// After substep i of the window; zeros where nothing is imposed.
  void leave(int i, Left& out) const;
  /// The substep that begins, from 1: of joined ports at() tells its forces.
  void enter(int substep) { substep_ = substep; }
  bool acts() const { return !forces_.empty(); }

  /// From now on, instants are kept beside the means.
  void keep_swings() { keeps_swings_ = true; }
  /// [N] of one value at the end of substep i: what its instant adds to the mean that at() tells.
  double swing(int i, std::size_t value) const {
    return swings_.empty() ? 0.0 : swings_[index(i) * map_.values() + value];
  }

  /// Adds [N] (values) what forces of surfaces whose levels are others are at the window's end,
  /// beyond their mean before it. False: there is nothing to add.
  bool add_end(std::vector<double>& force) const;
  /// [N] (values) at a time; zeros where nothing is imposed.
  void at(double time, std::vector<double>& out) const;
  void add(double time, std::span<const double> q, Vector& force) const override;

 private:
  void add_sampled(const Waveform& imposed, std::size_t port, bool first);
  bool joined(std::size_t port) const { return std::ranges::find(joined_, port) != joined_.end(); }
  void add_constant(const Waveform& imposed, std::size_t port, bool first);
  void lay_slopes(const std::vector<BoundaryData>& boundary);
  void follow_own_steps();
  void follow_steps_of(const std::vector<Waveform>& imposed, std::size_t port);
  void add_slopes(double time, std::vector<double>& out) const;
  void add_swing(const Waveform& imposed, double now, std::size_t row, std::vector<double>& to,
                 std::size_t size);
  void add(const Waveform& imposed, const double* values, bool first, double* row) const;

  const PortMap& map_;
  Substeps grid_;
  std::vector<double> forces_;  // [N] (substeps + 1, values); empty: none imposed
  bool keeps_swings_ = false;
  std::vector<double> swings_;  // [N] the same; empty: means are the instants' values
  std::vector<double> ends_;    // [N] (values) at the window's end; empty: the same
  std::vector<double> mean_;    // [N] of a waveform over a dual cell
  std::vector<double> instant_;
  mutable std::vector<double> now_;
  std::vector<std::size_t> joined_;  // ports
  std::vector<std::size_t> light_;   // values of joined ports on nodes without mass
  std::vector<double> forgets_;      // (light)
  Left before_;
  std::vector<double> rises_;   // [N] (substeps + 1, light): of the slope, from begin to end
  std::vector<double> slopes_;  // [N/s] of a partner's steps, of one value
  std::vector<double> levels_;  // [N] the same: beside the mean in the middle of the substep
  int substep_ = 1;
};

}  // namespace abut
