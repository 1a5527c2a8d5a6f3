#pragma once

#include <string>

#include <Eigen/Dense>

#include "coordinator/coupling/tie_layout.hpp"

namespace abut {

/// What to make of jumps that no force answers.
struct Unanswered {
  /// Words that tell the interfaces, their bodies, where, how far, and the remedy; empty: none.
  std::string contradiction;
  /// They are no more than what meshes, or unlike steps, leave of motions that both sides have.
  bool meshes = false;
};

/// Ties that ask for what cannot be: of jumps [m] in blocks, `rest` is what no force answers. Where
/// the other part is within the tolerance and the rest is not, motions are given to both sides that
/// differ, and no sweep makes them one: by more than lines between nodes can miss them by, where
/// they are told between nodes of unlike meshes, or for the meshes' sake alone  [M.125].
Unanswered judge_unanswered(const TieLayout& layout, const Eigen::VectorXd& jump,
                            const Eigen::VectorXd& rest, double tolerance, double time,
                            const Bodies& bodies);

}  // namespace abut
