// Solids at rest, without what acts on them: what probes press.

#include <cmath>

#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/massless_layer.hpp"

namespace abut {

double SolidInterior::light_force(std::size_t port) const {
  const FeModel& model = *parts_.model;
  if (!parts_.deforms) {
    constexpr double moved = 1.0e-8;  // of a facet, in a step
    const double step = description_.step;
    return moved * description_.ports[port].geometry.spacing * description_.mass / (step * step);
  }
  if (parts_.problem->model->is_linear() || probed_as_linear()) return 1.0;
  constexpr double strain = 1.0e-7;
  const double area = description_.dim == 1 ? model.options().area
                                            : std::pow(description_.ports[port].geometry.spacing,
                                                       static_cast<double>(description_.dim) - 1.0);
  return strain * model.material().moduli().youngs() * area;
}

/// Where steps need its stiffness anyway: one factor then serves all patterns.
bool SolidInterior::probed_as_linear() const {
  return parts_.deforms && parts_.scheme.integrator->able().inertia != nullptr &&
         std::isinf(description_.stable_step);
}

bool SolidInterior::rest(std::size_t) {
  Motion& motion = state_.motion;
  const std::size_t coordinates = motion.q.size(), rates = motion.v.size();
  state_ = State{};
  motion.q.assign(coordinates, 0.0);
  if (parts_.rigid != nullptr) motion.q = parts_.rigid->coordinates({});  // an attitude is not 0
  motion.v.assign(rates, 0.0);
  MasslessLayer* layer = parts_.scheme.integrator->able().layer;
  if (layer != nullptr) layer->release();
  state_.port_force.assign(port_map_->values(), 0.0);
  if (loaded_) return false;
  Problem& problem = *parts_.problem;  // others refer to it
  loaded_ = std::make_unique<Problem>();
  loaded_->loads.swap(problem.loads);
  loaded_->supports = problem.supports;
  loaded_->model = problem.model;
  if (!problem.model->is_linear() && probed_as_linear()) {
    linearised_ = std::make_unique<LinearisedModel>(*problem.model);
    if (linearised_->ready()) problem.model = linearised_.get();
    if (layer != nullptr) layer->forget();
  }
  problem.loads.push_back(std::move(loaded_->loads.back()));  // the forces on ports
  loaded_->loads.pop_back();
  for (Prescribed& support : problem.supports) support.value = [](double) { return 0.0; };
  return false;
}

void SolidInterior::wake() {
  Problem& problem = *parts_.problem;
  loaded_->loads.push_back(std::move(problem.loads.back()));
  problem.loads.swap(loaded_->loads);
  problem.supports = std::move(loaded_->supports);
  if (problem.model != loaded_->model) {
    problem.model = loaded_->model;
    if (MasslessLayer* layer = parts_.scheme.integrator->able().layer) layer->forget();
  }
  linearised_.reset();
  loaded_.reset();
}

}  // namespace abut
