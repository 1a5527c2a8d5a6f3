#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/solid_measures.hpp"

namespace abut {

/// How a body's coordinates move the nodes of its ports. Lists of values go over all nodes of all
/// ports (nodes, dim), along the axes of space.
class PortMap {
 public:
  /// The model and the map must outlive it.
  PortMap(const FeModel& model, const NodalMap& map, const std::vector<NamedNodes>& ports);

  int dim() const { return dim_; }
  std::size_t values() const { return values_; }
  std::size_t ports() const { return first_.size(); }
  /// Where the values of a port begin, and how many they are.
  std::size_t first(std::size_t port) const { return first_[port]; }
  std::size_t width(std::size_t port) const {
    return (port + 1 < first_.size() ? first_[port + 1] : values_) - first_[port];
  }

  void displacement(std::span<const double> q, std::vector<double>& out) const;  // [m]
  void velocity(std::span<const double> q, std::span<const double> v,
                std::vector<double>& out) const;  // [m/s]
  void acceleration(std::span<const double> q, std::span<const double> v, std::span<const double> a,
                    std::vector<double>& out) const;  // [m/s^2]
  /// Adds the generalised force of port forces [N] at coordinates q.
  void lift(std::span<const double> q, const std::vector<double>& forces, Vector& force) const;

 private:
  void turn(std::vector<double>& values, bool into_frames) const;

  int dim_;
  std::size_t values_ = 0;
  std::vector<std::size_t> first_;  // (ports)
  std::vector<std::pair<std::size_t, Matrix3>>
      frames_;  // of nodes that have one, and where they begin
  std::unique_ptr<NodalMap> map_;
  mutable std::vector<double> turned_;
};

}  // namespace abut
