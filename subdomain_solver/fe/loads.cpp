#include "subdomain_solver/fe/loads.hpp"

#include <Eigen/Geometry>

#include "base/error.hpp"
#include "base/index.hpp"

namespace abut {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Normal times area per unit of reference area: cross product of the tangents, or the tangent
/// turned clockwise. Columns of `tangents` (3, facet dimension).
template <class Tangents>
Eigen::Vector3d directed_area(const Tangents& tangents) {
  if (tangents.cols() == 2)
    return Eigen::Vector3d(tangents.col(0)).cross(Eigen::Vector3d(tangents.col(1)));
  return {tangents(1, 0), -tangents(0, 0), 0.0};
}

double value(const ScalarField& field, const std::array<double, 3>& at, double time) {
  return field ? field(at, time) : 0.0;
}

double depth(const FeModel& model, double radius) {
  return model.options().depth(model.mesh().dim, radius);
}

/// Adds forces on nodes given in the axes of space; turns them.
void add_nodal(const FeModel& model, Vector& nodal, Vector& force) {
  model.to_frames({nodal.data(), index(nodal.size())});
  force += nodal;
}

}  // namespace

SidePoints SidePoints::of(const FeModel& model, const std::string& side) {
  const Mesh& mesh = model.mesh();
  const int dim = mesh.dim;
  SidePoints out;
  for (const Facet& facet : mesh.side(side)) {
    const Element& element = element_named(mesh.blocks[facet.block].element->facet_name);
    const Tabulation table = tabulate(element, quadrature(element.shape, 2 * element.order + 1));
    FacetPoints f{mesh.nodes_of(facet), {}};
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(3, table.nodes);
    for (int a = 0; a < table.nodes; ++a) {
      for (int i = 0; i < dim; ++i) x(i, a) = mesh.points[f.nodes[index(a)] * dim + i];
    }
    for (int p = 0; p < table.points; ++p) {
      Point point;
      const double* n = table.n.data() + index(p * table.nodes);
      const double* dn = table.dn.data() + index(p * table.nodes * table.dim);
      point.n.assign(n, n + table.nodes);
      point.dn.assign(dn, dn + table.nodes * table.dim);
      point.weight = table.weight[p];
      const Eigen::Vector3d position = x * Eigen::Map<const Vector>(n, table.nodes);
      point.position = {position(0), position(1), position(2)};
      const Eigen::Vector3d end(facet.local == 0 ? -1.0 : 1.0, 0.0, 0.0);  // of a line
      const Eigen::MatrixXd tangents = x * Eigen::Map<const Rows>(dn, table.nodes, table.dim);
      const Eigen::Vector3d area = dim == 1 ? end : directed_area(tangents);
      point.size = area.norm() * point.weight;
      point.area = point.size * depth(model, position(0));
      point.normal = area.normalized();
      f.points.push_back(std::move(point));
    }
    out.facets.push_back(std::move(f));
  }
  return out;
}

double SidePoints::area() const {
  double sum = 0.0;
  for (const FacetPoints& facet : facets) {
    for (const Point& point : facet.points) sum += point.area;
  }
  return sum;
}

BodyForce::BodyForce(const FeModel& model, VectorField acceleration, MassForm mass)
    : model_(model), acceleration_(std::move(acceleration)), mass_(mass) {}

std::unique_ptr<BodyForce> BodyForce::of_whole_mass(const FeModel& model,
                                                    VectorField acceleration) {
  auto load = std::make_unique<BodyForce>(model, std::move(acceleration), MassForm::lumped);
  load->whole_ = true;
  return load;
}

std::unique_ptr<BodyForce> BodyForce::of_statics(const FeModel& model, VectorField acceleration) {
  auto load = std::make_unique<BodyForce>(model, std::move(acceleration));
  load->of_statics_ = model.whole_consistent_mass();
  return load;
}

/// The acceleration is interpolated between the nodes: f = M b, exact where b is uniform.
void BodyForce::add(double time, std::span<const double>, Vector& force) const {
  const Mesh& mesh = model_.mesh();
  const int dim = mesh.dim;
  Vector& b = nodal_;
  b.setZero(model_.dofs());
  const int nodes = mesh.node_count();
  for (int node = 0; node < nodes; ++node) {
    std::array<double, 3> at = {0.0, 0.0, 0.0};
    for (int i = 0; i < dim; ++i) at[i] = mesh.points[node * dim + i];
    for (int i = 0; i < dim; ++i) b(node * dim + i) = value(acceleration_[i], at, time);
  }
  model_.to_frames({b.data(), index(b.size())});
  if (of_statics_.size() > 0) {
    force.noalias() += of_statics_ * b;
    return;
  }
  const double share = mass_ == MassForm::averaged ? 0.5 : 1.0;  // as mass_matrix() does
  const Vector& lumped = whole_ ? model_.whole_mass() : model_.lumped_mass();
  if (mass_ != MassForm::consistent) force += share * lumped.cwiseProduct(b);
  if (mass_ != MassForm::lumped) force.noalias() += share * (model_.mass() * b);
}

Traction::Traction(const FeModel& model, const std::string& side, VectorField traction)
    : model_(model), side_(SidePoints::of(model, side)), traction_(std::move(traction)) {}

void Traction::add(double time, std::span<const double>, Vector& force) const {
  const int dim = model_.mesh().dim;
  Vector& nodal = nodal_;
  nodal.setZero(model_.dofs());
  for (const SidePoints::FacetPoints& facet : side_.facets) {
    for (const SidePoints::Point& point : facet.points) {
      for (int i = 0; i < dim; ++i) {
        const double f = point.area * value(traction_[i], point.position, time);
        for (std::size_t a = 0; a < facet.nodes.size(); ++a)
          nodal(facet.nodes[a] * dim + i) += f * point.n[a];
      }
    }
  }
  add_nodal(model_, nodal, force);
}

Pressure::Pressure(const FeModel& model, const std::string& side, ScalarField pressure,
                   bool follows)
    : model_(model),
      side_(SidePoints::of(model, side)),
      pressure_(std::move(pressure)),
      follows_(follows) {
  if (follows && model.mesh().dim == 1)
    throw InputError("follows the body, but the ends of a bar keep their area", side,
                     "Leave follows out: the pressure acts on the reference area.");
}

/// Present positions of a facet's nodes.
void Pressure::find_present(const SidePoints::FacetPoints& facet, std::span<const double> u) const {
  const Mesh& mesh = model_.mesh();
  const int dim = mesh.dim;
  present_.setZero(3, static_cast<Eigen::Index>(facet.nodes.size()));
  for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
    for (int i = 0; i < dim; ++i) {
      const std::size_t at = index(facet.nodes[a] * dim + i);
      present_(i, static_cast<Eigen::Index>(a)) = mesh.points[at] + u[at];
    }
  }
}

void Pressure::add(double time, std::span<const double> q, Vector& force) const {
  const int dim = model_.mesh().dim;
  if (follows_) {
    u_.assign(q.begin(), q.end());
    model_.to_space(u_);
  }
  Vector& nodal = nodal_;
  nodal.setZero(model_.dofs());
  for (const SidePoints::FacetPoints& facet : side_.facets) {
    if (follows_) find_present(facet, u_);
    const int nodes = static_cast<int>(facet.nodes.size());
    for (const SidePoints::Point& point : facet.points) {
      Eigen::Vector3d area = point.area * point.normal;
      if (follows_) {
        const double radius = present_.row(0).dot(Eigen::Map<const Vector>(point.n.data(), nodes));
        area = directed_area(tangents_at(point)) * point.weight * depth(model_, radius);
      }
      const Eigen::Vector3d f = -value(pressure_, point.position, time) * area;
      for (std::size_t a = 0; a < facet.nodes.size(); ++a) {
        for (int i = 0; i < dim; ++i) nodal(facet.nodes[a] * dim + i) += f(i) * point.n[a];
      }
    }
  }
  add_nodal(model_, nodal, force);
}

/// Derivatives of the present positions at a point.
Pressure::Tangents Pressure::tangents_at(const SidePoints::Point& point) const {
  const int nodes = static_cast<int>(point.n.size());
  const int along = static_cast<int>(point.dn.size()) / nodes;
  const Eigen::Map<const Rows> dn(point.dn.data(), nodes, along);
  return present_ * dn;
}

/// -df/dq of f_a = -p N_a (x,1 cross x,2) w; in the plane of (x2,1 , -x1,1) w depth.
void Pressure::add_tangent(double time, std::span<const double> q, SparseMatrix& tangent) const {
  if (!follows_) return;
  const int dim = model_.mesh().dim;
  u_.assign(q.begin(), q.end());
  model_.to_space(u_);
  for (const SidePoints::FacetPoints& facet : side_.facets) {
    find_present(facet, u_);
    const int size = static_cast<int>(facet.nodes.size()) * dim;
    local_.setZero(size, size);
    for (const SidePoints::Point& point : facet.points) add_stiffness(point, time);
    transposed_ = local_.transpose();
    local_ = 0.5 * (local_ + transposed_);
    model_.add_to_tangent(facet.nodes, local_, tangent);
  }
}

/// A point's part of the stiffness of its facet, whose present positions are known.
void Pressure::add_stiffness(const SidePoints::Point& point, double time) const {
  const int dim = model_.mesh().dim, nodes = static_cast<int>(point.n.size());
  const int along = static_cast<int>(point.dn.size()) / nodes;
  const Eigen::Map<const Rows> dn(point.dn.data(), nodes, along);
  const Tangents tangents = tangents_at(point);
  const double radius = present_.row(0).dot(Eigen::Map<const Vector>(point.n.data(), nodes));
  const double p = value(pressure_, point.position, time) * point.weight * depth(model_, radius);
  for (int b = 0; b < nodes; ++b) {
    for (int k = 0; k < dim; ++k) {
      Eigen::Vector3d change = Eigen::Vector3d::Zero();  // of the directed area
      for (int d = 0; d < along; ++d) {
        Tangents moved = tangents;
        moved.col(d) = Eigen::Vector3d::Unit(k) * dn(b, d);
        change += directed_area(moved);
      }
      for (int a = 0; a < nodes; ++a) {
        for (int i = 0; i < dim; ++i)
          local_(a * dim + i, b * dim + k) += p * point.n[a] * change(i);
      }
    }
  }
}

}  // namespace abut
