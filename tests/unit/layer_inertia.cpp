// Goal: how much of its moment of inertia a body keeps while its surface has no mass is known, and
// a body that would keep too little keeps its surface's mass. Oracle: sums over the nodes of a
// lattice, whose inner ones take the mass of cells in equal parts.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "base/one_each.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/fe/layer_inertia.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"

namespace abut::layer_inertia_tests {
namespace {

FeModel lattice(const std::string& element, int cells) {
  return {unit_mesh(element, cells), std::make_unique<LinearElastic>(test_moduli, 1.0), {}};
}

std::vector<int> outside(const FeModel& model) {
  std::vector<int> dofs;
  const int dim = model.mesh().dim;
  for (const std::int32_t node : model.mesh().nodes_of("boundary"))
    for (int i = 0; i < dim; ++i) dofs.push_back(node * dim + i);
  keep_one_each(dofs);
  return dofs;
}

/// Along an axis inner nodes have a cell each, the outermost of them one and a half; with all mass
/// where it is the outer nodes have half of one. Nodes of a lattice have the products of these.
double left_of(int cells) {
  double layered = 0.0, whole = 0.0;
  for (int k = 0; k <= cells; ++k) {
    const double place = k - 0.5 * cells;
    const bool outer = k == 0 || k == cells, next = k == 1 || k == cells - 1;
    whole += (outer ? 0.5 : 1.0) * place * place;
    layered += (outer ? 0.0 : next ? 1.5 : 1.0) * place * place;
  }
  return layered / whole;
}

TEST(LayerInertia, IsThatOfTheNodesInside) {
  for (const char* element : {"quad4", "hex8"}) {
    for (const int cells : {4, 5, 6, 8}) {
      SCOPED_TRACE(element + std::to_string(cells));
      FeModel model = lattice(element, cells);
      const Vector whole = model.lumped_mass();
      model.make_massless(outside(model), {});
      // Round-off of sums over a thousand nodes.
      EXPECT_NEAR(model.inertia_left(), left_of(cells), 1e-12);
      EXPECT_NEAR(inertia_left(model.mesh(), whole, model.lumped_mass()), left_of(cells), 1e-12);
    }
  }
}

/// What counts are turns about all axes: a rod turns about its own by a quarter of its inertia, and
/// across that by nearly all, by the sum of 3, 3 and 12 cells.
TEST(LayerInertia, OfARodIsThatAcrossIt) {
  BoxMesh rod;
  rod.lengths = {3.0, 3.0, 12.0};
  rod.elements = {3, 3, 12};
  FeModel model(generate(rod, "test"), std::make_unique<LinearElastic>(test_moduli, 1.0), {});
  model.make_massless(outside(model), {});
  const auto spread = [](int cells) { return cells * (cells * cells + 2.0) / 12.0 / cells; };
  const double whole = 2.0 * spread(3) + spread(12);
  const double left = 2.0 * left_of(3) * spread(3) + left_of(12) * spread(12);
  EXPECT_NEAR(model.inertia_left(), left / whole, 1e-12);  // sums over some hundred nodes
}

/// What a support holds turns about that, and has no moment of inertia of its own to keep.
TEST(LayerInertia, IsNotAskedForOfWhatIsHeld) {
  FeModel model = lattice("quad4", 3);
  std::vector<int> held;
  for (const std::int32_t node : model.mesh().nodes_of("left"))
    for (int i = 0; i < 2; ++i) held.push_back(node * 2 + i);
  keep_one_each(held);
  EXPECT_NO_THROW(model.make_massless(outside(model), held));
  EXPECT_EQ(model.inertia_left(), 1.0);
}

}  // namespace
}  // namespace abut::layer_inertia_tests
