#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Treatment of volume change inside a cell [M.44].
enum class Formulation {
  full,            // pointwise
  mean_dilatation  // one volume change per cell: no locking when nearly incompressible (B-bar when
                   // the material is linear, F-bar from an energy when it is not)
};

/// Reference geometry of one cell at its quadrature points: what never changes.
struct CellGeometry {
  int nodes = 0, points = 0, dim = 0;
  std::span<const double> volume;    // [m^3] (points) weight x Jacobian x thickness
  std::span<const double> gradient;  // [1/m] (points, nodes, dim) dN/dX
  std::span<const double> hoop;      // [1/m] (points, nodes) N/R of axisymmetric cells; else empty
};

/// One cell's answer. Buffers are reused from cell to cell.
struct CellResponse {
  Eigen::VectorXd force;                   // [N] (nodes x dim)
  Eigen::MatrixXd tangent;                 // [N/m] symmetric
  double stored = 0.0, dissipation = 0.0;  // [J]
};

/// Internal force and tangent of a cell, total Lagrangian: f = sum_p V_p B^T P(F) [M.42] and
/// K = sum_p V_p B^T A B + geometric terms [M.43]. B maps nodal displacements to dF.
class CellKernel {
 public:
  CellKernel(const Material& material, Formulation formulation)
      : material_(material), formulation_(formulation) {}

  /// Numbers of history per quadrature point.
  int history_size() const;
  /// u: [m] (nodes x dim); history: (points, history_size()). False: inadmissible.
  [[nodiscard]] bool evaluate(const CellGeometry& cell, std::span<const double> u,
                              std::span<const double> before, std::span<double> after, Want want,
                              CellResponse& out);
  /// F of a quadrature point as the material sees it in the last evaluated cell, P beside it.
  const Matrix3& deformation(int point) const { return points_[static_cast<std::size_t>(point)].f; }
  const Matrix3& stress(int point) const {
    return points_[static_cast<std::size_t>(point)].response.stress;
  }

 private:
  // Entries of F that vary: all nine in space; 11, 21, 12, 22 and 33 in the plane.
  static constexpr int most_components = 9;
  using Components = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_components, 1>;
  using Operator = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;
  struct Point {
    Matrix3 f = Matrix3::Identity(), inverse = Matrix3::Identity();
    double jacobian = 1.0, stretch = 1.0;  // det F; s: Fbar = s F in mean dilatation
    PointResponse response;
    Operator b;  // (components, nodes x dim)
  };

  void deform(const CellGeometry& cell, std::span<const double> u);
  bool average_volume(const CellGeometry& cell);
  bool respond(const CellGeometry& cell, std::span<const double> before, std::span<double> after,
               Want want, CellResponse& out);
  void fill_operator(const CellGeometry& cell, std::size_t p, Operator& b) const;
  void average_operator(Point& point);
  void add_force(const CellGeometry& cell, CellResponse& out) const;
  void add_tangent(const CellGeometry& cell, CellResponse& out);
  void add_geometric(const CellGeometry& cell, CellResponse& out);
  void fill_exchange(const CellGeometry& cell, std::size_t p);
  Components vary(const Matrix3& tensor) const;

  const Material& material_;
  Formulation formulation_;
  std::vector<Point> points_;
  int dim_ = 3;
  double dilatation_ = 1.0;        // theta: mean det F of the cell; linear: mean trace of grad u
  Eigen::VectorXd mean_gradient_;  // d theta / du (nodes x dim)
  Operator scaled_;                // work space
  Eigen::MatrixXd exchange_;       // work space (nodes x dim, nodes x dim)
};

}  // namespace abut
