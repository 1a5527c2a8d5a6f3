// What changes from step to step, for checkpoints.

#include "coordinator/coupling/state_fields.hpp"
#include "coordinator/passive/common_step.hpp"

namespace abut {

void CommonStep::state(Archive& archive) {
  archive.field("energies", energies_);
  impacts_.state(archive);
  sliding_.state(archive);
  archive.field("accounts", accounts_);
  archive.field("most", most_);
  field(archive, "places", from_);
  ties_.state(archive);
  for (std::size_t b = 0; b < displacements_.size(); ++b) {
    const std::size_t ports = bodies_.describe(static_cast<int>(b)).ports.size();
    displacements_[b].resize(ports);
    replies_[b].ports.resize(ports);
    port_work_[b].resize(ports, 0.0);
    for (std::size_t p = 0; p < ports; ++p) {
      archive.field("displacement", displacements_[b][p]);
      archive.field("velocity", replies_[b].ports[p].velocity);
    }
  }
  std::vector<std::pair<DistanceRow::Key, Eigen::Vector3d>> warm(warm_.begin(), warm_.end());
  list(archive, "warm", warm, [](Archive& a, auto& row) {
    for (std::int32_t& part : row.first) whole(a, "key", part);
    for (double& part : row.second) a.field("impulse", part);
  });
  warm_ = {warm.begin(), warm.end()};
  std::vector<std::pair<std::int32_t, double>> owed(owed_.begin(), owed_.end());
  list(archive, "owed", owed, [](Archive& a, auto& point) {
    whole(a, "point", point.first);
    a.field("joules", point.second);
  });
  owed_ = {owed.begin(), owed.end()};
}

}  // namespace abut
