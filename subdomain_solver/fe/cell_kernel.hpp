#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/index.hpp"
#include "subdomain_solver/materials/material.hpp"

namespace abut {

/// Treatment of volume change inside a cell [M.44].
enum class Formulation {
  full,             // pointwise
  mean_dilatation,  // one volume change per cell, a linear field of it per quadratic cell: no
                    // locking when nearly incompressible (B-bar when the material is linear, F-bar
                    // from an energy when it is not); simplices have no more points than that and
                    // stay as they are
  one_point         // the mean gradient of the cell and an hourglass stiffness [M.51, M.52]; cells
                    // of one point are as they are, quadratic ones have no such form
};

/// Reference geometry of one cell at its quadrature points: what never changes.
struct CellGeometry {
  int nodes = 0, points = 0, dim = 0;
  std::span<const double> volume;     // [m^3] (points) weight x Jacobian x thickness
  std::span<const double> gradient;   // [1/m] (points, nodes, dim) dN/dX
  std::span<const double> hoop;       // [1/m] (points, nodes) N/R of axisymmetric cells; else empty
  std::span<const double> hourglass;  // [N/m] (1 or dim, nodes, nodes) stiffness of all
                                      // components alike, or of each its own; else empty
  /// (fields, points) what the volume change of mean dilatation is made of, orthonormal in the mean
  /// over the cell's volume, 1 the first; empty: pointwise.
  std::span<const double> dilatation;
};

/// One cell's answer. Buffers are reused from cell to cell.
struct CellResponse {
  Eigen::VectorXd force;                   // [N] (nodes x dim)
  Eigen::MatrixXd tangent;                 // [N/m] symmetric
  double stored = 0.0, dissipation = 0.0;  // [J]
};

/// Internal force and tangent of a cell, total Lagrangian: f = sum_p B^T S [M.42] and
/// K = sum_p B^T D B [M.43]. B maps nodal displacements to dF; S and D are stress and moduli of a
/// point times its volume. Mean dilatation changes S and D, and adds a term of rank two to K for
/// every field of volume change [M.45].
class CellKernel {
 public:
  explicit CellKernel(const Material& material) : material_(material) {}

  /// Numbers of history per quadrature point.
  int history_size() const;
  /// u: [m] (nodes x dim); history: (points, history_size()). False: inadmissible.
  [[nodiscard]] bool evaluate(const CellGeometry& cell, std::span<const double> u,
                              std::span<const double> before, std::span<double> after, Need want,
                              CellResponse& out);
  /// F of a quadrature point as the material sees it in the last evaluated cell, P beside it.
  const Matrix3& deformation(int point) const { return points_[point].f; }
  const Matrix3& stress(int point) const { return points_[point].response.stress; }
  /// From now on laws are stiffened, or not, where they are crushed [M.140].
  void guard(bool on) { guarded_ = on; }
  bool guarded() const { return guarded_; }

 private:
  struct Point {
    double volume = 0.0;  // [m^3] reference
    Matrix3 f = Matrix3::Identity();
    PointResponse response;
    Matrix3 force;   // S [J]
    Tangent moduli;  // D [J]
    // Of mean dilatation, where Fbar = s F; identities and ones where the law is linear.
    double jacobian = 1.0, stretch = 1.0;   // det F; s
    double dilatation = 1.0;                // theta
    double pressure = 0.0;                  // [Pa] that works on theta, times J
    Matrix3 inverse = Matrix3::Identity();  // F^-T
    Matrix3 carrier = Matrix3::Identity();  // what d/3 multiplies in dFbar: Fbar
    Matrix3 swell, coupling;  // [m^3] V dJ/dF; [J] mixed second derivative by theta and F
    double stiffness = 0.0;   // [J] second derivative by theta
  };

  [[nodiscard]] bool evaluate_points(const CellGeometry& cell, std::span<const double> u,
                                     std::span<const double> before, std::span<double> after,
                                     Need want, CellResponse& out);
  static void add_hourglass(const CellGeometry& cell, std::span<const double> u, Need want,
                            CellResponse& out);
  int entry(int direction, int column) const;
  const Eigen::MatrixXd& along(int direction) const;
  void fill_operators(const CellGeometry& cell);
  void deform(std::span<const double> u);
  bool average_volume();
  double in_fields(std::size_t point, const Eigen::VectorXd& amounts) const;
  bool respond(std::span<const double> before, std::span<double> after, Need want,
               CellResponse& out);
  void split_force();
  void split_moduli();
  void couple_fields(Eigen::MatrixXd& tangent);
  void integrate(Matrix3 Point::*field, std::span<const double> weights,
                 Eigen::Ref<Eigen::VectorXd> out);
  void integrate_moduli(Eigen::MatrixXd& out);

  const Material& material_;
  bool guarded_ = false;
  std::vector<Point> points_;
  int dim_ = 3, nodes_ = 0;
  /// (nodes, 3 x points) B: derivatives of three entries of F at a point by the displacements along
  /// one direction. In space the first matrix serves all directions.
  std::array<Eigen::MatrixXd, 2> b_;
  double volume_ = 0.0;  // [m^3] of the cell
  std::span<const double>
      fields_;                // (fields, points) of the cell's volume change; empty: pointwise
  Eigen::VectorXd amounts_;   // (fields) what of each there is
  Eigen::MatrixXd swelling_;  // (nodes x dim, fields) their derivatives by displacement
  Eigen::MatrixXd coupling_, added_;  // work space (nodes x dim, fields)
  Eigen::MatrixXd stiffness_;         // [J] (fields, fields) second derivatives by theta
  Eigen::VectorXd entries_;           // work space (3 x points)
  Eigen::MatrixXd scaled_;            // work space (nodes, 3 x points)
  Eigen::MatrixXd part_;              // work space (nodes, nodes)
};

}  // namespace abut
