#pragma once

#include <vector>

#include "subdomain_solver/fe/cell_kernel.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "subdomain_solver/materials/moduli.hpp"
#include "subdomain_solver/materials/plane.hpp"

namespace abut {

struct FeOptions {
  Plane plane = Plane::strain;  // of meshes in two dimensions
  Formulation formulation = Formulation::full;
  double thickness = 1.0;   // [m] of plane cells; axisymmetric ones span the full circle
  double hourglass = 0.05;  // coefficient of the hourglass stiffness of one_point
  bool batched = false;     // forces alone by batches of cells (explicit steps) where they can be
  int threads = 1;          // of batched cells
  double area = 1.0;        // [m^2] cross section of bars

  /// What a cell of this dimension has beside its own extent: area [m^2], thickness [m], 2 pi times
  /// the radius [m], or 1.
  double depth(int dim, double radius) const;
};

/// Reference geometry of consecutive cells of one element, as CellGeometry shows it cell by cell.
struct CellMeasures {
  int nodes = 0, points = 0, dim = 0;
  std::vector<double> volume;      // [m^3] (cells, points)
  std::vector<double> gradient;    // [1/m] (cells, points, nodes, dim)
  std::vector<double> hoop;        // [1/m] (cells, points, nodes) of axisymmetric cells
  std::vector<double> hourglass;   // [N/m] (cells, 1 or dim, nodes, nodes) of one_point
  std::vector<double> dilatation;  // (cells, fields, points) of mean_dilatation
  int fields = 0;                  // of dilatation, per cell

  CellGeometry of(int cell) const;
};

/// Adds the measures of one cell at the points of a table; one_point makes one of them.
/// The moduli scale the hourglass stiffness.
void measure_cell(const Mesh& mesh, const CellBlock& cells, int cell, const Tabulation& table,
                  const FeOptions& options, const Moduli& moduli, CellMeasures& out);

/// Points at which a cell of the table has its law.
int law_points(const Element& element, const Tabulation& table, Formulation formulation);

}  // namespace abut
