#include "coordinator/coupling/tie_contradiction.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "coordinator/coupling/exchange_parts.hpp"

namespace abut {

namespace {

/// Of the largest: interfaces that miss by less have no part in it.
constexpr double least_part = 1.0e-3;

struct Missed {
  const TieLayout::Member* member = nullptr;
  double distance = 0.0;  // [m] the largest of a row at a step's end
  int row = 0;
};

Missed most_missed(const TieLayout::Member& member, const Eigen::VectorXd& rest) {
  const int dim = member.tie->rows().dim;
  Missed most{&member};
  for (Eigen::Index i = 0; i < rest.size(); i += dim) {
    const double distance = rest.segment(i, dim).norm();
    if (distance <= most.distance) continue;
    most.distance = distance;
    most.row = static_cast<int>(i % member.width) / dim;
  }
  return most;
}

/// [m] (dim) the mean of a row's nodes.
std::vector<double> place_of(const Missed& missed, const Bodies& bodies) {
  const TieRows& rows = missed.member->tie->rows();
  std::vector<double> all(index(rows.width()));
  apply(rows.of[0], rows.dim, bodies.port(missed.member->joint->sides[0]).geometry.points, all);
  const auto at = all.begin() + missed.row * rows.dim;
  return {at, at + rows.dim};
}

/// Of rows that no force answers: how far a side's motion is from the straight line between its two
/// neighbours among them, at a row and at a time at most [m]. A parabola that rises so between rows
/// is missed by a third of that at most by means over either mesh  [M.125].
class Bend {
 public:
  Bend(const TieLayout::Member& member, const std::vector<int>& rows, const Bodies& bodies)
      : member_(member), dim_(member.tie->rows().dim), rows_(rows), bodies_(bodies) {
    place_.resize(index(member.tie->rows().width()));
    apply(member.tie->rows().of[0], dim_, bodies.port(member.joint->sides[0]).geometry.points,
          place_);
  }

  double most() const {
    double most = 0.0;
    for (const int row : rows_) {
      const std::optional<std::array<int, 2>> beside = neighbours(row);
      if (!beside) continue;
      for (const std::size_t s : {0u, 1u}) {
        const Waveform& trace = trace_of(bodies_, member_.joint->sides[s]);
        for (std::size_t i = 0; i < trace.size(); ++i)
          most = std::max(
              most, rise(s, std::span(trace.u).subspan(i * index(trace.width), index(trace.width)),
                         row, *beside));
      }
    }
    return most;
  }

 private:
  Eigen::Map<const Eigen::VectorXd> at(const std::vector<double>& values, int row) const {
    return {values.data() + index(row) * index(dim_), dim_};
  }
  double distance(int row, int other) const { return (at(place_, other) - at(place_, row)).norm(); }

  /// The nearest row, and the nearest one on the other side.
  std::optional<std::array<int, 2>> neighbours(int row) const {
    const auto nearest = [&](const auto& counts) {
      int best = -1;
      for (const int other : rows_)
        if (other != row && counts(other) &&
            (best < 0 || distance(row, other) < distance(row, best)))
          best = other;
      return best;
    };
    const int one = nearest([](int) { return true; });
    if (one < 0) return std::nullopt;
    const Eigen::VectorXd way = at(place_, one) - at(place_, row);
    constexpr double against = -0.7;  // cosine
    const int two = nearest([&](int other) {
      return way.dot(at(place_, other) - at(place_, row)) <
             against * way.norm() * distance(row, other);
    });
    return two < 0 ? std::nullopt : std::optional(std::array{one, two});
  }

  double rise(std::size_t side, std::span<const double> u, int row,
              const std::array<int, 2>& beside) const {
    std::vector<double> seen(place_.size());
    apply(member_.tie->rows().of[side], dim_, u, seen);
    const double a = distance(row, beside[0]), b = distance(row, beside[1]);
    return (at(seen, row) - (b * at(seen, beside[0]) + a * at(seen, beside[1])) / (a + b)).norm();
  }

  const TieLayout::Member& member_;
  int dim_;
  const std::vector<int>& rows_;
  const Bodies& bodies_;
  std::vector<double> place_;  // [m] (rows, dim)
};

/// Whether what is left in a member is no more than what its meshes leave of motions.
bool is_of_meshes(const TieLayout::Member& member, const Eigen::VectorXd& left, const Missed& most,
                  const Bodies& bodies) {
  const int dim = member.tie->rows().dim;
  std::vector<int> rows;
  for (int r = 0; r < member.tie->rows().count(); ++r) {
    bool open = false;
    for (Eigen::Index i = 0; i < left.size(); i += member.width)
      open =
          open || left.segment(i + Eigen::Index{r} * dim, dim).norm() > least_part * most.distance;
    if (open) rows.push_back(r);
  }
  constexpr double share = 0.5;  // a third, and what steps of unlike length add
  return most.distance <= share * Bend(member, rows, bodies).most();
}

/// Whether it may be what motions of unlike steps leave between their instants, which is little of
/// what they go: where three bodies meet, no force takes it away.
bool is_of_steps(const TieLayout::Member& member, double seen, double tolerance,
                 const Bodies& bodies) {
  constexpr double most = 100.0;  // tolerances
  const std::array<Side, 2>& sides = member.joint->sides;
  return bodies.describe(sides[0].body).step != bodies.describe(sides[1].body).step &&
         seen <= most * tolerance;
}

/// Whether it is what nodes leave of their motions where they meet up to the digits of a mesh file:
/// rows of points that supports hold reach a little of what is free beside them.
bool is_of_places(const TieLayout::Member& member, const Missed& most, const Bodies& bodies) {
  constexpr double share = 1.0e-3;  // of what the sides have moved
  double moved = 0.0;               // [m]
  for (const Side& side : member.joint->sides)
    moved = std::max(moved, largest(trace_of(bodies, side).u));
  return most.distance <= share * moved;
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

std::string words_of(std::vector<Missed>& all, double time, const Bodies& bodies) {
  std::ranges::stable_sort(all, std::ranges::greater{}, &Missed::distance);
  double distance = 0.0;
  std::vector<std::string> ties, names;
  for (const Missed& missed : all) {
    if (missed.distance < least_part * all.front().distance) break;
    distance += missed.distance;  // each has its share of it
    ties.push_back(missed.member->joint->name);
    for (const Side& side : missed.member->joint->sides)
      add_once(bodies.describe(side.body).name, names);
  }
  return fmt::format(
      "interfaces.{} would have to be {:g} m apart at ({:g}) and {:g} s: bodies {} are given "
      "motions there that differ, and no force between them changes these. Let constraints and "
      "ways of tools agree where bodies are tied, or leave one of them free there",
      fmt::join(ties, ", interfaces."), distance, fmt::join(place_of(all.front(), bodies), ", "),
      time, fmt::join(names, ", "));
}

}  // namespace

Unanswered judge_unanswered(const TieLayout& layout, const Eigen::VectorXd& jump,
                            const Eigen::VectorXd& rest, double tolerance, double time,
                            const Bodies& bodies) {
  std::vector<Missed> all;
  bool wrong = false, meshes = true;
  for (const TieLayout::Member& member : layout.members) {
    if (member.carried >= 0) continue;
    Eigen::VectorXd left(layout.values_of(member)), answered(left.size());
    layout.gather(member, rest, left);
    layout.gather(member, jump - rest, answered);
    if (member.tie->seen(answered.lpNorm<Eigen::Infinity>()) > tolerance) return {};
    all.push_back(most_missed(member, left));
    const double seen = member.tie->seen_by_motion(left.lpNorm<Eigen::Infinity>());
    if (seen <= tolerance) continue;
    wrong = true;
    meshes = meshes && (is_of_steps(member, seen, tolerance, bodies) ||
                        is_of_places(member, all.back(), bodies) ||
                        is_of_meshes(member, left, all.back(), bodies));
  }
  if (!wrong) return {};
  if (meshes) return {{}, true};
  return {words_of(all, time, bodies), false};
}

}  // namespace abut
