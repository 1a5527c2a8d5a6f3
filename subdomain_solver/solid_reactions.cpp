// Forces of the supports on a solid.

#include "subdomain_solver/solid_fields.hpp"
#include "subdomain_solver/solid_interior.hpp"
#include "subdomain_solver/time/motion_views.hpp"

namespace abut {

/// Forces on ports now, as those of nodes (nodes, dim) in their own frames [N].
const Vector& SolidInterior::forces_on_ports() {
  Vector& all = on_ports_;
  all.setZero(static_cast<Eigen::Index>(nodal_values()));
  if (port_forces_ == nullptr) return all;
  std::size_t k = 0;
  const std::size_t dim = index(description_.dim);
  for (const NamedNodes& port : ports_) {
    for (std::int32_t node : port.nodes) {
      for (int i = 0; i < description_.dim; ++i)
        all(node * description_.dim + i) += state_.port_force[k++];
    }
    const std::size_t inside = index(port.inside.count()) * dim;
    add_transposed(port.inside, description_.dim, 1.0,
                   std::span(state_.port_force).subspan(k, inside), {all.data(), nodal_values()});
    k += inside;
  }
  parts_.model->to_frames({all.data(), nodal_values()});
  return all;
}

/// [N] (constraints, dim) along the axes of space; none before the begin.
void SolidInterior::reactions(std::vector<double>& out) {
  if (!parts_.reactions) {
    out.clear();
  } else if (!state_.begun) {
    out.assign(description_.columns.size(), 0.0);
  } else if (is_passive() && !parts_.reduced) {
    sum_reactions(*parts_.model, parts_.constraints, view(state_.motion.force), out);
  } else {
    parts_.reactions->sums(state_.motion, state_.time, forces_on_ports(), out);
  }
}

FieldValues SolidInterior::nodal_reactions() {
  Vector forces = Vector::Zero(static_cast<Eigen::Index>(nodal_values()));
  if (is_passive() && !parts_.reduced) {
    forces = view(state_.motion.force);
  } else if (state_.begun) {
    parts_.reactions->forces(state_.motion, state_.time, forces_on_ports(), forces);
  }
  parts_.model->to_space({forces.data(), nodal_values()});
  return in_space(span_of(forces), description_.dim);
}

}  // namespace abut
