#include "coordinator/record/taken_back.hpp"

#include "base/index.hpp"

namespace abut {

double TakenBack::sign(const Waveform& force, const PortGeometry& own, const PortGeometry& partner,
                       std::size_t i) {
  const bool deform = own.transit > 0.0 || partner.transit > 0.0;
  if (force.support != ForceSupport::step || own.dim == 1 || deform) return 1.0;
  const std::size_t width = index(force.width), axes = index(own.dim);
  std::array<double, 3> impulse{};
  for (std::size_t k = 0; k < width; ++k) impulse[k % axes] += force.f[i * width + k];
  for (double& part : impulse) part *= force.time[i] - force.time[i - 1];
  const auto along = [](const auto& a, const auto& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const double size = along(impulse, impulse);
  if (size == 0.0) {
    pushed_ = {};
    return 1.0;
  }
  const bool pulls = along(impulse, pushed_) < 0.0 && size <= along(pushed_, pushed_);
  for (std::size_t axis = 0; axis < 3; ++axis) pushed_[axis] += impulse[axis];
  return pulls ? -1.0 : 1.0;
}

void TakenBack::state(Archive& archive) {
  for (double& part : pushed_) archive.field("pushed", part);
}

}  // namespace abut
