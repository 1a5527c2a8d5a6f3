#include "coordinator/reply_bytes.hpp"

namespace abut {

double reply_bytes(const Description& body, double times, double records) {
  constexpr double number = sizeof(double);
  constexpr double fields = 3.0;    // u, v, f
  constexpr double energies = 5.0;  // with the time
  const double dim = body.dim, rotations = body.dim < 3 ? body.dim - 1 : body.dim;
  double values = 0.0;
  for (const Port& port : body.ports) values += static_cast<double>(port.geometry.points.size());
  const double boxes = 2.0 * dim * static_cast<double>(body.ports.size());
  const double sums = energies + dim + rotations + static_cast<double>(body.columns.size()) +
                      static_cast<double>(body.members.size()) * (energies + dim);
  return number * (times * fields * values + records * (boxes + sums));
}

}  // namespace abut
