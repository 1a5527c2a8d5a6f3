#include "coordinator/coupling/tie_layout.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

namespace abut {

namespace {

/// Share of cell i of `here` equal cells that cell k of `there` cells of the same time takes: W of
/// [M.107].
double shared(int i, int here, int k, int there) {
  const double begin = std::max(i / static_cast<double>(here), k / static_cast<double>(there));
  const double end =
      std::min((i + 1) / static_cast<double>(here), (k + 1) / static_cast<double>(there));
  return std::max(0.0, end - begin) * here;
}

}  // namespace

void TieLayout::add(const Joint& joint, Tie& tie, const std::array<int, 2>& counts,
                    Eigen::Index first) {
  members.push_back({.joint = &joint, .tie = &tie, .counts = counts, .first = first});
  for (const int s : {0, 1}) {
    if (tie.carried(s) == 0) continue;
    members.push_back({.joint = &joint,
                       .tie = &tie,
                       .counts = counts,
                       .carried = s,
                       .first = first + tie.first_place(s)});
  }
}

void TieLayout::arrange(const Bodies& bodies) {
  parts.clear();
  blocks = 0;
  for (std::size_t m = 0; m < members.size(); ++m) {
    Member& member = members[m];
    const bool carries = member.carried >= 0;
    member.width = carries ? member.tie->carried(member.carried) : member.tie->rows().width();
    member.total = member.counts[carries ? member.carried : member.joint->role.kinematic];
    for (const int s : {0, 1}) {
      if (carries && member.carried != s) continue;
      const int body = member.joint->sides[s].body;
      auto part = std::ranges::find(parts, body, &Part::body);
      if (part == parts.end()) {
        const Description& told = bodies.describe(body);
        parts.push_back({body,
                         member.counts[s],
                         bodies.step(body),
                         0,
                         !told.can.kernel,
                         told.quasi_static && !told.linear,
                         told.can.kernel && !told.quasi_static && !told.linear,
                         {}});
        part = parts.end() - 1;
        if (!part->stands) blocks = std::gcd(blocks, part->steps);
      }
      part->ends.push_back({m, s, part->width});
      part->width += member.width;
    }
  }
  for (const Member& member : members) blocks = std::gcd(blocks, member.total);
  for (Part& part : parts) part.steps = std::max(1, part.steps / blocks);
  size = 0;
  for (Member& member : members) {
    member.steps = member.total / blocks;
    member.inner = size;
    size += Eigen::Index{member.width} * member.steps;
  }
}

std::vector<int> TieLayout::pattern() const {
  std::vector<int> pattern;
  // In single precision, because ends of equal windows are rounded differently.
  for (const Part& part : parts)
    pattern.insert(pattern.end(),
                   {part.body, part.steps, std::bit_cast<int>(static_cast<float>(part.step))});
  for (const Member& member : members) pattern.insert(pattern.end(), {member.steps, member.width});
  return pattern;
}

std::vector<TieLayout::Share> TieLayout::shares(const Part& part, const End& of, const End& by,
                                                int lag, int known) const {
  const Member &row = members[of.member], &column = members[by.member];
  const auto sign = [](const Member& member, const End& end) {
    return member.carried >= 0 || end.side == member.joint->role.kinematic ? 1.0 : -1.0;
  };
  const double turn = sign(row, of) * sign(column, by);
  std::vector<Share> all;
  for (int k = 0; k < row.steps; ++k) {
    const double place = (lag + (k + 1) / static_cast<double>(row.steps)) * part.steps;
    const int whole = static_cast<int>(std::floor(place + 1.0e-9));
    const double beyond = std::max(0.0, place - whole);
    for (int a = 0; a < column.steps; ++a) {
      for (int i = 0; i < part.steps; ++i) {
        const double part_of = turn * shared(i, part.steps, a, column.steps);
        if (part_of == 0.0) continue;
        for (const auto& [later, weight] :
             {std::pair(whole - 1 - i, 1.0 - beyond), std::pair(whole - i, beyond)}) {
          if (later < 0 || weight < 1.0e-9 || later >= known) continue;
          all.push_back({k, a, later, part_of * weight});
        }
      }
    }
  }
  return all;
}

void TieLayout::give_way(int lag, const Tie::AddEntry& add) const {
  for (const Member& member : members)
    member.tie->give_way(lag, member.steps, [&](Eigen::Index of, Eigen::Index by, double value) {
      add(member.inner + of, member.inner + by, value);
    });
}

void TieLayout::spread(const Member& member, const Eigen::VectorXd& own,
                       Eigen::VectorXd& all) const {
  const Eigen::Index length = Eigen::Index{member.width} * member.steps;
  for (int m = 0; m < blocks; ++m)
    all.segment(m * size + member.inner, length) = own.segment(m * length, length);
}

void TieLayout::gather(const Member& member, const Eigen::VectorXd& all,
                       Eigen::Ref<Eigen::VectorXd> own) const {
  const Eigen::Index length = Eigen::Index{member.width} * member.steps;
  for (int m = 0; m < blocks; ++m)
    own.segment(m * length, length) = all.segment(m * size + member.inner, length);
}

}  // namespace abut
