#pragma once

#include <map>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include "coordinator/coupling/islands.hpp"
#include "coordinator/coupling/tie.hpp"

namespace abut {

/// All ties of an island at once: how forces in any of them move the sides of any other apart, by
/// the port kernels of the bodies, which reach from port to port [M.109]. Bodies repeat themselves
/// after the shortest time that is a whole number of everybody's steps, so the map is one of equal
/// blocks below each other, and its inverse needs the factors of one. Linear bodies are answered
/// exactly, whatever the net. Where bodies have no inertia and nothing but their ties holds them,
/// the places of their loose motions are found with the forces  [M.110].
class TieNet {
 public:
  /// `largest`: [B] that kernels may take; where they need more, what a force does later on is
  /// left out.
  explicit TieNet(double largest) : largest_(largest) {}

  /// A window begins: the ties have laid out their iterates. `first`: of the joints of the island,
  /// where their parts of a stacked vector begin.
  void begin(const Island& island, std::span<const Joint> joints,
             std::span<const Eigen::Index> first, Bodies& bodies);
  bool empty() const { return members_.empty(); }
  /// After a sweep: what has no inertia and is not linear is asked anew how it gives way.
  /// False: there is none, or one that secants know more about.
  bool renew(Bodies& bodies);
  /// First guesses, where all bodies have told how they would part.
  void predict(Eigen::VectorXd& x) const;
  /// Answers the ties' parts of a residual g - x, in the ties' units; leaves the others alone.
  void apply_inverse(Eigen::VectorXd& r) const;

 private:
  struct Member {
    const Joint* joint = nullptr;
    Tie* tie = nullptr;
    Eigen::Index first = 0;  // of its part of the stacked vector
    Eigen::Index inner = 0;  // of its part of a block
    int width = 0;           // rows x dim
    int steps = 0;           // of the force, in a block
    int total = 0;           // in the window
    int carried = -1;        // side whose loose motions it is of, instead of forces
    double scale = 1.0;      // of unknowns, so that all are forces: [m/N] of loose motions
  };
  struct End {
    std::size_t member = 0;
    int side = 0;
    Eigen::Index first = 0;  // of its rows among those of its body
  };
  /// A body, and how forces in rows move rows: at the end of step l after one in step 1.
  struct Part {
    int body = 0;
    int steps = 0;  // in a block
    Eigen::Index width = 0;
    std::vector<End> ends;
    bool renewed = false;
    std::vector<Eigen::MatrixXd> kernel;  // [m/N] (steps) of (width, width); empty: it stands
  };

  void set_scales();
  void find_members(const Island& island, std::span<const Joint> joints,
                    std::span<const Eigen::Index> first);
  void find_parts(const Bodies& bodies);
  void add_end(int body, const End& end, int steps, const Bodies& bodies);
  void find_kernels(int lags, Bodies& bodies);
  void find_kernel(Part& part, Bodies& bodies);
  void carry(Part& part, const PortKernel& kernel, std::span<const int> seen,
             const Bodies& bodies);
  template <class Visit>
  void see(const Part& part, const double*& values, std::span<const int> seen,
           const Bodies& bodies, const Visit& visit) const;
  void find_blocks(int lags);
  void press(Part& part, const End& by, std::span<const int> seen, Bodies& bodies);
  void read(Part& part, const End& by, int from, const PortKernel& kernel,
            std::span<const int> seen, const Bodies& bodies) const;
  void find_block(int lag);
  void add(const Part& part, const End& of, const End& by, int lag, Eigen::MatrixXd& block) const;
  int lags_that_fit(int blocks) const;
  void factor();
  Eigen::VectorXd solve(const Eigen::VectorXd& jump) const;
  void spread(const Member& member, const Eigen::VectorXd& own, Eigen::VectorXd& all) const;
  void gather(const Member& member, const Eigen::VectorXd& all,
              Eigen::Ref<Eigen::VectorXd> own) const;
  static double sign(const Member& member, const End& end) {
    return member.carried >= 0 || end.side == member.joint->kinematic ? 1.0 : -1.0;
  }
  static double residual_unit(const Member& member) {
    return member.carried < 0 ? member.tie->unit() : member.scale / member.tie->unit();
  }
  static Eigen::Index values_of(const Member& member) {
    return Eigen::Index{member.width} * member.total;
  }

  double largest_;
  std::vector<Member> members_;
  std::vector<Part> parts_;
  std::map<std::size_t, double> scales_;  // Member::scale, by member
  std::vector<int> pattern_;  // steps of bodies and forces in a block, for which blocks_ hold
  int count_ = 0;             // blocks of the window
  Eigen::Index size_ = 0;     // of a block
  std::vector<Eigen::MatrixXd> blocks_;  // [m/N] by lag
  // Of the first block: factors, or where rows are redundant the inverse of least size.
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  Eigen::MatrixXd inverse_;
};

}  // namespace abut
