#pragma once

#include <optional>
#include <vector>

#include "subdomain_solver/contact/point_obstacle.hpp"
#include "subdomain_solver/time/contact.hpp"

namespace abut {

/// Contact of a solid in one dimension: at its ports of one massless point each, one row n (x - y)
/// <= gap per port that meets an obstacle.
class PointContact final : public Contact {
 public:
  struct Point {
    std::size_t port = 0;
    int dof = 0;
    double place = 0.0;    // [m] in the reference
    double outward = 0.0;  // normal: 1 or -1
  };
  /// `body`: its name, for people.
  PointContact(const std::vector<Point>& points, const std::string& body);

  /// What is imposed over a window. Throws RunError for what points cannot take.
  void impose(const Window& window);
  bool acts() const { return !dofs_.empty(); }
  bool acts(std::size_t port) const;
  bool has(std::size_t port) const;
  /// The window's substep i is next, 0: its begin. `forces`: [N] on the body by port, now.
  void aim(int i, const std::vector<double>& forces);
  /// Puts the forces [N] on the body that were solved for last to those of all ports.
  void add_to(std::vector<double>& forces) const;

  const std::vector<int>& coordinates() const override { return dofs_; }
  const Vector& solve(double time, const Vector& free, const Eigen::MatrixXd& compliance) override;

 private:
  struct End {
    Point point;
    PointObstacle obstacle;
    PointObstacle::Surface surface;  // at the end of the present substep
  };
  double push(const End& end, bool in_substep, double time, double free, double give) const;

  std::vector<End> ends_;            // by coordinate
  std::vector<std::size_t> acting_;  // of ends_, in the order of dofs_
  std::vector<int> dofs_;
  Substeps grid_;
  double aim_ = 0.0;  // [s] end of the present substep
  Vector force_;
};

}  // namespace abut
