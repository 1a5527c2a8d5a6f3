#pragma once

#include <vector>

#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/time/contact.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// Contact at the end of steps that solve equations: balance under known contact forces and contact
/// by the equations' present factors, in turns [M.87]. Exact factors, as of linear models, need
/// two.
class ContactTurns final : private Compliance {
 public:
  static constexpr int most = 50;  // before a step fails

  /// Free coordinates and solver must outlive it; the solver's factors are those of the equations.
  ContactTurns(const FreeCoordinates& free, LinearSolver& solver) : free_(free), solver_(solver) {}

  /// A step begins. `contact`: null: nothing presses. What the coordinates bear at the begin
  /// (`force`, dofs) is the first guess.
  void begin(Contact* contact, const std::vector<double>& force);
  /// How a force of the step's end enters the equations, and how far an unknown moves its
  /// coordinate.
  void weigh(double load, double move);
  /// The factors are others now.
  void forget() {
    known_.assign(touched_.size(), 0);
    ++version_;
  }
  /// Adds the forces [N] (dofs).
  void add_to(Vector& external) const;
  /// Forces for where the balance without change of them has led, q [m] (dofs); takes a part of
  /// their change to the unknowns x (free) too. `change`: [N] of all. False: there is no answer.
  [[nodiscard]] bool press(double time, const Vector& q, int turn, Vector& x, double& change);
  /// Whether the last change moved x by no more than the rounding of places: of surfaces that just
  /// touch, forces are that rounding, and never settle to small parts of it.
  bool rounded() const { return rounded_; }

 private:
  const Vector* column(int k) override;
  bool apply(const Vector& force, Vector& moved) override;
  std::size_t version() const override { return version_; }
  void relax(int turn);

  const FreeCoordinates& free_;
  LinearSolver& solver_;
  Contact* contact_ = nullptr;
  std::vector<int> touched_;     // its coordinates
  Vector force_, pose_;          // [N], [m] without it (contact)
  Vector moved_by_;              // [m] (contact)
  Vector unit_, answer_;         // (free)
  std::vector<Vector> columns_;  // [m/N] (contact) of the compliance
  std::vector<char> known_;      // (contact) which of them
  std::size_t version_ = 0;      // of all of them
  double load_ = 0.0, move_ = 0.0;
  Vector change_, last_change_;  // [N] (contact) that contact asked for, in this turn and before
  double factor_ = 1.0;          // of the change that is taken
  bool rounded_ = false;
};

}  // namespace abut
