#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/nodal_map.hpp"
#include "subdomain_solver/solid_measures.hpp"

namespace abut {

/// How a body's coordinates move the nodes of its ports, and points inside it that belong to them.
/// Lists of values go over all ports (nodes and then points, dim), along the axes of space.
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
  /// Points of a port: shape functions over the nodes of the list that the map fills.
  struct Inside {
    std::size_t port = 0;
    SparseRows rows;
  };

  void add_inside(std::size_t port, const SparseRows& rows, std::vector<std::int32_t>& nodes);
  std::vector<double>& filled(std::vector<double>& out) const;
  void show(std::vector<double>& filled, std::vector<double>& out) const;
  void turn(std::vector<double>& values, bool into_frames) const;

  int dim_;
  std::size_t values_ = 0;
  std::vector<std::size_t> first_;  // (ports)
  std::vector<std::pair<std::size_t, Matrix3>>
      frames_;  // of nodes that have one, and where they begin
  std::unique_ptr<NodalMap> map_;
  // Where ports have points inside: where the list that the map fills has a port's nodes, and how
  // many values these are. Nodes of cells that hold points come last.
  std::vector<std::size_t> filled_first_, own_width_;
  std::vector<Inside> inside_;
  std::size_t filled_ = 0;
  mutable std::vector<double> list_;
  mutable std::vector<double> turned_;
};

}  // namespace abut
