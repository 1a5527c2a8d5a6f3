#include "subdomain_solver/solid_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace abut {

namespace {

constexpr std::array<const char*, 3> axes = {"x", "y", "z"};

struct StressEntry {
  const char* name;
  int row, column;
};
constexpr std::array<StressEntry, 6> stress_entries = {
    {{"xx", 0, 0}, {"yy", 1, 1}, {"zz", 2, 2}, {"xy", 0, 1}, {"yz", 1, 2}, {"zx", 2, 0}}};

/// Entries that a body of this dimension has: no shear out of the plane, and a bar has one.
int stress_count(int dim) { return dim == 3 ? 6 : dim == 2 ? 4 : 1; }

/// First component of angular momentum that it has; 3: none.
int first_spin(int dim) { return dim == 3 ? 0 : dim == 2 ? 2 : 3; }

/// Smallest, largest and mean value of each component of a nodal field (nodes, dim).
void summarise(const std::vector<double>& field, int dim, std::vector<double>& out) {
  const std::size_t d = static_cast<std::size_t>(dim);
  for (std::size_t i = 0; i < d; ++i) {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0.0;
    for (std::size_t k = i; k < field.size(); k += d) {
      low = std::min(low, field[k]);
      high = std::max(high, field[k]);
      sum += field[k];
    }
    out.insert(out.end(), {low, high, sum / (static_cast<double>(field.size()) / dim)});
  }
}

/// Means over the quadrature points of Cauchy and von Mises stress, and the largest of the latter.
void add_stress(FeModel& model, const SolidState& state, std::vector<double>& out) {
  Matrix3 sum = Matrix3::Zero();
  double mises = 0.0, most = 0.0;
  std::int64_t points = 0;
  const bool admissible =
      model.visit(state.q, state.history, [&](const FeModel::PointState& point) {
        const Matrix3 stress = cauchy_stress(model.material(), point.stress, point.deformation);
        sum += stress;
        mises += von_mises(stress);
        most = std::max(most, von_mises(stress));
        ++points;
      });
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const double each = admissible ? 1.0 / static_cast<double>(points) : nothing;
  for (int k = 0; k < stress_count(model.mesh().dim); ++k) {
    const StressEntry& entry = stress_entries[static_cast<std::size_t>(k)];
    out.push_back(sum(entry.row, entry.column) * each);
  }
  out.insert(out.end(), {mises * each, admissible ? most : nothing});
}

}  // namespace

std::vector<double> angular_momentum(const Mesh& mesh, const std::vector<double>& u,
                                     const Vector& nodal_momentum) {
  if (mesh.dim == 1) return {};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int node = 0; node < mesh.node_count(); ++node) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), p = Eigen::Vector3d::Zero();
    for (int i = 0; i < mesh.dim; ++i) {
      const std::size_t at = static_cast<std::size_t>(node * mesh.dim + i);
      x(i) = mesh.points[at] + u[at];
      p(i) = nodal_momentum(node * mesh.dim + i);
    }
    sum += x.cross(p);
  }
  if (mesh.dim == 2) return {sum(2)};
  return {sum(0), sum(1), sum(2)};
}

std::vector<std::string> solid_measure_names(int dim, bool deforms,
                                             const std::vector<NamedNodes>& ports) {
  std::vector<std::string> names;
  for (const char* field : {"displacement", "velocity"}) {
    for (int i = 0; i < dim; ++i) {
      for (const char* what : {"min", "max", "mean"})
        names.push_back(fmt::format("{}.{}.{}", field, axes[static_cast<std::size_t>(i)], what));
    }
  }
  for (int k = 0; k < stress_count(dim) && deforms; ++k)
    names.push_back(
        fmt::format("stress.{}.mean", stress_entries[static_cast<std::size_t>(k)].name));
  if (deforms) names.insert(names.end(), {"von_mises.mean", "von_mises.max"});
  names.insert(names.end(),
               {"energy.kinetic", "energy.stored", "energy.dissipated", "energy.external_work"});
  for (int i = 0; i < dim; ++i)
    names.push_back(fmt::format("momentum.{}", axes[static_cast<std::size_t>(i)]));
  for (int i = first_spin(dim); i < 3; ++i)
    names.push_back(fmt::format("angular_momentum.{}", axes[static_cast<std::size_t>(i)]));
  for (const NamedNodes& port : ports) {
    for (const char* field : {"displacement", "velocity"}) {
      for (int i = 0; i < dim; ++i)
        names.push_back(
            fmt::format("{}.{}.{}", port.name, field, axes[static_cast<std::size_t>(i)]));
    }
  }
  return names;
}

Matrix3 cauchy_stress(const Material& material, const Matrix3& stress, const Matrix3& deformation) {
  if (material.is_linear()) return stress;
  return stress * deformation.transpose() / deformation.determinant();
}

double von_mises(const Matrix3& stress) {
  const Matrix3 deviator = stress - stress.trace() / 3.0 * Matrix3::Identity();
  return std::sqrt(1.5 * deviator.squaredNorm());
}

std::vector<double> solid_measures(FeModel& model, const SolidState& state,
                                   const std::vector<NamedNodes>& ports) {
  const int dim = model.mesh().dim;
  const Energy& energy = state.energy;
  const std::vector<double>& v = state.velocity;
  std::vector<double> out, u(state.q.begin(), state.q.end());
  model.to_space(u);
  summarise(u, dim, out);
  summarise(v, dim, out);
  if (state.deforms) add_stress(model, state, out);
  out.insert(out.end(), {energy.kinetic, energy.stored, energy.dissipated, energy.external_work});
  for (int i = 0; i < dim; ++i)
    out.push_back(state.nodal_momentum(Eigen::seqN(i, model.mesh().node_count(), dim)).sum());
  const std::vector<double> angular = angular_momentum(model.mesh(), u, state.nodal_momentum);
  out.insert(out.end(), angular.begin(), angular.end());
  for (const NamedNodes& port : ports) {
    for (const std::vector<double>* field : {&std::as_const(u), &v}) {
      for (int i = 0; i < dim; ++i) {
        double total = 0.0;
        for (std::int32_t node : port.nodes)
          total += (*field)[static_cast<std::size_t>(node * dim + i)];
        out.push_back(total / static_cast<double>(port.nodes.size()));
      }
    }
  }
  return out;
}

}  // namespace abut
