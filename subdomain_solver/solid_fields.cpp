#include "subdomain_solver/solid_fields.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "base/index.hpp"
#include "subdomain_solver/fe/vtk_cells.hpp"
#include "subdomain_solver/nodal_stress.hpp"
#include "subdomain_solver/solid_measures.hpp"

namespace abut {

namespace {

/// Sums over the points of the cells, to become means.
struct CellSums {
  std::vector<double> volume;  // (cells)
  std::vector<FieldValues> fields;

  CellSums(std::size_t cells, const std::vector<FieldInfo>& wanted) : volume(cells, 0.0) {
    for (const FieldInfo& field : wanted) fields.emplace_back(cells * index(field.components), 0.0);
  }
  void add(std::size_t cell, double weight, std::size_t field, std::span<const double> value) {
    for (std::size_t k = 0; k < value.size(); ++k)
      fields[field][cell * value.size() + k] += weight * value[k];
  }
  std::vector<FieldValues> means(bool admissible) && {
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    for (FieldValues& values : fields) {
      const std::size_t components = values.size() / std::max<std::size_t>(1, volume.size());
      for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = admissible ? values[k] / volume[k / components] : nothing;
    }
    return std::move(fields);
  }
};

std::vector<FieldInfo> cell_fields(const Material& material) {
  std::vector<FieldInfo> fields{{"stress", FieldPlace::cells, 6}, {"von_mises", FieldPlace::cells}};
  for (const NamedHistory& variable : material.named_history())
    fields.push_back({std::string(variable.name), FieldPlace::cells, 1});
  return fields;
}

std::vector<FieldValues> cell_values(FeModel& model, const SolidFieldState& state) {
  const Material& material = model.material();
  const std::vector<NamedHistory> named = material.named_history();
  std::vector<std::size_t> first;  // number of a block's first cell
  std::size_t cells = 0;
  for (const CellBlock& block : model.mesh().blocks) {
    first.push_back(cells);
    cells += index(block.count());
  }
  CellSums sums(cells, cell_fields(material));
  const bool admissible =
      model.visit(state.q, state.history, [&](const FeModel::PointState& point) {
        const std::size_t cell = first[point.block] + index(point.cell);
        const Matrix3 s = cauchy_stress(material, point.stress, point.deformation);
        const StressEntries entries = entries_of(s);
        const double mises = von_mises(s);
        sums.volume[cell] += point.volume;
        sums.add(cell, point.volume, 0, entries);
        sums.add(cell, point.volume, 1, {&mises, 1});
        for (std::size_t k = 0; k < named.size(); ++k)
          sums.add(cell, point.volume, 2 + k, point.history.subspan(index(named[k].index), 1));
      });
  return std::move(sums).means(admissible);
}

}  // namespace

std::vector<double> in_space(std::span<const double> values, int dim) {
  const std::size_t d = index(dim);
  std::vector<double> out(values.size() / d * 3, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) out[i / d * 3 + i % d] = values[i];
  return out;
}

Grid grid_of(const Mesh& mesh) {
  Grid grid;
  grid.points = in_space(mesh.points, mesh.dim);
  grid.offsets.push_back(0);
  for (const CellBlock& block : mesh.blocks) {
    const VtkCell cell = vtk_cell(*block.element);
    for (std::size_t from = 0; from < block.nodes.size(); from += cell.nodes.size()) {
      for (const int node : cell.nodes)
        grid.connectivity.push_back(block.nodes[from + index(node)]);
      grid.offsets.push_back(static_cast<std::int32_t>(grid.connectivity.size()));
      grid.types.push_back(cell.type);
    }
  }
  return grid;
}

std::vector<FieldInfo> solid_fields(const Material& material, bool deforms) {
  std::vector<FieldInfo> fields{{"displacement", FieldPlace::nodes, 3},
                                {"velocity", FieldPlace::nodes, 3}};
  if (!deforms) return fields;
  const std::vector<FieldInfo> of_cells = cell_fields(material);
  fields.insert(fields.end(), of_cells.begin(), of_cells.end());
  fields.push_back({"nodal_stress", FieldPlace::nodes, 6});
  fields.push_back({"nodal_von_mises", FieldPlace::nodes, 1});
  return fields;
}

std::vector<FieldValues> solid_field_values(FeModel& model, const SolidFieldState& state,
                                            bool deforms) {
  const int dim = model.mesh().dim;
  std::vector<FieldValues> values{in_space(state.displacement, dim), in_space(state.velocity, dim)};
  if (!deforms) return values;
  for (FieldValues& field : cell_values(model, state)) values.push_back(std::move(field));
  FieldValues stress, mises;
  for (const StressEntries& node : nodal_stress(model, state.q, state.history).nodes) {
    stress.insert(stress.end(), node.begin(), node.end());
    mises.push_back(von_mises(stress_of(node)));
  }
  values.push_back(std::move(stress));
  values.push_back(std::move(mises));
  return values;
}

}  // namespace abut
