#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// A scalar as a function of the reference position (x, y, z) [m] and time [s].
using ScalarField = std::function<double(const std::array<double, 3>&, double)>;
/// A vector, component by component; an absent component is zero.
using VectorField = std::array<ScalarField, 3>;

/// Points of a side at which loads on it are integrated.
struct SidePoints {
  struct Point {
    std::array<double, 3> position = {0.0, 0.0, 0.0};  // [m] reference
    double area = 0.0;                                 // [m^2] reference, weight included
    double size = 0.0;  // the same of the mesh alone, in the plane [m]: whatever depth it has
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // outward unit normal, reference
    std::vector<double> n, dn;                         // of the facet's element
    double weight = 0.0;                               // of the quadrature rule
  };
  struct FacetPoints {
    std::vector<std::int32_t> nodes;
    std::vector<Point> points;
  };
  std::vector<FacetPoints> facets;

  /// Throws InputError when the mesh has no such side.
  static SidePoints of(const FeModel& model, const std::string& side);
  double area() const;  // [m^2] reference
};

/// Force per reference volume: density x acceleration, e.g. gravity [m/s^2]. With the mass matrix
/// of the scheme a free body falls as one: M q'' = M b.
class BodyForce final : public Load {
 public:
  BodyForce(const FeModel& model, VectorField acceleration, MassForm mass = MassForm::consistent);
  /// With the mass of a body in its passive form, FeModel::whole_mass().
  static std::unique_ptr<BodyForce> of_whole_mass(const FeModel& model, VectorField acceleration);
  /// As statics has it, whatever coordinates are without mass: FeModel::whole_consistent_mass().
  static std::unique_ptr<BodyForce> of_statics(const FeModel& model, VectorField acceleration);
  void add(double time, std::span<const double> q, Vector& force) const override;
  bool follows() const override { return false; }

 private:
  const FeModel& model_;
  VectorField acceleration_;
  MassForm mass_;
  bool whole_ = false;
  SparseMatrix of_statics_;  // [kg] (dofs, dofs); empty: by mass_
  mutable Vector nodal_;  // [m/s^2] (dofs)
};

/// Dead traction on a side: force per reference area [Pa], in the axes of space.
class Traction final : public Load {
 public:
  Traction(const FeModel& model, const std::string& side, VectorField traction);
  void add(double time, std::span<const double> q, Vector& force) const override;
  bool follows() const override { return false; }

 private:
  const FeModel& model_;
  SidePoints side_;
  VectorField traction_;
  mutable Vector nodal_;  // [N] (dofs)
};

/// Pressure on a side [Pa], positive towards the body. Dead: along the reference normal, per
/// reference area. Follower: along the present normal, per present area; its stiffness, made
/// symmetric, joins the tangent [M.47]. Throws InputError for a follower on a bar, whose
/// present area its nodes do not know.
class Pressure final : public Load {
 public:
  Pressure(const FeModel& model, const std::string& side, ScalarField pressure, bool follows);
  void add(double time, std::span<const double> q, Vector& force) const override;
  bool follows() const override { return follows_; }
  void add_tangent(double time, std::span<const double> q, SparseMatrix& tangent) const override;

 private:
  using Tangents = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2>;

  Tangents tangents_at(const SidePoints::Point& point) const;
  void find_present(const SidePoints::FacetPoints& facet, std::span<const double> u) const;
  void add_stiffness(const SidePoints::Point& point, double time) const;

  const FeModel& model_;
  SidePoints side_;
  ScalarField pressure_;
  bool follows_;
  mutable std::vector<double> u_;               // [m] (dofs) in the axes of space
  mutable Vector nodal_;                        // [N] (dofs)
  mutable Eigen::Matrix3Xd present_;            // [m] (3, nodes of a facet)
  mutable Eigen::MatrixXd local_, transposed_;  // [N/m] of a facet
};

}  // namespace abut
