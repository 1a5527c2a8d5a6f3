#include "subdomain_solver/linearised_model.hpp"

#include <limits>

#include "base/index.hpp"

namespace abut {

namespace {

Eigen::Map<const Vector> view_of(std::span<const double> q) {
  return {q.data(), static_cast<Eigen::Index>(q.size())};
}

}  // namespace

LinearisedModel::LinearisedModel(Model& of) : of_(of) {
  const std::vector<double> q(index(of.dofs()), 0.0), history(of.history_size(), 0.0);
  ModelResponse rest;
  ready_ = of.evaluate(q, history, Want::tangent, rest) &&
           of.evaluate_layer(q, history, Want::tangent, layer_);
  tangent_ = std::move(rest.tangent);
}

double LinearisedModel::roundoff(std::span<const double> q) const {
  return summed_roundings * std::numeric_limits<double>::epsilon() * tangent_.norm() *
         view_of(q).lpNorm<Eigen::Infinity>();
}

bool LinearisedModel::evaluate(std::span<const double> q, std::span<const double> history,
                               Want want, ModelResponse& out) {
  out.force.noalias() = tangent_ * view_of(q);
  if (want == Want::tangent) out.tangent = tangent_;
  out.history.assign(history.begin(), history.end());
  out.stored = 0.5 * out.force.dot(view_of(q));
  out.dissipation = 0.0;
  return true;
}

bool LinearisedModel::evaluate_layer(std::span<const double> q, std::span<const double>, Want want,
                                     LayerResponse& out) {
  if (out.tangent.size() == 0) out = layer_;  // what the model itself says at first it says once
  force_.noalias() = tangent_ * view_of(q);
  out.force.resize(layer_.force.size());
  for (std::size_t k = 0; k < massless().size(); ++k)
    out.force(static_cast<Eigen::Index>(k)) = force_(massless()[k]);
  if (want == Want::tangent) out.tangent = layer_.tangent;
  return true;
}

}  // namespace abut
