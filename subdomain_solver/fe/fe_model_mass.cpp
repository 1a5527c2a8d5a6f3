// The mass of finite elements: of cells, lumped and consistent.

#include "base/index.hpp"
#include "subdomain_solver/fe/fe_model.hpp"

namespace abut {

/// Integral of N_a N_b of one cell, times density.
Eigen::MatrixXd FeModel::nodal_mass(std::size_t block, int cell) const {
  const Tabulation& t = blocks_[block].mass_table;
  FeOptions every_point = options_;
  every_point.formulation = Formulation::full;
  CellMeasures measures;
  measure_cell(mesh_, mesh_.blocks[block], cell, t, every_point, material_->moduli(), measures);
  Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(t.nodes, t.nodes);
  for (int p = 0; p < t.points; ++p) {
    const Eigen::Map<const Vector> n(t.n.data() + index(p * t.nodes), t.nodes);
    nodal += material_->density() * measures.volume[p] * n * n.transpose();
  }
  return nodal;
}

/// The diagonal scaled to the cell's mass (Hinton, Rock, Zienkiewicz 1976), which equals the row
/// sum for linear elements on parallelepipeds and is positive for all.
Vector FeModel::cell_mass(int block, int cell) const {
  const Eigen::MatrixXd nodal = nodal_mass(index(block), cell);
  return nodal.sum() / nodal.trace() * nodal.diagonal();
}

void FeModel::lump_mass() {
  const int dim = mesh_.dim;
  lumped_.setZero(dofs());
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    for (int c = 0; c < cells.count(); ++c) {
      const Eigen::MatrixXd whole = cell_mass(static_cast<int>(k), c).asDiagonal();
      for (int i = 0; i < dim; ++i) {
        Eigen::MatrixXd nodal = whole;
        if (!bare_.empty()) hand_over(nodes_of(cells, c), i, nodal);
        int a = 0;
        for (const std::int32_t node : nodes_of(cells, c)) {
          lumped_(node * dim + i) += nodal(a, a);
          ++a;
        }
      }
    }
  }
  inherit(lumped_);
}

const SparseMatrix& FeModel::mass() const {
  SparseMatrix& mass = assembly().mass;
  if (mass.size() == 0) assemble_mass(mass, true);
  return mass;
}

SparseMatrix FeModel::whole_consistent_mass() const {
  SparseMatrix mass;
  assemble_mass(mass, false);
  return mass;
}

void FeModel::assemble_mass(SparseMatrix& out, bool layered) const {
  const int dim = mesh_.dim;
  out = assembly().pattern;
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const CellBlock& cells = mesh_.blocks[k];
    const Tabulation& t = blocks_[k].mass_table;
    for (int c = 0; c < cells.count(); ++c) {
      const Eigen::MatrixXd whole = nodal_mass(k, c);
      Eigen::MatrixXd local = Eigen::MatrixXd::Zero(t.nodes * dim, t.nodes * dim);
      for (int i = 0; i < dim; ++i) {
        Eigen::MatrixXd nodal = whole;
        if (layered && !bare_.empty()) hand_over(nodes_of(cells, c), i, nodal);
        for (int a = 0; a < t.nodes; ++a)
          for (int b = 0; b < t.nodes; ++b) local(a * dim + i, b * dim + i) = nodal(a, b);
      }
      turn(nodes_of(cells, c), nullptr, &local);
      add_matrix(k, c, assembly(), local, out);
    }
  }
  if (layered) inherit(out);
  out.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
  out.data().squeeze();  // two of three entries are gone, their memory not yet
}

}  // namespace abut
