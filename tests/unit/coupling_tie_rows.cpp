// Goal: rows of joined faces of second order are as exact as their shape functions, wherever nodes
// lie. Oracles: the elements' shape functions, linear fields, the forces of a uniform traction.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "base/index.hpp"
#include "contract/whole_facets.hpp"
#include "coordinator/coupling/tie_rows.hpp"
#include "subdomain_solver/fe/element.hpp"
#include "surface/whole_facet.hpp"
#include "tests/support/tolerance.hpp"

namespace abut::coupling_tie_rows_tests {
namespace {

using Eigen::Vector2d;

constexpr double exact = 1.0e-12;  // round-off of sums of some hundred products

/// Points by place in a face, as elements of one kind have them: in the plane of x, turned over
/// where it is the partner's.
struct Face {
  PortGeometry port;
  bool flipped = false;

  /// Nodes of an element's facet, corners first.
  void add(std::vector<std::int32_t> nodes) {
    const std::size_t count = nodes.size();
    const std::size_t corners = port.dim == 2 ? 2 : count % 3 == 0 ? 3 : 4;
    if (flipped) {
      std::reverse(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(corners));
      // The last edge stays the last one where corners turn around.
      if (port.dim == 3 && count > corners)
        std::reverse(nodes.begin() + static_cast<std::ptrdiff_t>(corners), nodes.end() - 1);
    }
    const auto& parts = straight_parts(port.dim, count);
    for (const std::vector<int>& part : parts) {
      for (const int local : part) port.facets.push_back(nodes[local]);
      port.offsets.push_back(static_cast<std::int32_t>(port.facets.size()));
    }
    port.parts.push_back(static_cast<std::int32_t>(parts.size()));
  }
};

using Map = std::function<Vector2d(const Vector2d&)>;  // of the unit square, or of its first side

/// n segments, or n x n squares with 3, 4, 6 or 8 nodes each or half, at height 0.
PortGeometry face(int dim, int n, int nodes, bool flipped, const Map& map) {
  Face face;
  face.flipped = flipped;
  PortGeometry& port = face.port;
  port.dim = dim;
  port.offsets = {0};
  port.spacing = 1.0 / n;
  port.transit = 1.0;  // it deforms
  const int wide = 2 * n + 1;
  for (int j = 0; j < (dim == 2 ? 1 : wide); ++j) {
    for (int i = 0; i < wide; ++i) {
      const Vector2d x = map(Vector2d(i, j) / (2.0 * n));
      port.points.push_back(x.x());
      if (dim == 3) port.points.push_back(x.y());
      port.points.push_back(0.0);
    }
  }
  port.normals.assign(port.points.size(), 0.0);
  const auto at = [wide](int i, int j) { return static_cast<std::int32_t>(j * wide + i); };
  for (int j = 0; j < 2 * n; j += 2) {
    for (int i = 0; i < 2 * n; i += 2) {
      const std::int32_t a = at(i, j), b = at(i + 2, j), c = at(i + 2, j + 2), d = at(i, j + 2);
      const std::int32_t ab = at(i + 1, j), bc = at(i + 2, j + 1), cd = at(i + 1, j + 2);
      const std::int32_t da = at(i, j + 1), ac = at(i + 1, j + 1);
      if (dim == 2 && j == 0) face.add(nodes == 2 ? std::vector{a, b} : std::vector{a, b, ab});
      if (dim == 3 && nodes == 4) face.add({a, b, c, d});
      if (dim == 3 && nodes == 8) face.add({a, b, c, d, ab, bc, cd, da});
      if (dim == 3 && nodes == 3) face.add({a, b, c}), face.add({a, c, d});
      if (dim == 3 && nodes == 6) face.add({a, b, c, ab, bc, ac}), face.add({a, c, d, ac, cd, da});
    }
  }
  return port;
}

const Map regular = [](const Vector2d& x) { return x; };
/// Nodes between corners off the middle, edges straight; cells are parallel where x alone moves.
const Map uneven = [](const Vector2d& x) {
  return Vector2d(x.x() + 0.02 * std::sin(14.0 * x.x()), x.y());
};
const Map other_uneven = [](const Vector2d& x) {
  return Vector2d(x.x(), x.y() - 0.02 * std::sin(14.0 * x.y()));
};

double row_of(const SparseRows& rows, int row, const std::function<double(std::int32_t)>& value) {
  double sum = 0.0;
  for (std::int32_t e = rows.offsets[row]; e < rows.offsets[index(row) + 1]; ++e)
    sum += rows.values[e] * value(rows.columns[e]);
  return sum;
}

struct Kinds {
  int dim, one, other;
};

std::vector<Kinds> kinds() {
  std::vector<Kinds> out = {{2, 3, 3}, {2, 2, 3}, {2, 3, 2}};
  for (const int one : {3, 4, 6, 8})
    for (const int other : {3, 4, 6, 8})
      if (one > 4 || other > 4) out.push_back({3, one, other});
  return out;
}

TEST(WholeFacets, HaveTheShapeFunctionsOfTheirElements) {
  for (const auto& [name, dim] :
       {std::pair("bar2", 2), {"bar3", 2}, {"tri3", 3}, {"tri6", 3}, {"quad4", 3}, {"quad8", 3}}) {
    const Element& element = element_named(name);
    const FacetKind kind(dim, index(element.nodes));
    for (const Vector2d& at : {Vector2d(0.3, 0.2), Vector2d(0.1, 0.7), Vector2d(-0.4, 0.9)}) {
      Shape8 n;
      Slopes8 slopes;
      kind.evaluate(at, n, slopes);
      std::vector<double> values(index(element.nodes)), derivatives(values.size() * index(dim - 1));
      element.evaluate(std::span(at.data(), index(dim - 1)), values, derivatives);
      for (int a = 0; a < element.nodes; ++a) {
        EXPECT_NEAR(n[a], values[a], roundoff(4.0, 1.0)) << name;
        for (int d = 0; d < dim - 1; ++d)
          EXPECT_NEAR(slopes(a, d), derivatives[a * (dim - 1) + d], roundoff(4.0, 1.0)) << name;
      }
    }
  }
}

TEST(WholeFacets, AreFoundAgainInTheirStraightParts) {
  for (const Kinds& k : kinds()) {
    const PortGeometry port = face(k.dim, 2, k.one, false, regular);
    EXPECT_EQ(unsound_parts(port), "");
    const WholeFacets whole = whole_facets(port);
    EXPECT_EQ(whole.of.size() + 1, port.offsets.size());
    for (std::size_t f = 1; f < whole.offsets.size(); ++f)
      EXPECT_EQ(whole.offsets[f] - whole.offsets[f - 1], k.one);
    // Nodes between corners are in the middle of theirs.
    const int corners = k.dim == 2 ? 2 : k.one % 3 == 0 ? 3 : 4;
    for (int f = 0; f < port.dim; ++f) {
      for (int a = corners; a < k.one; ++a) {
        const auto x = [&](int node) {
          return port.points[whole.nodes[index(f * k.one + node)] * k.dim];
        };
        const int i = a - corners;
        EXPECT_NEAR(x(a), 0.5 * (x(i) + x((i + 1) % corners)), roundoff(4.0, 1.0));
      }
    }
  }
}

TEST(WholeFacets, PartsThatDoNotFitAreRefused) {
  PortGeometry port = face(3, 1, 8, false, regular);
  const auto wrong = [&](std::vector<std::int32_t> parts) {
    port.parts = std::move(parts);
    return unsound_parts(port);
  };
  EXPECT_EQ(wrong({5}), "");
  EXPECT_EQ(wrong({1, 1, 1, 1, 1}), "");
  EXPECT_EQ(wrong({3, 2}), "names a facet of 3 parts");
  EXPECT_EQ(wrong({4, 1}), "does not fit the nodes of facet 0");
  EXPECT_EQ(wrong({1, 4}), "does not fit the size of facet 1");
  EXPECT_EQ(wrong({5, 1}), "names more than there are");
  EXPECT_EQ(wrong({1, 1}), "names 2 of 5");
  port.facets[0] = port.facets[1];
  EXPECT_EQ(wrong({5}), "");  // a corner stands in one part alone
  port.facets[1] = port.facets[2];
  EXPECT_EQ(wrong({5}), "does not fit the nodes of facet 0");
}

/// Rows sum up to one on either side and see no linear field jump, wherever the nodes of flat faces
/// lie: also where one face covers the other in part, and with rows of either side.
TEST(TieRows, OfSecondOrderSeeNoLinearFieldJump) {
  for (const Kinds& k : kinds()) {
    for (const double shift : {0.0, 0.31}) {
      for (const int side : {0, 1}) {
        SCOPED_TRACE(fmt::format("{}d {} {} {} {}", k.dim, k.one, k.other, shift, side));
        const Map moved = [shift](const Vector2d& x) {
          return Vector2d(other_uneven(x) + shift * Vector2d(1.0, 0.7));
        };
        const PortGeometry one = face(k.dim, 2, k.one, false, uneven);
        const PortGeometry other = face(k.dim, 3, k.other, true, moved);
        const TieRows rows = make_tie_rows(one, other, side);
        ASSERT_GT(rows.count(), 0);
        EXPECT_LT(rows.apart, exact);
        for (int r = 0; r < rows.count(); ++r) {
          for (const std::size_t s : {0u, 1u})
            EXPECT_NEAR(row_of(rows.of[s], r, [](std::int32_t) { return 1.0; }), 1.0, exact);
          for (int d = 0; d < k.dim; ++d) {
            const auto along = [&](const PortGeometry& port) {
              return [&port, d](std::int32_t node) { return port.points[node * port.dim + d]; };
            };
            EXPECT_NEAR(row_of(rows.of[0], r, along(one)), row_of(rows.of[1], r, along(other)),
                        exact);
          }
        }
      }
    }
  }
}

/// Whatever the forces of rows, converged or not: those on one side and on the other have the same
/// resultant and the same moment, of flat faces of any two orders.
TEST(TieRows, AnyForcesBalance) {
  std::vector<Kinds> all = kinds();
  all.push_back({2, 2, 2});
  for (const int one : {3, 4})
    for (const int other : {3, 4}) all.push_back({3, one, other});
  for (const Kinds& k : all) {
    for (const int side : {0, 1}) {
      SCOPED_TRACE(fmt::format("{}d {} {} {}", k.dim, k.one, k.other, side));
      const PortGeometry ports[] = {face(k.dim, 3, k.one, false, uneven),
                                    face(k.dim, 5, k.other, true, other_uneven)};
      const TieRows rows = make_tie_rows(ports[0], ports[1], side);
      ASSERT_GT(rows.count(), 0);
      std::vector<double> forces(index(rows.width()));
      for (std::size_t i = 0; i < forces.size(); ++i)
        forces[i] = std::sin(1.0 + 2.3 * static_cast<double>(i));
      Eigen::Vector3d resultant[2], moment[2];
      for (const std::size_t s : {0u, 1u}) {
        std::vector<double> nodal(ports[s].points.size(), 0.0);
        rows.press(static_cast<int>(s), 1.0, forces, nodal);
        resultant[s].setZero();
        moment[s].setZero();
        for (int node = 0; node < ports[s].count(); ++node) {
          Eigen::Vector3d x = Eigen::Vector3d::Zero(), f = x;
          for (int d = 0; d < k.dim; ++d) {
            x(d) = ports[s].points[node * k.dim + d];
            f(d) = nodal[node * k.dim + d];
          }
          resultant[s] += f;
          moment[s] += x.cross(f);
        }
      }
      // Sums of some hundred forces of the size of one, whose errors add up as their roots do.
      const double rounding = 1.0e-13 * std::sqrt(static_cast<double>(forces.size()));
      EXPECT_LE((resultant[0] - resultant[1]).norm(), rounding);
      EXPECT_LE((moment[0] - moment[1]).norm(), rounding);
    }
  }
}

/// Nodal forces of a uniform traction are those of the elements: of a facet of unit size 1/6, 4/6
/// on a line, none and 1/3 on six nodes, -1/12 and 1/3 on eight.
TEST(TieRows, OfSecondOrderPassAUniformTraction) {
  for (const Kinds& k : kinds()) {
    SCOPED_TRACE(fmt::format("{}d {} {}", k.dim, k.one, k.other));
    const PortGeometry one = face(k.dim, 2, k.one, false, regular);
    const PortGeometry other = face(k.dim, 3, k.other, true, regular);
    const TieRows rows = make_tie_rows(one, other, 0);
    for (const std::size_t s : {0u, 1u}) {
      const PortGeometry& port = s == 0 ? one : other;
      const int nodes = s == 0 ? k.one : k.other, n = s == 0 ? 2 : 3;
      const int corners = k.dim == 2 ? 2 : nodes % 3 == 0 ? 3 : 4;
      const double size = (corners == 3 ? 0.5 : 1.0) / std::pow(n, k.dim - 1);
      const double middle = nodes == corners ? 0.0 : size * (k.dim == 2 ? 2.0 : 1.0) / 3.0;
      const double corner = (size - middle * (nodes - corners)) / corners;
      std::vector<double> force(index(port.count()), 0.0), told(force.size(), 0.0);
      add_transposed(rows.of[s], 1, 1.0, rows.area, told);
      const WholeFacets whole = whole_facets(port);
      for (std::size_t f = 0; f + 1 < whole.offsets.size(); ++f)
        for (int a = 0; a < nodes; ++a)
          force[whole.nodes[index(whole.offsets[f] + a)]] += a < corners ? corner : middle;
      for (std::size_t node = 0; node < force.size(); ++node)
        EXPECT_NEAR(told[node], force[node], exact) << s << " " << node;
    }
  }
}

/// Where nodes meet, so do second-order facets, or they do not: of first order on the one side, or
/// with the corners of the one on the middles of the other.
TEST(TieRows, NodesAreTwinsWhereFacetsAreTheSame) {
  const PortGeometry one = face(2, 3, 3, false, regular), same = face(2, 3, 3, true, regular);
  const TieRows twins = make_tie_rows(one, same, 0);
  EXPECT_EQ(twins.count(), 7);
  for (int r = 0; r < twins.count(); ++r)
    EXPECT_EQ(twins.of[0].offsets[index(r) + 1] - twins.of[0].offsets[r], 1);
  const Map shifted = [](const Vector2d& x) {
    return Vector2d(x.x() * 4.0 / 3.0 - 1.0 / 6.0, 0.0);
  };
  EXPECT_EQ(make_tie_rows(one, face(2, 4, 3, true, shifted), 0).count(), 4);  // corners
  PortGeometry straight = same;
  straight.parts.clear();
  EXPECT_EQ(make_tie_rows(one, straight, 0).count(), 4);
}

/// A rigid partner is met by every node, not by corners alone.
TEST(TieRows, OfRigidPartnersHoldEveryNode) {
  const PortGeometry own = face(2, 3, 3, false, regular);
  PortGeometry rigid = face(2, 1, 2, true, regular);
  EXPECT_EQ(make_tie_rows(own, rigid, 0).count(), 4);
  rigid.transit = 0.0;
  EXPECT_EQ(make_tie_rows(own, rigid, 0).count(), 7);
}

}  // namespace
}  // namespace abut::coupling_tie_rows_tests
