#pragma once

#include <cstdint>
#include <vector>

#include "contract/point_rings.hpp"
#include "contract/port.hpp"
#include "subdomain_solver/time/contact.hpp"

namespace abut {

/// How the points that contact may press on give way to forces near them: blocks of a Compliance
/// for points that some facets part at most, found by pressing points that are far from each other
/// at once. Where forces are felt too far away there is none.
class NearCompliance {
 public:
  /// Points are contact's coordinates by `dim`; facets as those of a PortGeometry, of all surfaces.
  void set_points(int points, int dim, const std::vector<std::int32_t>& facets,
                  const std::vector<std::int32_t>& offsets);
  bool has_points() const { return !rings_of_.empty(); }
  /// Finds it, unless it is known of these columns. False: forces are felt too far away, or there
  /// is no answer.
  [[nodiscard]] bool find(Compliance& give);
  /// The columns of a Compliance are others without another version.
  void forget() { known_ = nullptr; }
  /// One step, of all points.
  const PortKernel& kernel() const { return kernel_; }

 private:
  [[nodiscard]] bool find_reach(Compliance& give);
  [[nodiscard]] bool press(Compliance& give);

  std::vector<PointRings> rings_of_;  // none or one
  std::size_t dim_ = 3;
  const Compliance* known_ = nullptr;  // whose columns, of a version
  std::size_t version_ = 0;
  bool near_ = false;
  int rings_ = 0;
  PortKernel kernel_;
  Vector force_, moved_;
};

}  // namespace abut
