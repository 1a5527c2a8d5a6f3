#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "contract/outcome.hpp"
#include "subdomain_solver/fe/fe_model.hpp"
#include "subdomain_solver/port_map.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// The midpoint rule with a diagonal mass, under impulses [M.128]: the minimum of an incremental
/// potential, by Newton's method with definite tangents and a line search, so that a step has an
/// answer wherever the law has one. The unknown is the change of velocity: small steps lose nothing
/// to round-off, and momentum is that of the impulses. A linear body is solved with one
/// factorisation per length of step. Of other bodies it begins at the free step from the same
/// state, with its tangent: both are kept while the state is tried under one impulse after the
/// other, and depend on the state alone; or, where it is told to, at the answer to the impulse
/// before, with the tangent of that. Loads that follow the body are those of the place to which
/// it would go freely.
class MidpointStep {
 public:
  struct Body {
    const Problem* problem = nullptr;
    FeModel* cells = nullptr;        // whose tangents are made definite; null: the model is linear
    Vector mass;                     // [kg] (dofs)
    std::vector<const Load*> loads;  // its own, with this mass
    double noise = 0.0;              // [J] of rounding in its stored energy
    // It ends in the middle, where its forces balance, and rests there: without inertia, but for a
    // mass that holds what nothing else does [M.154].
    bool rests = false;
  };

  /// What is referred to must outlive it.
  explicit MidpointStep(Body body);

  const Vector& mass() const { return body_.mass; }
  /// Of a body that rests: its mass in what follows is 4^-looser of what it is.
  void loosen(int looser);
  /// Whether what follows is the last step once more, under another impulse.
  void go_on_from_last(bool again) { again_ = again; }
  /// From `begin` to `end`. Forces of supports [N], means over the step, are left in motion.force.
  /// When it fails the motion is as before.
  [[nodiscard]] std::optional<Failed> step(Motion& motion, double begin, double end,
                                           const Vector& impulse);
  /// [m] (dofs) by which the last step moved the coordinates.
  const std::vector<double>& moved() const { return moved_; }
  /// [N] (dofs) that its mass bore in it, as a mean, and what acted beside.
  Vector borne() const { return mass_.cwiseProduct(change_) / length_; }
  Vector acting() const { return given_ / length_; }
  /// Compliance [M.129] of some values of the ports after a step, (values, values) row by row.
  /// False: there is none.
  [[nodiscard]] bool compliance(const Motion& motion, const PortMap& ports,
                                const std::vector<std::size_t>& values, std::vector<double>& out);
  /// The diagonal (values) of one that is nowhere smaller, of a body with inertia: what its mass
  /// alone would answer.
  void bound(const Motion& motion, const PortMap& ports, const std::vector<std::size_t>& values,
             std::vector<double>& out);

 private:
  struct Factors {
    double length = 0.0;  // [s] of a linear body
    std::unique_ptr<LinearSolver> solver;
    std::map<std::size_t, std::vector<double>> columns;  // by value of the ports: (port values)
    bool made = false;
  };
  /// What a body of another law does from a state without impulses.
  struct FreeStep {
    double start = 0.0, end = 0.0;      // [s]
    std::vector<double> q, v, history;  // the state
    Vector change;                      // [m/s] (dofs)
    std::optional<Failed> failed;
    Factors factors;  // of the tangent there, when first needed

    bool is_of(const Motion& motion, double from, double until) const;
  };

  void begin(const Motion& motion, double start, const Vector& impulse);
  void follow(const Motion& motion);
  [[nodiscard]] bool respond(const Motion& motion);
  double potential();
  double residual();
  double roundoff();
  [[nodiscard]] std::optional<Failed> solve_linear(const Motion& motion);
  [[nodiscard]] std::optional<Failed> solve(const Motion& motion, const Vector& impulse);
  void find_free_step(const Motion& motion);
  [[nodiscard]] bool go_on(const Motion& motion);
  [[nodiscard]] std::optional<Failed> solve_from_begin(const Motion& motion);
  [[nodiscard]] std::optional<Failed> iterate(const Motion& motion);
  [[nodiscard]] bool correct(const Motion& motion, bool afresh);
  enum class Search { moved, ended, stuck };
  [[nodiscard]] Search search(const Motion& motion, double slope);
  [[nodiscard]] bool factor(std::span<const double> history, Factors& factors);
  Factors* factors();
  [[nodiscard]] std::optional<Failed> finish(Motion& motion, const Vector& impulse);
  std::optional<Failed> rest(Motion& motion, const Vector& impulse);
  [[nodiscard]] bool find_columns(const Motion& motion, const PortMap& ports, LinearSolver& solver,
                                  std::span<const std::size_t> values,
                                  std::vector<std::vector<double>>& columns);

  Body body_;
  FreeCoordinates free_;
  Vector mass_;     // [kg] (dofs) in a step
  int looser_ = 0;  // than that of the body
  struct Gone {     // supports of a body that rests, from one instant [s] to another
    double start = 0.0, end = 0.0;
    std::vector<double> way;  // [m] (coordinates)
  } gone_;
  std::vector<Factors> factors_;  // of the last lengths, the last one used at the end
  FreeStep unpushed_;
  Factors own_;                            // of a step under impulses
  std::map<std::size_t, double> by_mass_;  // [1/kg] bound() of values of the ports
  Vector answer_;  // [m/s] (dofs) to the last impulse, from the state of the free step
  bool again_ = false, answered_ = false;
  bool balanced_ = false;  // as well as rounding allows, at the end of the last search
  // Of the two, those of the last correction, and those that the next tangent goes to.
  Factors *present_ = nullptr, *next_ = nullptr;
  SparseMatrix inertia_, tangent_, matrix_;
  ModelResponse response_, curved_;
  // Of one step:
  double start_ = 0.0, end_ = 0.0, length_ = 0.0;  // [s]
  Vector change_, given_;                          // [m/s], [kg m/s] (dofs)
  Vector loads_;                                   // [N] (dofs)
  std::vector<double> held_;                       // [m] (supports) by which they move
  std::vector<double> middle_, last_, moved_;      // [m] (dofs)
  Vector left_, correction_, before_;              // [kg m/s], [m/s] (free), [m/s] (dofs)
  double reached_ = 0.0, rounding_ = 0.0;          // [J] potential, and its rounding
  double part_ = 1.0;                              // of a correction that was taken
};

}  // namespace abut
