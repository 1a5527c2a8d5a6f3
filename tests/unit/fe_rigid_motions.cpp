// Goal: every piece of a mesh that shares no node with the others must be held. Oracle: the numbers
// of rigid motions, counted by hand.
#include "subdomain_solver/fe/rigid_motions.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/index.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/solids.hpp"

namespace abut::fe_rigid_motions_tests {
namespace {

/// Unit cells beside each other, with gaps.
Mesh pieces(const std::string& element, int count) {
  const Mesh one = unit_mesh(element, 1);
  Mesh all = one;
  for (int k = 1; k < count; ++k) {
    const std::int32_t first = all.node_count();
    for (std::size_t i = 0; i < one.points.size(); ++i) {
      const bool along = i % index(one.dim) == 0;
      all.points.push_back(one.points[i] + (along ? 2.0 * k : 0.0));
    }
    for (std::int32_t node : one.blocks[0].nodes) all.blocks[0].nodes.push_back(first + node);
  }
  return all;
}

/// All coordinates of some nodes.
std::vector<int> held(int dim, std::int32_t first, std::int32_t last) {
  std::vector<int> out;
  for (int i = first * dim; i < last * dim; ++i) out.push_back(i);
  return out;
}

FeModel model_of(Mesh mesh) {
  return FeModel(std::move(mesh), std::make_unique<LinearElastic>(test_moduli, 1.0), {});
}

TEST(ConnectedPieces, AreTheNodesThatCellsJoin) {
  for (const std::string& element : fe_elements()) {
    const std::int32_t each = unit_mesh(element, 1).node_count();
    const std::vector<std::vector<std::int32_t>> found = connected_pieces(pieces(element, 3));
    ASSERT_EQ(found.size(), 3u) << element;
    for (std::int32_t k = 0; k < 3; ++k) {
      const std::vector<std::int32_t>& nodes = found[k];
      EXPECT_EQ(static_cast<std::int32_t>(nodes.size()), each) << element;
      EXPECT_EQ(nodes.front(), k * each) << element;
      EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end())) << element;
    }
  }
}

TEST(LoosePieces, AreFoundWhicheverOfThemIsHeld) {
  for (const std::string& element : fe_elements()) {
    const FeModel model = model_of(pieces(element, 2));
    const int dim = model.mesh().dim, rigid = dim == 1 ? 1 : dim == 2 ? 3 : 6;
    const std::int32_t each = model.mesh().node_count() / 2;
    const std::optional<LoosePiece> none = find_loose_piece(model, {});
    ASSERT_TRUE(none) << element;
    EXPECT_EQ(none->motions, rigid) << element;
    for (const std::int32_t other : {1, 0}) {  // the piece that is not held
      const std::optional<LoosePiece> loose =
          find_loose_piece(model, held(dim, (1 - other) * each, (2 - other) * each));
      ASSERT_TRUE(loose) << element;
      EXPECT_EQ(loose->piece, other) << element;
      EXPECT_EQ(loose->pieces, 2) << element;
      EXPECT_EQ(loose->motions, rigid) << element;
    }
    EXPECT_FALSE(find_loose_piece(model, held(dim, 0, 2 * each))) << element;
    // One node of the second alone: it can turn about it.
    std::vector<int> pinned = held(dim, 0, each + 1);
    const std::optional<LoosePiece> turns = find_loose_piece(model, pinned);
    EXPECT_EQ(turns.has_value(), dim > 1) << element;
    if (turns) {
      EXPECT_EQ(turns->motions, dim == 2 ? 1 : 3) << element;
    }
  }
}

}  // namespace
}  // namespace abut::fe_rigid_motions_tests
