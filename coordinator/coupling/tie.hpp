#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/tie_rows.hpp"

namespace abut {

/// Two surfaces that are one, of any meshes, steps and integrators: both sides take the same force
/// in the rows that join them, constant in every step of the kinematic side, and advance at once;
/// iterated is this force until both sides move alike at those steps' ends  [M.107], [M.108]. What
/// answers it knows all joints of a net at once (TieNet).
class Tie : public Exchange {
 public:
  explicit Tie(TieRows rows, EnergyAccount account = EnergyAccount::exact)
      : rows_(std::move(rows)), account_(account) {}

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return static_cast<int>(iterate_.size() + places(0) + places(1)); }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  bool ordered() const override { return false; }
  EnergyAccount energy_account() const override { return account_; }
  void enter(const Joint& joint, std::size_t part, KnownExchanges& known) override {
    known.ties.push_back({&joint, this, part});
  }
  void state(Archive& archive) override;

  /// From now on, where these many loose motions of a side's body are is part of the iterate, which
  /// is (forces, places of side 0, places of side 1): what is left over of the forces along them
  /// is to be nothing  [M.112].
  void carry(int side, int motions) { loose_[side] = motions; }
  int carried(int side) const { return loose_[side]; }
  /// Where the places of a side begin in the iterate.
  Eigen::Index first_place(int side) const { return iterate_.size() + (side == 1 ? places(0) : 0); }

  const TieRows& rows() const { return rows_; }
  /// By which kernels read how a side moves: they answer mismatches of these.
  virtual const SparseRows& kernel_rows(int side) const { return rows_.of[side]; }
  /// [m/N] of a value of the force's steps by another one.
  using AddEntry = std::function<void(Eigen::Index of, Eigen::Index by, double value)>;
  /// Adds how the joint itself gives way to its forces of a block's `steps`, at the ends of these
  /// so many blocks later: a tie does not.
  virtual void give_way(int /*lag*/, int /*steps*/, const AddEntry&) const {}
  /// (dim, dim) by which a side of a body in motion that is not linear had turned when the window
  /// began; else empty.
  const Eigen::MatrixXd& turn(int side) const { return turns_[side]; }
  /// Substeps of a side in the window.
  const Substeps& grid(int side) const { return grids_[side]; }
  /// [m] (steps of the kinematic side, rows, dim) by which the sides part without forces between
  /// them, as they told after the window before; empty: they did not tell.
  const Eigen::VectorXd& trial() const { return trial_; }
  /// [m/N] of both sides over a step: what makes forces of mismatches.
  void set_unit(double compliance) { compliance_ = compliance; }
  double unit() const { return compliance_; }

  /// Of the latest sweep: [m/s] how fast anything on the sides moved, [m] by how much they missed
  /// each other at most, [N] the largest resultant of the forces between them.
  double speed() const { return speed_; }
  /// A distance [m] as the tolerance sees it; and by what the sides move alone, where forces that
  /// answer nothing grow without end.
  double seen(double distance) const;
  double seen_by_motion(double distance) const;
  /// Of the latest sweep: this part [m] of its jumps, which no force answers, stays, and is not
  /// measured.
  void leave_open(const Eigen::VectorXd& rest) { open_ = rest; }
  double missed() const { return jump_.size() > 0 ? jump_.lpNorm<Eigen::Infinity>() : 0.0; }
  double largest_force() const;
  double row_force() const { return row_force_; }  // [N] the largest of a row

  /// The accurate method takes over: the sides are one as they stand then.
  void rejoin();
  /// A window begins that is gone passively.
  void begin_passive(double time);
  /// Of a step of it: forces [N] (rows, dim) on the kinematic side, constant in it, and by what
  /// the sides have parted at its end [m], the same.
  void see_passive(double end, std::span<const double> force, std::span<const double> parted);

 protected:
  TieRows rows_;
  // [m] (rows, dim) by which displacements of the sides differ for good: as they stood at the start
  std::vector<double> start_;
  IterateGrid iterate_;   // of the force
  Eigen::VectorXd jump_;  // [m] of the latest sweep
  ReferenceScales scale_;

 private:
  void keep_start(double time, const Joint& joint, const Bodies& bodies);
  void part(const Joint& joint, const std::array<const Waveform*, 2>& motions,
            Eigen::VectorXd& out) const;

  Eigen::Index places(int side) const { return Eigen::Index{loose_[side]} * grids_[side].count; }
  bool looks(const Joint& joint, const Bodies& bodies) const;
  void remember(const TimeWindow& window);
  void see_turns(const Joint& joint, const Bodies& bodies);
  void go_straight_on(Eigen::Ref<Eigen::VectorXd> x) const;

  EnergyAccount account_;
  std::array<int, 2> loose_ = {0, 0};
  /// At the end of a window: of the last sweep, and of windows that went before.
  struct Past {
    double time = 0.0;                         // [s]
    std::vector<double> force;                 // [N]
    std::array<std::vector<double>, 2> place;  // [m] of loose motions, by side
    void state(Archive& archive);
  };
  Past last_;
  std::vector<Past> past_;  // two at most, the later one first
  bool straight_ = false;   // guesses go on as the past went
  std::array<Substeps, 2> grids_;
  std::array<Eigen::MatrixXd, 2> turns_;
  Waveform force_;  // of the last sweep, the first guess of the next window
  TimeWindow window_;
  Eigen::VectorXd trial_, open_;
  double compliance_ = 1.0;
  double unit_ = 1.0;  // [1/N] of a window's first sweep: secants compare sweeps
  double row_force_ = 0.0;
  double unbalanced_ = 0.0;    // [N] largest of the latest sweep
  double speed_ = 0.0;         // [m/s] of the latest sweep
  double moved_ = 0.0;         // [m] by the sides in a step, of the latest sweep
  double first_speed_ = -1.0;  // and of the first one; below 0: none yet
};

}  // namespace abut
