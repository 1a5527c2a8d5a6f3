#include "subdomain_solver/port_map.hpp"

#include <algorithm>
#include <map>

#include "base/index.hpp"

namespace abut {

PortMap::PortMap(const FeModel& model, const NodalMap& map, const std::vector<NamedNodes>& ports)
    : dim_(model.mesh().dim) {
  std::vector<std::int32_t> nodes;
  for (const NamedNodes& port : ports) {
    first_.push_back(values_);
    filled_first_.push_back(nodes.size() * index(dim_));
    own_width_.push_back(port.nodes.size() * index(dim_));
    nodes.insert(nodes.end(), port.nodes.begin(), port.nodes.end());
    values_ += own_width_.back() + index(port.inside.count() * dim_);
  }
  for (std::size_t p = 0; p < ports.size(); ++p)
    if (ports[p].inside.count() > 0) add_inside(p, ports[p].inside, nodes);
  std::vector<int> dofs;
  for (const std::int32_t node : nodes) {
    if (const Matrix3* axes = model.frame(node)) frames_.emplace_back(dofs.size(), *axes);
    for (int i = 0; i < dim_; ++i) dofs.push_back(node * dim_ + i);
  }
  filled_ = dofs.size();
  map_ = map.on(dofs, index(model.dofs()));
}

void PortMap::add_inside(std::size_t port, const SparseRows& rows,
                         std::vector<std::int32_t>& nodes) {
  Inside& inside = inside_.emplace_back(Inside{port, rows});
  std::map<std::int32_t, std::int32_t> place;
  for (std::int32_t& column : inside.rows.columns) {
    const auto [at, is_new] = place.emplace(column, static_cast<std::int32_t>(nodes.size()));
    if (is_new) nodes.push_back(column);
    column = at->second;
  }
}

/// The list that the map fills: the values themselves where ports are nodes alone.
std::vector<double>& PortMap::filled(std::vector<double>& out) const {
  out.resize(values_);
  if (inside_.empty()) return out;
  list_.resize(filled_);
  return list_;
}

/// Of a list that the map has filled.
void PortMap::show(std::vector<double>& filled, std::vector<double>& out) const {
  turn(filled, false);
  if (inside_.empty()) return;
  for (std::size_t p = 0; p < ports(); ++p)
    std::copy_n(filled.begin() + static_cast<std::ptrdiff_t>(filled_first_[p]), own_width_[p],
                out.begin() + static_cast<std::ptrdiff_t>(first_[p]));
  for (const Inside& inside : inside_) {
    const std::size_t own = own_width_[inside.port];
    apply(inside.rows, dim_, filled,
          std::span(out).subspan(first(inside.port) + own, width(inside.port) - own));
  }
}

void PortMap::displacement(std::span<const double> q, std::vector<double>& out) const {
  std::vector<double>& list = filled(out);
  map_->displacement(q, list);
  show(list, out);
}

void PortMap::velocity(std::span<const double> q, std::span<const double> v,
                       std::vector<double>& out) const {
  std::vector<double>& list = filled(out);
  map_->velocity(q, v, list);
  show(list, out);
}

void PortMap::acceleration(std::span<const double> q, std::span<const double> v,
                           std::span<const double> a, std::vector<double>& out) const {
  std::vector<double>& list = filled(out);
  map_->acceleration(q, v, a, list);
  show(list, out);
}

void PortMap::lift(std::span<const double> q, const std::vector<double>& forces,
                   Vector& force) const {
  turned_ = forces;
  if (!inside_.empty()) {
    turned_.assign(filled_, 0.0);
    for (std::size_t p = 0; p < ports(); ++p)
      std::copy_n(forces.begin() + static_cast<std::ptrdiff_t>(first_[p]), own_width_[p],
                  turned_.begin() + static_cast<std::ptrdiff_t>(filled_first_[p]));
    for (const Inside& inside : inside_) {
      const std::size_t own = own_width_[inside.port];
      add_transposed(inside.rows, dim_, 1.0,
                     std::span(forces).subspan(first(inside.port) + own, width(inside.port) - own),
                     turned_);
    }
  }
  turn(turned_, true);
  map_->lift(q, turned_, force);
}

void PortMap::turn(std::vector<double>& values, bool into_frames) const {
  for (const auto& [first, frame] : frames_) {
    const auto axes = frame.topLeftCorner(dim_, dim_);
    Eigen::Map<Vector> local(values.data() + first, dim_);
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> given = local;
    if (into_frames) {
      local.noalias() = axes.transpose() * given;
    } else {
      local.noalias() = axes * given;
    }
  }
}

}  // namespace abut
