#pragma once

#include <vector>

#include <Eigen/Dense>

#include "coordinator/coupling/tie.hpp"

namespace abut {

/// Ties that hang together, the bodies that they join, and how time repeats itself for all of them:
/// after a block, the shortest time that is a whole number of everybody's steps.
struct TieLayout {
  struct Member {
    const Joint* joint = nullptr;
    Tie* tie = nullptr;
    std::array<int, 2> counts = {0, 0};  // steps of the sides in the window
    int carried = -1;  // side of whose body it is the places of loose motions, in place of forces
    Eigen::Index first = 0;  // of its part of the stacked vector
    Eigen::Index inner = 0;  // of its part of a block
    int width = 0;           // rows x dim, or loose motions
    int steps = 0;           // of the force, in a block
    int total = 0;           // in the window
  };
  struct End {
    std::size_t member = 0;
    int side = 0;
    Eigen::Index first = 0;  // of its rows among those of its body
  };
  struct Part {  // a body
    int body = 0;
    int steps = 0;           // in a block
    double step = 0.0;       // [s]
    Eigen::Index width = 0;  // rows x dim of all its ends
    bool stands = false;     // no force moves it
    bool bends = false;      // without inertia, and not linear: it answers as it is strained
    // in motion, and not linear: it answers a light push, whose effects are differences, and what
    // it answers turns with its ports
    bool turns = false;
    std::vector<End> ends;
  };
  /// What a body's kernel does in a block: `weight` times that of its step `later` (from 0), from
  /// the force's step `by` to the reading at the end of step `of`.
  struct Share {
    int of = 0, by = 0, later = 0;
    double weight = 0.0;
  };

  std::vector<Member> members;
  std::vector<Part> parts;
  int blocks = 0;         // of the window
  Eigen::Index size = 0;  // of a block: force steps x rows x dim of all members

  bool empty() const { return members.empty(); }
  bool carries(const End& end) const { return members[end.member].carried >= 0; }
  /// Finds all but joint, tie, first, counts and carried of the members, which are given.
  void arrange(const Bodies& bodies);
  /// The members of a tie, whose part of the stacked vector begins at `first`.
  void add(const Joint& joint, Tie& tie, const std::array<int, 2>& counts, Eigen::Index first);
  /// Equal: what is known of the kernels holds.
  std::vector<int> pattern() const;
  const TieRows& rows(const End& end) const { return members[end.member].tie->rows(); }
  const Side& side(const End& end) const { return members[end.member].joint->sides[end.side]; }
  const Side& other_side(const End& end) const {
    return members[end.member].joint->sides[1 - end.side];
  }
  Eigen::Index values_of(const Member& member) const {
    return Eigen::Index{member.width} * member.total;
  }
  /// Shares of forces of the end `by` in the first block in the motion of the end `of` so many
  /// blocks later: motion is read at the ends of the force's steps, linear between the body's
  /// [M.107], [M.108]. `known`: steps of the kernel.
  std::vector<Share> shares(const Part& part, const End& of, const End& by, int lag,
                            int known) const;
  /// What the joints themselves give way to forces in the first block, as entries of a later one.
  void give_way(int lag, const Tie::AddEntry& add) const;
  /// From a joint's own list (steps, rows) to that of blocks, and back.
  void spread(const Member& member, const Eigen::VectorXd& own, Eigen::VectorXd& all) const;
  void gather(const Member& member, const Eigen::VectorXd& all,
              Eigen::Ref<Eigen::VectorXd> own) const;
};

}  // namespace abut
