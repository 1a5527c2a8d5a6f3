#include "subdomain_solver/materials/crush_guard.hpp"

#include <Eigen/LU>

#include "subdomain_solver/materials/finite_strain.hpp"

namespace abut {

void guard_against_crushing(const Matrix3& f, double p_wave, Need want, PointResponse& out) {
  constexpr double share = 0.2;  // of the modulus: more barely moves where cells come to rest
  const double j = f.determinant();
  if (!(j > 0.0 && j < crushed)) return;
  const double c = share * p_wave, past = crushed / j - 1.0;
  const double slope = -3.0 * c * past * past * crushed / j;  // J dW/dJ
  const double curve =                                        // J^2 d2W/dJ2
      6.0 * c * past * crushed / j * (crushed / j + past);
  const Matrix3 inverse = f.inverse().transpose();
  out.energy += c * past * past * past;
  out.stress += slope * inverse;
  if (want == Need::tangent)
    out.tangent += (curve + slope) * outer(inverse, inverse) - slope * crossed(inverse, inverse);
}

}  // namespace abut
