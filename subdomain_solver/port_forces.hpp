#pragma once

#include <span>
#include <vector>

#include "contract/boundary_data.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/solid_measures.hpp"
#include "subdomain_solver/substeps.hpp"

namespace abut {

/// Forces imposed on the ports of a body over a window, as its own substeps take them: values at
/// their ends, equal to those of the waveform where it is sampled there, else means over the dual
/// cells [M.8], so that the impulse is exact; linear in between. Lists of values go over all nodes
/// of all ports (values), along the axes of space.
class PortForces final : public Load {
 public:
  /// The three must outlive the load.
  PortForces(const FeModel& model, const NodalMap& map, const std::vector<NamedNodes>& ports);

  std::size_t values() const { return values_; }
  /// Where the values of a port begin.
  std::size_t first(std::size_t port) const { return first_[port]; }
  /// What is imposed over a window that the body divides like this.
  void impose(const std::vector<BoundaryData>& boundary, const Substeps& grid);
  /// One force [N] (values) at the window's begin and one at the end of its first substep.
  void impose(std::vector<double> at_begin, std::vector<double> in_first, const Substeps& grid);
  bool acts() const { return !forces_.empty(); }

  /// [N] (values) at a time; zeros where nothing is imposed.
  std::vector<double> at(double time) const;
  /// Adds the generalised force of port forces [N] (values) at coordinates q.
  void lift(std::span<const double> q, std::span<const double> forces, Vector& force) const;
  void add(double time, std::span<const double> q, Vector& force) const override;

 private:
  void sample(const Waveform& imposed, std::size_t port);

  const FeModel& model_;
  const NodalMap& map_;
  const std::vector<NamedNodes>& ports_;
  std::vector<std::size_t> first_;  // (ports)
  std::size_t values_ = 0;
  Substeps grid_;
  std::vector<double> forces_;  // [N] (substeps + 1, values); empty: none imposed
};

}  // namespace abut
