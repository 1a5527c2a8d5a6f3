#include "subdomain_solver/time/contact.hpp"

namespace abut {

namespace {

/// Coordinates that are pressed: more of them move by one solution.
constexpr Eigen::Index most_columns = 1500;

}  // namespace

bool add_given_way(Compliance& give, double sign, const Vector& force, Vector& buffer,
                   Vector& places) {
  if ((force.array() != 0.0).count() > most_columns) {
    if (!give.apply(force, buffer)) return false;
    places.noalias() += sign * buffer;
    return true;
  }
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    if (force(k) == 0.0) continue;
    const Vector* column = give.column(static_cast<int>(k));
    if (column == nullptr) return false;
    places.noalias() += (sign * force(k)) * *column;
  }
  return true;
}

}  // namespace abut
