#pragma once

#include <array>
#include <vector>

#include "coordinator/coupling/contact_zone.hpp"
#include "coordinator/coupling/exchange.hpp"
#include "coordinator/coupling/tie_net.hpp"

namespace abut {

/// Contact of surfaces: the kinematic body meets the partner's surface, which gives way by the
/// partner's port kernel, and the partner confirms what was predicted [M.90], [M.91]. Iterated is
/// the surface's motion without the reactions of the window: d of  y = d + kernel * reaction.  It
/// is constant where the partner is linear, and then one sweep is enough: a flight of the partner
/// without reactions, the kinematic body against it, the partner under the reaction. Partners
/// without a kernel, or of other substeps, are obstacles that do not give way: d is their motion,
/// first guessed under the forces of the window before, carried on, and relaxed.
class CompliantObstacle final : public Exchange {
 public:
  /// `largest_kernel`: [B] beyond which the obstacle does not give way.
  /// `margin` [m]: rows of facets may press before these touch.
  CompliantObstacle(double largest_kernel, double margin, const ContactLaw& law)
      : largest_kernel_(largest_kernel), zone_(margin) {
    law_ = law;
  }

  void begin(const TimeWindow& window, const Joint& joint, Bodies& bodies) override;
  int values() const override { return static_cast<int>(iterate_.size()); }
  void predict(Eigen::Ref<Eigen::VectorXd> x) const override;
  void impose(int side, const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint,
              Bodies& bodies) override;
  void image(const Eigen::Ref<const Eigen::VectorXd>& x, const Joint& joint, const Bodies& bodies,
             Eigen::Ref<Eigen::VectorXd> g) override;
  FieldResiduals measure(const Eigen::Ref<const Eigen::VectorXd>& x,
                         const Eigen::Ref<const Eigen::VectorXd>& g) const override;
  void scales(Eigen::Ref<Eigen::VectorXd> s) const override;
  Eigen::VectorXd apply_inverse(const Eigen::VectorXd& r) const override {
    return first_factor_ * r;
  }
  double first_factor() const override { return first_factor_; }
  bool ordered() const override { return true; }
  void enter(const Joint& joint, std::size_t part, KnownExchanges& known) override {
    known.obstacles.push_back({&joint, this, part});
  }
  void state(Archive& archive) override;

  // What a net asks beside (Net):

  /// Whether the Neumann side's body has other closed joints in the window that begins next.
  void share(bool shared) { shared_ = shared; }
  /// Whether the first guess is a flight: the Neumann side is advanced once, as `release` asks, and
  /// brought back, before the guess is made.
  bool flies() const { return flies_; }
  /// The kernel is of near points alone: what forces move beyond them is in d, and takes a sweep
  /// more.
  bool leaves_out() const { return kernel_ != nullptr && !kernel_->band.empty(); }
  void release(const Joint& joint, Bodies& bodies);
  void see_flight(const Joint& joint, const Bodies& bodies);
  /// [N] the largest sum of forces on points in this sweep, and in windows before; 0: the joint is
  /// not one of statics.
  double pressed(const Joint& joint) const;
  /// [N] by which forces are measured in this sweep: what presses most, of all joints that hang
  /// together.
  void measure_forces_by(double force) { deformation_ = force * give_; }
  /// The part of it that a mismatch g - x makes of the force at the joint  [M.144].
  double force_of(const Eigen::Ref<const Eigen::VectorXd>& x,
                  const Eigen::Ref<const Eigen::VectorXd>& g) const;
  /// The largest speed by which mismatches of this window were measured over that of this sweep and
  /// the first, >= 1: a sweep that went astray must not loosen the test for those after it.
  double stray() const;
  /// The ties of bodies on either side have laid out their iterates: how they give way under
  /// contact. False: that is not known.
  bool ease(TieNet& net, const Joint& joint, Bodies& bodies);
  /// The bodies are not told any more how ties give way.
  void withdraw(const Joint& joint, Bodies& bodies);
  /// The forces of ties change by their parts of a stacked vector: adds what that does to g - x.
  void follow(const Eigen::VectorXd& change, Eigen::Ref<Eigen::VectorXd> own) const;

 private:
  void find_give(const Joint& joint, Bodies& bodies);
  void find_kernel(double length, const Joint& joint, Bodies& bodies);
  [[nodiscard]] bool probe(double size, const Side& k, const Side& n, Bodies& bodies);
  void find_zone(double length, const Joint& joint, const Bodies& bodies);
  void expect_beyond(const TimeWindow& window);
  /// Of the port: that of a list of its points which is number k; empty: all are listed.
  std::size_t value(const std::vector<std::int32_t>& points, std::size_t k) const;
  bool see_look(const Joint& joint, const Bodies& bodies);
  void keep_begin(const TimeWindow& window, const Joint& joint, const Bodies& bodies);
  void take(const Waveform& force);
  void take_back(const Eigen::MatrixXd& taken, Eigen::Ref<Eigen::VectorXd> motion) const;
  void take_back_end(Eigen::Ref<Eigen::VectorXd> motion) const;
  void fit_ties();
  void tell_neighbours(const Side& k, const PortKernel& give, Bodies& bodies);
  void balance_begin(const Side& k, const Bodies& bodies);
  void keep_found(const Side& k, const Bodies& bodies);
  void leave_far(const Eigen::Ref<const Eigen::VectorXd>& x, Eigen::Ref<Eigen::VectorXd> g) const;
  double reached(const Waveform& trace) const;
  void see_speed(double now);
  /// The Neumann side flies under no force: none presses, or what it moves under forces is known by
  /// its kernel.
  /// Others press on it as well: they go on, and are not in this joint's kernel.
  bool free_ahead() const { return linear_ && !shared_ && (kernel_ != nullptr || zone_.empty()); }

  double largest_kernel_;  // [B]
  Substeps kinematic_grid_;
  IterateGrid iterate_;                    // of the Neumann port
  std::vector<double> u_begin_, v_begin_;  // (width) of the Neumann port
  std::vector<double> f_begin_, f_rate_;   // [N] [N/s] (width) reaction at the window's begin
  Waveform guess_;                         // [N] under which the Neumann side flies
  std::size_t dim_ = 1;
  ContactZone zone_;                    // of points that give way
  std::vector<double> u_k_;             // [m] of the kinematic port, at the window's begin
  const PortKernel* kernel_ = nullptr;  // null: the obstacle does not give way
  PortKernel answer_;                   // of the zone
  std::size_t unbanded_ = 0;            // points, and one, of a zone that no band was found for
  bool answer_told_ = false;            // the kinematic body knows it
  // What bodies tied to either side answer, as the kinematic body was told; null: none are.
  struct Eased {
    const TiedPort* port = nullptr;
    PortKernel told;
  };
  std::array<Eased, 2> eased_;  // of the kinematic side, of the other
  const TieLayout* layout_ = nullptr;
  Eigen::MatrixXd fits_;            // [N] as taken_: what forces of ties fit, of the sweep before
  Waveform balanced_;               // [N] f of the kinematic port that forces of ties fit, as fits_
  int sweeps_ = 0;                  // of the window so far
  std::vector<std::int32_t> slid_;  // points that count as sliding in the next sweep
  bool linear_ = false;             // of the Neumann side
  bool shared_ = false;             // the Neumann side has other joints
  bool flies_ = false;
  double looks_ = 0.0;      // [s] by which the Neumann side looks on after the window
  Eigen::VectorXd flight_;  // [m] as the iterate; empty: none was flown
  // [m] As the iterate, where the kernel leaves something out: what it left out of d - flight in
  // the window before, as this one's guess, and in the last sweep; empty: nothing is known. Between
  // [s] the ends of the window.
  Eigen::VectorXd beyond_, beyond_now_;
  double beyond_begin_ = 0.0, beyond_end_ = 0.0;
  Waveform given_;          // the obstacle of this sweep
  ReferenceScales scale_;
  bool swept_ = false;  // in this window
  // [m/N] by which both sides are deformed where forces on all points sum up to 1 N; 0: not known,
  // or one of them has inertia.
  double give_ = 0.0;
  double deformation_ = 0.0;  // [m] by the forces of this sweep
  // [m/s] Of the closing and of the first sweep; the same, or of the present one.
  double usual_speed_ = 0.0, measured_speed_ = 0.0;
  double first_factor_ = 1.0;
  Eigen::VectorXd moved_;    // [m] (width) by the reaction, at the window's end
  Eigen::MatrixXd pressed_;  // [N] (width, times of the reaction)
  Eigen::MatrixXd taken_;    // [N] (width, levels) of the reaction by the Neumann side, beyond d's
  mutable std::vector<double> level_force_, level_moved_;  // [N], [m] (kernel) at one level
};

}  // namespace abut
