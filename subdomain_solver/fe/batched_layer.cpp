#include "subdomain_solver/fe/batched_layer.hpp"

#include <algorithm>

#include <Eigen/Core>

#include "base/index.hpp"
#include "base/one_each.hpp"

namespace abut {

BatchedLayer::BatchedLayer(const Mesh& mesh, const Material& material, BatchedOptions options,
                           std::span<const Cell> cells, std::span<const int> dofs)
    : dim_(index(mesh.dim)) {
  for (const auto& [block, cell, first] : cells)
    for (const std::int32_t node : nodes_of(mesh.blocks[block], cell)) nodes_.push_back(node);
  keep_one_each(nodes_);
  const auto own = [this](std::int32_t node) {
    return static_cast<std::int32_t>(std::ranges::lower_bound(nodes_, node) - nodes_.begin());
  };
  Mesh layer;
  layer.dim = mesh.dim;
  for (const std::int32_t node : nodes_) {
    const auto at = mesh.points.begin() + node * mesh.dim;
    layer.points.insert(layer.points.end(), at, at + mesh.dim);
  }
  int last = -1;
  for (const auto& [block, cell, first] : cells) {
    const CellBlock& from = mesh.blocks[block];
    if (block != last) {
      layer.blocks.push_back({from.element, {}, from.name, {}});
      options.first_history.emplace_back();
    }
    options.first_history.back().push_back(first);
    last = block;
    for (const std::int32_t node : nodes_of(from, cell))
      layer.blocks.back().nodes.push_back(own(node));
  }
  for (const int dof : dofs)
    places_.push_back(index(own(dof / mesh.dim)) * dim_ + index(dof % mesh.dim));
  batched_.emplace(layer, material, options);
  displacement_.resize(nodes_.size() * dim_);
  force_.resize(displacement_.size());
}

bool BatchedLayer::evaluate(std::span<const double> q, std::span<const double> history,
                            std::span<double> force) {
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    std::copy_n(q.begin() + index(nodes_[n]) * dim_, dim_, displacement_.begin() + n * dim_);
  CellEnergies unused;
  if (!batched_->evaluate(displacement_, {history, {}}, force_, unused)) return false;
  for (std::size_t k = 0; k < places_.size(); ++k) force[k] = force_[places_[k]];
  return true;
}

double BatchedLayer::size() const {
  const Eigen::Map<const Eigen::VectorXd> force(force_.data(),
                                                static_cast<Eigen::Index>(force_.size()));
  return force.norm();
}

}  // namespace abut
