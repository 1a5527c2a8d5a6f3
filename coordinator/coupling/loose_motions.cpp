#include "coordinator/coupling/loose_motions.hpp"

#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "coordinator/coupling/tie.hpp"

namespace abut {

namespace {

/// Of the largest: the square of a motion that no tie notices.
constexpr double no_motion = 1.0e-12;

/// Columns of motions, one per loose motion of each body.
std::map<int, Eigen::Index> columns_of(std::span<const Joint> joints, const Bodies& bodies) {
  std::map<int, Eigen::Index> columns;
  Eigen::Index next = 0;
  for (const auto& [joint, tie, part] : known_exchanges(joints).ties) {
    for (const Side& side : joint->sides) {
      const int count = loose_motions(bodies.describe(side.body));
      if (count > 0 && columns.emplace(side.body, next).second) next += count;
    }
  }
  return columns;
}

/// [m] (rows of a tie, all loose motions) by which motions part its sides.
Eigen::MatrixXd parted(const Joint& joint, const TieRows& rows,
                       const std::map<int, Eigen::Index>& columns, Eigen::Index count,
                       const Bodies& bodies) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows.width(), count);
  std::vector<double> seen(index(rows.width()));
  for (const std::size_t s : {0u, 1u}) {
    const Description& body = bodies.describe(joint.sides[s].body);
    for (int k = 0; k < loose_motions(body); ++k) {
      apply(rows.of[s], rows.dim, loose_motion(body, k, bodies.port(joint.sides[s]).geometry),
            seen);
      out.col(columns.at(joint.sides[s].body) + k) +=
          (s == 0 ? 1.0 : -1.0) *
          Eigen::Map<const Eigen::VectorXd>(seen.data(), static_cast<Eigen::Index>(seen.size()));
    }
  }
  return out;
}

}  // namespace

std::vector<double> loose_motion(const Description& body, int motion, const PortGeometry& port) {
  const int dim = port.dim, each = dim == 2 ? 3 : 6;
  const double* by = &body.loose[motion * each];
  std::vector<double> out(port.points.size());
  for (std::size_t at = 0; at < out.size(); at += index(dim)) {
    const double* x = &port.points[at];
    for (int i = 0; i < dim; ++i) out[at + index(i)] = by[i];
    if (dim == 2) {
      out[at] -= by[2] * x[1];
      out[at + 1] += by[2] * x[0];
    } else {
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[at + index(i)] += by[3 + j] * x[k] - by[3 + k] * x[j];
      }
    }
  }
  return out;
}

void check_supports(std::span<const Joint> joints, const Bodies& bodies) {
  const std::map<int, Eigen::Index> columns = columns_of(joints, bodies);
  if (columns.empty()) return;
  Eigen::Index count = 0;
  for (const auto& [body, first] : columns) count += loose_motions(bodies.describe(body));
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(count, count);
  for (const auto& [joint, tie, part] : known_exchanges(joints).ties) {
    const Eigen::MatrixXd apart = parted(*joint, tie->rows(), columns, count, bodies);
    square.noalias() += apart.transpose() * apart;
  }
  const EigenPairs motions = symmetric_eigen(square);
  if (motions.values(0) > no_motion * motions.values(count - 1)) return;
  std::string names;
  const Eigen::VectorXd free = motions.vectors.col(0);
  for (const auto& [body, first] : columns) {
    const Description& told = bodies.describe(body);
    if (free.segment(first, loose_motions(told)).norm() < 1.0e-6) continue;
    names += (names.empty() ? "'" : ", '") + told.name + "'";
  }
  throw InputError(fmt::format("leave bodies without inertia free to move or turn as a whole: {}; "
                               "no constraint holds them, and no body that they are tied to",
                               names),
                   "interfaces", "Hold one of them by constraints, or give it inertia.");
}

void share_out_loose_motions(std::span<const Joint> joints, const Bodies& bodies) {
  std::set<int> carried;
  for (const auto& [joint, tie, part] : known_exchanges(joints).ties) {
    for (const int s : {0, 1}) {
      const int body = joint->sides[s].body;
      const int count = loose_motions(bodies.describe(body));
      if (count > 0 && carried.insert(body).second) tie->carry(s, count);
    }
  }
}

}  // namespace abut
