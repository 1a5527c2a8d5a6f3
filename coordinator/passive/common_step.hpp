#pragma once

#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/passive/near_rows.hpp"
#include "coordinator/passive/passive_ledger.hpp"
#include "coordinator/passive/passive_ties.hpp"
#include "coordinator/passive/rigid_impacts.hpp"
#include "coordinator/passive/row_impulses.hpp"
#include "coordinator/passive/sliding_points.hpp"

namespace abut {

/// A step that all bodies take together in their passive forms: impulses on what is near, so that
/// surfaces stay apart and energy does not grow (docs/METHOD.md, section 16).
///
///   take      free ways, rows, impulses until they fit, and the check of the ways
///   rows_fit  whether the impulses that were tried do what rows ask
///   accept    accounts of all bodies
class CommonStep {
 public:
  /// Why a step was not taken. Every reason goes away with shorter steps.
  enum class Refusal {
    body,    // one has no answer
    rows,    // no impulses that fit
    work,    // what contact did is not passive
    energy,  // a body gained
    path,    // surfaces would come too near on their way
  };

  /// `nominal` [s]: the longest step. `statics`: no body has inertia. All must outlive it.
  CommonStep(const TouchingSurfaces& surfaces, NearRows& near, std::vector<PassiveTie> ties,
             Bodies& bodies, double nominal, bool statics);

  /// What the bodies are in when the passive way begins.
  [[nodiscard]] std::optional<Failed> begin(double time);
  /// From where the bodies are and were saved. Afterwards they are at the end or, refused,
  /// anywhere: restore them. `lenient`: bodies may gain, it is taken from them.
  std::optional<Refusal> take(double begin, double end, bool lenient, PassiveLedger& ledger);
  /// Of bodies without inertia, after a step that was taken: the same once more, from where they
  /// are and were saved, so that what held them as wholes in it lets go; they are held by
  /// 4^-looser of it. False: restore them; the step is as it was. So it is where a point would
  /// move farther than `most_way` [m]: what presses was lost then.
  bool settle(double begin, double end, int looser, double most_way, bool lenient,
              PassiveLedger& ledger);
  /// Of the last step that was refused, for people.
  const std::string& why() const { return why_; }
  /// What supports and ways drove onto each other in it, for people, with a remedy; empty: nothing.
  std::string driven() const;
  /// The body that could not take it; -1: none alone.
  int culprit() const { return culprit_; }

  // Of the last step that was taken:

  double farthest() const;  // [m] by which a point moved at most
  double held() const;      // most that a body was held in the step, as PassiveReply::held

  const BodyRecord& record(int body) const { return replies_[index(body)].record; }
  /// [m], [m/s] of a port's points, from the reference configuration.
  const std::vector<double>& displacement(int body, int port) const {
    return displacements_[index(body)][index(port)];
  }
  const std::vector<double>& velocity(int body, int port) const {
    return replies_[index(body)].ports[index(port)].velocity;
  }
  std::span<const DistanceRow> rows() const { return rows_; }
  /// [J] done by contact on a body's port.
  double work(int body, int port) const { return port_work_[index(body)][index(port)]; }
  /// What was damped or forgiven outside of steps.
  void lower(int body, double joules);

  const PassiveTies& ties() const { return ties_; }

  void state(Archive& archive);

 private:
  using Debts = std::map<std::int32_t, double>;  // [J] to rows, by their first points
  using Places = std::vector<Eigen::Vector3d>;

  std::optional<Refusal> iterate();
  bool prepare_rows();
  void give_friction(DistanceRow& row) const;
  void warm(DistanceRow& row);
  void claim_of_others();
  std::optional<Failed> advance(bool all);
  void see_velocities();
  void find_impulses(bool any);
  void press_rows(bool any);
  bool ties_fit(double most) const;
  double most_work() const;
  void take_answer(int owner, double softer);
  void follow_ties();
  void rows_ask(double& unfit, double& work) const;
  void solve_rows(std::size_t answered);
  std::optional<Refusal> accept(bool lenient, PassiveLedger& ledger);
  void see_start();
  double heat_of(const DistanceRow& row) const;
  double speed_of_loads(const DistanceRow& row) const;
  double speed_of_rest() const;
  void share_out_work();
  void share_out_ties();
  void count_normal(const DistanceRow& row, PassiveLedger& ledger);
  bool is_blow(const DistanceRow& row, double& approach) const;
  void count_friction(const DistanceRow& row, PassiveLedger& ledger) const;
  void share_out_loss(const DistanceRow& row, double loss, PassiveLedger& ledger) const;
  static Debts affordable(Debts debts, double there);
  static double farthest_of(std::span<const PassiveReply> replies);  // [m]
  static double own_energy(const BodyRecord& record);                // [J] of a body
  static double motion_of(std::span<const PassiveReply> replies);    // [J] of all bodies together
  double length() const { return step_.end - step_.begin; }

  const TouchingSurfaces& surfaces_;
  NearRows& near_;
  Bodies& bodies_;
  double nominal_;
  bool statics_;
  PassiveTies ties_;
  PressedPoints points_;
  PassiveStep step_;                                             // what all share
  std::vector<PassiveStep> asked_;                               // by body
  std::vector<std::vector<std::vector<double>>> pressing_;       // [N s] of rows alone, the same
  std::vector<PassiveReply> tried_, replies_;                    // by body
  std::vector<std::vector<std::vector<double>>> displacements_;  // [m] by body and port
  std::vector<char> advanced_;                                   // (bodies) since they were saved
  Places from_, to_, velocities_, start_;  // (points); velocities in the step, and at its begin
  std::vector<DistanceRow> rows_;
  std::size_t prepared_ = 0;  // rows that were given their targets
  bool pushing_ = false;
  double allowed_ = 0.0;   // [J] that contact may do in the step
  double lost_ = 0.0;      // [J] by normal contact so far
  double released_ = 0.0;  // [J] beside, by rows that part
  double returned_ = 0.0;  // [J] and by friction that took too much
  int softer_ = 0;         // solves of these rows so far
  int looser_ = 0;         // than in a first step bodies are held
  double most_way_ = std::numeric_limits<double>::infinity();  // [m] of a point
  double fine_ = 1.0;                                          // times what fits, in this step
  std::map<DistanceRow::Key, Eigen::Vector3d> warm_;           // impulses of the last step [N s]
  Debts owed_;                                                 // [J] to rows, by their first points
  Debts unclaimed_;                                            // of it, by no row of this step yet
  RigidImpacts impacts_;
  SlidingPoints sliding_;
  std::vector<double> energies_;                // [J] by body
  std::vector<double> accounts_;                // [J] by body that nothing explains
  std::vector<std::vector<double>> port_work_;  // [J] by body and port
  double most_ = 0.0;                           // [J] largest kinetic and stored energy
  double credit_ = 0.0;                         // [J] half of what normal contact has lost
  std::string why_;
  int culprit_ = -1;
};

}  // namespace abut
