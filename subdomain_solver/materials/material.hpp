#pragma once

#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "subdomain_solver/materials/moduli.hpp"

namespace abut {

using Matrix3 = Eigen::Matrix3d;
/// dP_iJ / dF_kL at row i + 3 J, column k + 3 L: the order in which Eigen stores a matrix.
using Tangent = Eigen::Matrix<double, 9, 9>;

/// What a material answers at one point.
struct PointResponse {
  double energy = 0.0;       // [J/m^3] stored, per reference volume
  double dissipation = 0.0;  // [J/m^3] dissipated in this update, per reference volume
  Matrix3 stress;            // [Pa] first Piola-Kirchhoff P = d(energy + dissipation)/dF
  Tangent tangent;           // [Pa] dP/dF, only when wanted
};

/// A number of the history that people want to see: its name and its place at a point.
struct NamedHistory {
  std::string_view name;
  int index = 0;
};

enum class Need { stress, tangent };

/// A material law in three dimensions, in terms of the deformation gradient F. Plane strain, plane
/// stress and axisymmetry embed their F in it (plane.hpp), so a law is written once.
class Material {
 public:
  virtual ~Material() = default;
  virtual double density() const = 0;  // [kg/m^3] reference
  virtual Moduli moduli() const = 0;   // at the undeformed state: wave speeds, stable step
  /// P is linear in F: one assembly and one factorisation serve a whole run (small strain).
  virtual bool is_linear() const { return false; }
  /// Whether compression to nothing takes more and more force: a law that gives way turns inside
  /// out.
  virtual bool resists_crushing() const { return true; }
  /// Numbers per point that change with the deformation; all zero at the start.
  virtual int history_size() const { return 0; }
  /// Those among them that are told as fields; below history_size().
  virtual std::vector<NamedHistory> named_history() const { return {}; }
  /// F as the law had it, where it finds entries itself (plane stress), from the history at the
  /// step's end.
  virtual Matrix3 completed(const Matrix3& f, std::span<const double> after) const {
    (void)after;
    return f;
  }
  /// Response at F; reads the history at the step's begin and writes that at its end (both of
  /// history_size()). False: F is inadmissible (det F <= 0 for finite-strain laws, numbers that
  /// are not finite, no local convergence) and out and after are undefined.
  [[nodiscard]] virtual bool evaluate(const Matrix3& f, std::span<const double> before,
                                      std::span<double> after, Need want,
                                      PointResponse& out) const = 0;
};

}  // namespace abut
