#include "coordinator/coupling/tie_contradiction.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace abut {

namespace {

/// Of the largest: interfaces that miss by less have no part in it.
constexpr double part = 1.0e-3;

struct Missed {
  const TieLayout::Member* member = nullptr;
  double distance = 0.0;  // [m] the largest of a row at a step's end
  int row = 0;
};

Missed largest(const TieLayout::Member& member, const Eigen::VectorXd& rest) {
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

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

}  // namespace

std::string find_contradiction(const TieLayout& layout, const Eigen::VectorXd& jump,
                               const Eigen::VectorXd& rest, double tolerance, double time,
                               const Bodies& bodies) {
  std::vector<Missed> all;
  bool wrong = false;
  for (const TieLayout::Member& member : layout.members) {
    if (member.carried >= 0) continue;
    Eigen::VectorXd left(layout.values_of(member)), answered(left.size());
    layout.gather(member, rest, left);
    layout.gather(member, jump - rest, answered);
    if (member.tie->seen(answered.lpNorm<Eigen::Infinity>()) > tolerance) return {};
    wrong = wrong || member.tie->seen_by_motion(left.lpNorm<Eigen::Infinity>()) > tolerance;
    all.push_back(largest(member, left));
  }
  if (!wrong) return {};
  std::ranges::stable_sort(all, std::ranges::greater{}, &Missed::distance);
  double distance = 0.0;
  std::vector<std::string> ties, names;
  for (const Missed& missed : all) {
    if (missed.distance < part * all.front().distance) break;
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

}  // namespace abut
