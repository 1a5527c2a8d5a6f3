#pragma once

#include <optional>
#include <vector>

#include "subdomain_solver/contact/point_obstacle.hpp"
#include "subdomain_solver/contact/port_contact.hpp"

namespace abut {

/// Contact of a solid in one dimension: at its ports of one massless point each, one row n (x - y)
/// <= gap per port that meets an obstacle.
class PointContact final : public PortContact {
 public:
  struct Point {
    std::size_t port = 0;
    int dof = 0;
    double place = 0.0;    // [m] in the reference
    double outward = 0.0;  // normal: 1 or -1
  };
  /// `step`: [s] of the body, which is named for people.
  PointContact(const std::vector<Point>& points, double step, const std::string& body);

  /// Throws RunError for what points cannot take.
  void impose(const Window& window) override;
  bool acts() const override { return !dofs_.empty(); }
  bool acts(std::size_t port) const override;
  bool has(std::size_t port) const override;
  void hold(const std::vector<double>& forces, std::vector<double>& now) const override;
  void aim(int i, const std::vector<double>& forces, const std::vector<double>&) override;
  void settle(std::vector<double>& forces) override;
  void react(std::size_t port, std::size_t partner, const std::vector<double>& forces,
             std::vector<double>& out) const override;
  std::string misfit(std::size_t port, const PortKernel& kernel) const override;

  const std::vector<int>& coordinates() const override { return dofs_; }
  const Vector* solve(double time, const Vector& free, Compliance& give) override;

 private:
  struct End {
    Point point;
    PointObstacle obstacle;
    PointObstacle::Surface surface;  // at the end of the present substep
  };
  double push(const End& end, bool in_substep, double time, double free, double give) const;

  double step_;
  std::vector<End> ends_;            // by coordinate
  std::vector<std::size_t> acting_;  // of ends_, in the order of dofs_
  std::vector<int> dofs_;
  Substeps grid_;
  double aim_ = 0.0;  // [s] end of the present substep
  Vector force_;
};

}  // namespace abut
