#include "subdomain_solver/solid_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/index.hpp"
#include "subdomain_solver/nodal_stress.hpp"

namespace abut {

namespace {

constexpr std::array<const char*, 3> measured_axes = {"x", "y", "z"};

constexpr std::array<const char*, 6> stress_names = {"xx", "yy", "zz", "xy", "yz", "zx"};

/// Entries that a body of this dimension has: no shear out of the plane, and a bar has one.
std::size_t stress_count(int dim) { return dim == 3 ? 6 : dim == 2 ? 4 : 1; }

/// First component of angular momentum that it has; 3: none.
int first_spin(int dim) { return dim == 3 ? 0 : dim == 2 ? 2 : 3; }

/// Smallest, largest and mean value of each component of a nodal field (nodes, dim).
void summarise(const std::vector<double>& field, int dim, std::vector<double>& out) {
  const std::size_t d = index(dim);
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

/// Means over the body's reference volume of Cauchy and von Mises stress, and the largest of the
/// latter at a quadrature point.
void add_stress(FeModel& model, const SolidState& state, std::vector<double>& out) {
  StressEntries sum{};
  double mises = 0.0, most = 0.0, volume = 0.0;
  const bool admissible =
      model.visit(state.q, state.history, [&](const FeModel::PointState& point) {
        const Matrix3 stress = cauchy_stress(model.material(), point.stress, point.deformation);
        const StressEntries entries = entries_of(stress);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += point.volume * entries[k];
        mises += point.volume * von_mises(stress);
        most = std::max(most, von_mises(stress));
        volume += point.volume;
      });
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const double each = admissible ? 1.0 / volume : nothing;
  for (std::size_t k = 0; k < stress_count(model.mesh().dim); ++k) out.push_back(sum[k] * each);
  out.insert(out.end(), {mises * each, admissible ? most : nothing});
}

/// Smallest and largest entries at a node, and the largest von Mises stress: of the nodes' means,
/// and that one cell alone says.
void add_nodal_stress(int dim, const NodalStress& stress, std::vector<double>& out) {
  const std::vector<StressEntries>& nodes = stress.nodes;
  for (std::size_t k = 0; k < stress_count(dim); ++k) {
    const auto [low, high] = std::minmax_element(
        nodes.begin(), nodes.end(),
        [k](const StressEntries& a, const StressEntries& b) { return a[k] < b[k]; });
    out.insert(out.end(), {(*low)[k], (*high)[k]});
  }
  double most = 0.0;
  for (const StressEntries& node : nodes) {
    const double mises = von_mises(stress_of(node));
    most = mises > most || std::isnan(mises) ? mises : most;
  }
  out.insert(out.end(), {most, stress.most_of_cells});
}

/// Means over the nodes of a port.
void add_stress_at(const NamedNodes& port, int dim, const std::vector<StressEntries>& nodes,
                   std::vector<double>& out) {
  const double each = 1.0 / static_cast<double>(port.nodes.size());
  for (std::size_t k = 0; k < stress_count(dim); ++k) {
    double sum = 0.0;
    for (std::int32_t node : port.nodes) sum += nodes[node][k];
    out.push_back(sum * each);
  }
  double mises = 0.0;
  for (std::int32_t node : port.nodes) mises += von_mises(stress_of(nodes[node]));
  out.push_back(mises * each);
}

}  // namespace

void angular_momentum(const Mesh& mesh, std::span<const double> u, const Vector& nodal_momentum,
                      std::vector<double>& out) {
  out.clear();
  if (mesh.dim == 1) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int node = 0; node < mesh.node_count(); ++node) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), p = Eigen::Vector3d::Zero();
    for (int i = 0; i < mesh.dim; ++i) {
      const std::size_t at = index(node * mesh.dim + i);
      x(i) = mesh.points[at] + u[at];
      p(i) = nodal_momentum(node * mesh.dim + i);
    }
    sum += x.cross(p);
  }
  out.insert(out.end(), mesh.dim == 2 ? sum.data() + 2 : sum.data(), sum.data() + 3);
}

std::vector<std::string> solid_measure_names(int dim, bool deforms,
                                             const std::vector<NamedNodes>& ports) {
  std::vector<std::string> names;
  for (const char* field : {"displacement", "velocity"}) {
    for (int i = 0; i < dim; ++i) {
      for (const char* what : {"min", "max", "mean"})
        names.push_back(fmt::format("{}.{}.{}", field, measured_axes[i], what));
    }
  }
  const std::size_t entries = deforms ? stress_count(dim) : 0;
  for (std::size_t k = 0; k < entries; ++k)
    names.push_back(fmt::format("stress.{}.mean", stress_names[k]));
  if (deforms) names.insert(names.end(), {"von_mises.mean", "von_mises.max"});
  for (std::size_t k = 0; k < entries; ++k) {
    for (const char* what : {"min", "max"})
      names.push_back(fmt::format("nodal_stress.{}.{}", stress_names[k], what));
  }
  if (deforms) names.insert(names.end(), {"nodal_von_mises.max", "nodal_von_mises.max_of_cells"});
  names.insert(names.end(),
               {"energy.kinetic", "energy.stored", "energy.dissipated", "energy.external_work"});
  for (int i = 0; i < dim; ++i) names.push_back(fmt::format("momentum.{}", measured_axes[i]));
  for (int i = first_spin(dim); i < 3; ++i)
    names.push_back(fmt::format("angular_momentum.{}", measured_axes[i]));
  for (const NamedNodes& port : ports) {
    for (const char* field : {"displacement", "velocity"}) {
      for (int i = 0; i < dim; ++i)
        names.push_back(fmt::format("{}.{}.{}", port.name, field, measured_axes[i]));
    }
    for (std::size_t k = 0; k < entries; ++k)
      names.push_back(fmt::format("{}.stress.{}", port.name, stress_names[k]));
    if (deforms) names.push_back(fmt::format("{}.von_mises", port.name));
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
  const std::vector<double> v(state.velocity.begin(), state.velocity.end());
  std::vector<double> out, u(state.q.begin(), state.q.end());
  model.to_space(u);
  summarise(u, dim, out);
  summarise(v, dim, out);
  NodalStress stress;
  if (state.deforms) {
    stress = nodal_stress(model, state.q, state.history);
    add_stress(model, state, out);
    add_nodal_stress(dim, stress, out);
  }
  out.insert(out.end(), {energy.kinetic, energy.stored, energy.dissipated, energy.external_work});
  for (int i = 0; i < dim; ++i)
    out.push_back(state.nodal_momentum(Eigen::seqN(i, model.mesh().node_count(), dim)).sum());
  std::vector<double> angular;
  angular_momentum(model.mesh(), u, state.nodal_momentum, angular);
  out.insert(out.end(), angular.begin(), angular.end());
  for (const NamedNodes& port : ports) {
    for (const std::vector<double>* field : {&std::as_const(u), &v}) {
      for (int i = 0; i < dim; ++i) {
        double total = 0.0;
        for (std::int32_t node : port.nodes) total += (*field)[node * dim + i];
        out.push_back(total / static_cast<double>(port.nodes.size()));
      }
    }
    if (state.deforms) add_stress_at(port, dim, stress.nodes, out);
  }
  return out;
}

}  // namespace abut
