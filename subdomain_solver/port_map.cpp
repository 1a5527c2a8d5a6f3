#include "subdomain_solver/port_map.hpp"
#include "base/index.hpp"

namespace abut {

PortMap::PortMap(const FeModel& model, const NodalMap& map, const std::vector<NamedNodes>& ports)
    : dim_(model.mesh().dim) {
  std::vector<int> dofs;
  for (const NamedNodes& port : ports) {
    first_.push_back(dofs.size());
    for (std::int32_t node : port.nodes) {
      if (const Matrix3* axes = model.frame(node)) frames_.emplace_back(dofs.size(), *axes);
      for (int i = 0; i < dim_; ++i) dofs.push_back(node * dim_ + i);
    }
  }
  values_ = dofs.size();
  map_ = map.on(dofs, index(model.dofs()));
}

void PortMap::displacement(std::span<const double> q, std::vector<double>& out) const {
  out.resize(values_);
  map_->displacement(q, out);
  turn(out, false);
}

void PortMap::velocity(std::span<const double> q, std::span<const double> v,
                       std::vector<double>& out) const {
  out.resize(values_);
  map_->velocity(q, v, out);
  turn(out, false);
}

void PortMap::acceleration(std::span<const double> q, std::span<const double> v,
                           std::span<const double> a, std::vector<double>& out) const {
  out.resize(values_);
  map_->acceleration(q, v, a, out);
  turn(out, false);
}

void PortMap::lift(std::span<const double> q, const std::vector<double>& forces,
                   Vector& force) const {
  turned_ = forces;
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
