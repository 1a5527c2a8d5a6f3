#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/semidefinite.hpp"
#include "contract/passive.hpp"
#include "coordinator/coupling/bodies.hpp"
#include "coordinator/coupling/tie.hpp"

namespace abut {

/// Two surfaces that are one, and the rows in which their motions are compared.
struct PassiveTie {
  std::array<Side, 2> sides;
  Tie* tie = nullptr;  // is told of forces; null: two ends of bars that share a node
  TieRows node;        // then these are its rows
  int kinematic = 0;   // its side on which they act as they are told

  const TieRows& rows() const { return tie != nullptr ? tie->rows() : node; }
};

/// Joined bodies in a passive step [M.139]: impulses L of rows T that make both sides move alike,
/// T w = T v/2 at the step's begin - b d/h, with d what the sides have parted by. So the velocities
/// at its end are alike as well, and T w = 0 from then on. Bodies that hang together by ties, a
/// cluster, answer contact as one body: what contact presses on one of them, ties hand on.
class PassiveTies {
 public:
  PassiveTies(std::vector<PassiveTie> ties, const Bodies& bodies);

  bool any() const { return !ties_.empty(); }
  /// The first of the bodies with which a body hangs together; itself where it is tied to none.
  int cluster(int body) const { return cluster_[index(body)]; }
  bool joined(int body) const { return members_[index(cluster(body))].size() > 1; }

  using Displacements = std::vector<std::vector<std::vector<double>>>;  // [m] (bodies; ports)
  /// Where the sides are when the passive way begins: they part from there on.
  void begin(const Displacements& displacements);
  /// A step begins, of a length [s], from there and with the velocities of these replies. Work [J]
  /// below `rounding` is none.
  void aim(double length, const Displacements& displacements, std::span<const PassiveReply> before,
           double rounding);
  /// Adds the points of tied ports to those that contact presses on.
  void add_points(int body, std::vector<std::vector<std::int32_t>>& pressed) const;
  /// Adds the impulses [N s] of ties to those of contact.
  void add_impulses(int body, std::vector<std::vector<double>>& impulses) const;
  /// Takes the answers to the impulses as they were. `pressed`: by body, as it was asked.
  void see(std::span<const PassiveReply> replies, std::span<const PassiveStep> asked);
  /// [m] by which ties are missed at most.
  double missed() const;
  /// Whether no cluster gains energy by its ties, but for roundings.
  bool passive() const;
  /// [J] of the impulses, at the velocities that were seen.
  double work() const;

  /// How a cluster answers contact while its ties hold: the values of listed points, in their
  /// order. `points`: (body, port, point).
  struct Answer {
    Eigen::MatrixXd compliance;  // [1/kg] (values, values)
    Eigen::VectorXd change;      // [m/s] (values) of what the bodies told, until ties hold
  };
  Answer answer(int cluster, std::span<const std::array<std::int32_t, 3>> points);
  /// The impulses that ties need beside, for a change [N s] (values) of contact's impulses.
  void follow(int cluster, const Eigen::VectorXd& change);
  /// The step was taken: the next one begins with forces like these.
  void accept();
  /// A window begins.
  void begin_window(double time) const;
  /// Tells the ties of the step that was taken.
  void tell(double end) const;

  void state(Archive& archive);

 private:
  struct Cluster {
    std::vector<int> ties;
    std::vector<std::array<std::int32_t, 3>> values;  // body, port, point of every dim values
    std::vector<Eigen::Index> first;                  // (ties) of their rows
    Eigen::Index rows = 0;
    Eigen::MatrixXd across;         // [1/kg] (rows, values) T C
    Eigen::MatrixXd contact;        // [1/kg] (rows, contact values) of it
    SemidefiniteFactors stiffness;  // of T C T^T
    Eigen::VectorXd before;         // impulses that make ties hold without more contact
    double share = 1.0;             // of what is aimed at
  };
  Eigen::VectorXd of_cluster(const Cluster& cluster, std::span<const Eigen::VectorXd> values) const;
  Eigen::VectorXd part(const PassiveTie& tie, std::size_t side,
                       const std::vector<double>& values) const;
  Eigen::MatrixXd block_compliance(const Cluster& cluster) const;
  Eigen::MatrixXd operator_of(const Cluster& cluster) const;

  std::vector<PassiveTie> ties_;
  const Bodies& bodies_;
  int dim_ = 2;
  double length_ = 0.0, rounding_ = 0.0;
  std::vector<int> cluster_;               // (bodies)
  std::vector<std::vector<int>> members_;  // (bodies) of the cluster that a body leads
  std::vector<Cluster> clusters_;          // (bodies) the same
  std::span<const PassiveReply> replies_;
  std::span<const PassiveStep> asked_;
  std::vector<Eigen::VectorXd> start_;     // [m] (ties; rows, dim)
  std::vector<Eigen::VectorXd> parted_;    // [m] when the step begins
  std::vector<Eigen::VectorXd> aim_;       // [m/s] T w wanted, so far as it does no work
  std::vector<Eigen::VectorXd> velocity_;  // [m/s] T w seen
  std::vector<Eigen::VectorXd> impulses_;  // [N s]
  std::vector<Eigen::VectorXd> forces_;    // [N] of the last step
};

}  // namespace abut
