// What scenes of the later seeds have beside: parts that are tied, spin, tools that turn.

#include "tests/random/kinds.hpp"

#include <algorithm>
#include <cmath>

#include "tests/random/lattice.hpp"

namespace abut {

namespace {

using Kind = RandomBody::Kind;

constexpr const char* to_be_cut = "joined";

std::string cell_element(Draw& draw, int dim) {
  return dim == 2 ? draw.of<std::string>({"quad4", "tri3"})
                  : draw.of<std::string>({"hex8", "hex8", "tet4"});
}

/// A box in the frame of a body: from low to high.
struct BoxOfCells {
  Eigen::Vector3d low, high;
};

/// A part of a whole, and which of its sides are tied: (axis, end) by the name of the port.
struct Piece {
  BoxOfCells box;
  std::map<std::string, std::pair<int, int>> tied;
};

std::string side_name(int axis, int end) {
  return std::string(end == 0 ? "low_" : "high_") + "xyz"[axis];
}

Piece& tie_side(Piece& piece, int axis, int end) {
  piece.tied[side_name(axis, end)] = {axis, end};
  return piece;
}

/// Cuts the last part across an axis; what is before it stays.
void cut(Draw& draw, std::vector<Piece>& pieces, int axis) {
  Piece& first = pieces.back();
  Piece second = first;
  const double share = draw.uniform(0.3, 0.7);
  const double at = first.box.low(axis) + share * (first.box.high(axis) - first.box.low(axis));
  first.box.high(axis) = second.box.low(axis) = at;
  first.tied.erase(side_name(axis, 1));
  second.tied.erase(side_name(axis, 0));
  tie_side(first, axis, 1);
  tie_side(second, axis, 0);
  pieces.push_back(second);
}

/// In a row, or the last one across, so that three meet.
std::vector<Piece> pieces_of(Draw& draw, const BoxOfCells& box, int dim) {
  std::vector<Piece> pieces = {{box, {}}};
  const int axis = draw.whole(0, dim - 1);
  cut(draw, pieces, axis);
  if (draw.chance(0.4)) cut(draw, pieces, draw.chance(0.5) ? axis : (axis + 1) % dim);
  return pieces;
}

Shape shape_of(Draw& draw, const Piece& piece, int dim) {
  const int most = dim == 2 ? 5 : 2;
  const std::array<int, 3> counts = {draw.whole(1, most), draw.whole(1, most), draw.whole(1, most)};
  const Eigen::Vector3d size = piece.box.high - piece.box.low;
  Shape shape = lattice(
      draw, cell_element(draw, dim), counts, false,
      [&](const Eigen::Vector3d& s) { return (piece.box.low + size.cwiseProduct(s)).eval(); });
  shape.kind = "part";
  shape.dim = dim;
  const double close = 1e-9 * size.head(dim).minCoeff();
  for (const auto& [name, side] : piece.tied) {
    const int axis = side.first, end = side.second;
    const double at = (end == 0 ? piece.box.low : piece.box.high)(axis);
    for (const std::vector<int>& facet : shape.outside())
      if (std::ranges::all_of(facet,
                              [&](int n) { return std::abs(shape.points[n](axis) - at) < close; }))
        shape.cuts[name].push_back(facet);
  }
  const bool simplices = shape.element == "tri3" || shape.element == "tet4";
  if (simplices && shape.cells.size() < 20 && draw.chance(0.3)) raise_order(shape);
  return shape;
}

void choose_law(Draw& draw, RandomBody& part) {
  if (draw.chance(0.5)) return;
  part.modulus *= draw.decades(0.1, 10.0);
  part.density *= draw.decades(0.3, 3.0);
  part.law = draw.of<std::string>({"linear_elastic", "saint_venant_kirchhoff", "neo_hookean"});
}

/// Whether two parts have a side in common, as far as that reaches.
bool meet(const Piece& one, const Piece& other, int axis, int dim) {
  if (one.box.high(axis) != other.box.low(axis)) return false;
  for (int i = 0; i < dim; ++i) {
    const double both =
        std::min(one.box.high(i), other.box.high(i)) - std::max(one.box.low(i), other.box.low(i));
    if (i != axis && both <= 0.0) return false;
  }
  return true;
}

/// The parts of one body in its place, and their ties. Numbers of bodies begin at `first`.
std::vector<RandomBody> parts_of(Draw& draw, const RandomBody& body, int dim, double window,
                                 bool closed, int first, std::vector<RandomTie>& ties) {
  BoxOfCells box{body.shape.points[0], body.shape.points[0]};
  for (const Eigen::Vector3d& x : body.shape.points) {
    box.low = box.low.cwiseMin(x);
    box.high = box.high.cwiseMax(x);
  }
  const std::vector<Piece> pieces = pieces_of(draw, box, dim);
  const int rigid = draw.chance(0.2) ? draw.whole(0, static_cast<int>(pieces.size()) - 1) : -1;
  std::vector<RandomBody> parts;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    RandomBody part = body;
    part.name = body.name + "abcd"[k];
    part.whole = first;
    part.port = "skin";
    part.shape = shape_of(draw, pieces[k], dim);
    part.shape.closed = closed;
    const bool low = pieces[k].box.low(1) == box.low(1);
    if (part.kind == Kind::held && !low) part.kind = Kind::deformable;
    choose_law(draw, part);
    if (draw.chance(0.4))
      part.scheme = draw.of<std::string>({"central_difference", "newmark", "hht_alpha"});
    if (draw.chance(0.3)) part.step = window / draw.whole(1, 10);
    if (static_cast<int>(k) == rigid && part.kind == Kind::deformable) {
      part.kind = Kind::rigid;
      part.scheme = "rigid_motion";
    }
    parts.push_back(part);
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t j = 0; j < pieces.size(); ++j)
      for (int axis = 0; axis < dim; ++axis)
        if (i != j && meet(pieces[i], pieces[j], axis, dim))
          ties.push_back({{first + static_cast<int>(i), first + static_cast<int>(j)},
                          {side_name(axis, 1), side_name(axis, 0)}});
  return parts;
}

}  // namespace

void choose_what_is_cut(Draw& draw, RandomScene& scene) {
  for (RandomBody& body : scene.bodies) {
    if (body.kind == Kind::tool || !draw.chance(0.45)) continue;
    if (body.kind == Kind::rigid) {
      body.kind = Kind::deformable;
      body.scheme = "newmark";
    }
    const int most = scene.dim == 2 ? 6 : 3;
    const double size = body.shape.size();
    Eigen::Vector3d lengths(size, size * draw.decades(0.3, 1.0), size * draw.decades(0.3, 1.0));
    if (body.shape.kind == "floor") lengths = {4.0, draw.uniform(0.5, 1.0), 4.0};
    if (scene.dim == 2) lengths(2) = 0.0;
    const std::string floor = body.shape.kind;
    body.shape = lattice(
        draw, scene.dim == 2 ? "quad4" : "hex8",
        {draw.whole(2, most), draw.whole(2, most), draw.whole(2, most)}, false,
        [&](const Eigen::Vector3d& s) {
          return lengths.cwiseProduct(s - Eigen::Vector3d(0.5, 0.5, scene.dim == 3 ? 0.5 : 0.0))
              .eval();
        });
    body.shape.kind = floor == "floor" ? floor : to_be_cut;
    body.whole = 0;
    body.port = "skin";
  }
}

void choose_turns(Draw& draw, RandomScene& scene) {
  for (RandomBody& body : scene.bodies) {
    const bool floor = body.shape.kind == "floor";
    if (body.kind == Kind::held || !draw.chance(0.35)) continue;
    const double rate = scene.speed / body.shape.size() * draw.decades(0.1, 2.0);
    Eigen::Vector3d axis(0.0, 0.0, draw.chance(0.5) ? 1.0 : -1.0);
    if (scene.dim == 3 && !floor)
      axis =
          Eigen::Vector3d(draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0), draw.uniform(-1.0, 1.0))
              .normalized();
    if (floor && body.kind == Kind::tool) {
      if (scene.dim == 3) body.spin = rate * Eigen::Vector3d::UnitY();
      body.velocity = Eigen::Vector3d(draw.uniform(-0.3, 0.3), draw.uniform(0.0, 0.3), 0.0);
      body.velocity *= scene.speed;
    } else if (!floor) {
      body.spin = rate * axis;
    }
  }
}

void cut_wholes(Draw& draw, RandomScene& scene) {
  std::vector<RandomBody> all;
  for (const RandomBody& body : scene.bodies) {
    if (body.whole < 0) {
      all.push_back(body);
      continue;
    }
    // Where everything may touch everything, no facet may be of two ports. What encloses nothing
    // takes what lies beyond a thin neighbour for what is behind it.
    const std::vector<RandomBody> parts =
        parts_of(draw, body, scene.dim, scene.window, !scene.everything,
                 static_cast<int>(all.size()), scene.ties);
    all.insert(all.end(), parts.begin(), parts.end());
  }
  scene.bodies = all;
}

}  // namespace abut
