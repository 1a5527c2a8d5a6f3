#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "base/archive.hpp"
#include "contract/outcome.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/solve/secants.hpp"
#include "subdomain_solver/time/contact.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// The coordinates of a model that have no mass: wherever the others are, these lie where their
/// forces balance [M.85], and what presses on them is solved for there [M.86]. Of a nonlinear model
/// the factors are those of a tangent that serves as long as it leads on, over windows too; the
/// place that it belongs to is part of the body's state, so that replies depend on state and
/// request alone, whatever factors there are (docs/adr/0041).
class MasslessLayer final : private Compliance {
 public:
  /// The problem must outlive it.
  explicit MasslessLayer(const Problem& problem);

  bool empty() const { return dofs_.empty(); }
  const std::vector<int>& dofs() const { return dofs_; }
  /// Where the tangent in use was made, of nonlinear models.
  void state(Archive& archive);
  /// The next tangent is made anew: where it was made says nothing of where the body is now.
  void release();
  /// The model is another one.
  void forget();
  /// Moves the layer of `q` to balance at a time, under `loads` [N] (dofs; empty: none) and what
  /// `contact` presses (null: nothing). Other coordinates stay.
  [[nodiscard]] std::optional<Failed> settle(double time, std::vector<double>& q,
                                             std::span<const double> history, const Vector& loads,
                                             Contact* contact);
  /// Leads the layer of `next` [m] (dofs), the place at a step's end as velocities have it, to
  /// where the accelerations of what is near it lead: the balance is found sooner.
  void lead(const Motion& motion, double dt, std::vector<double>& next);
  /// What the balance left is handed to coordinates with mass, of the model's forces [N] (dofs) at
  /// the place that was found: momentum stays to round-off, whatever the balance's tolerance.
  void complete(Vector& force);
  /// The forces on the layer change by `change` [N] (dofs) at once: it moves, and the body's answer
  /// with it, by `answer` [N] (dofs).
  [[nodiscard]] std::optional<Failed> jump(double time, Motion& motion, const Vector& change,
                                           Vector& answer);
  /// Compliance of one of its coordinates [m/N] at q.
  double compliance(std::span<const double> q, std::span<const double> history, int dof);

 private:
  struct Factors {
    std::unique_ptr<LinearSolver> solver;
    std::vector<double> place;  // that they belong to: coordinates, then history
    bool hold = false;
    std::vector<Vector> columns;  // [m/N] (contact) of the compliance
    std::vector<char> known;      // (contact) which of them
  };

  const Vector* column(int k) override;
  bool apply(const Vector& force, Vector& moved) override;
  std::size_t version() const override { return version_; }
  bool linear() const { return problem_.model->is_linear(); }
  Factors& factors() { return kept_[used_]; }
  [[nodiscard]] bool respond(std::span<const double> q, std::span<const double> history,
                             Model::Want want);
  [[nodiscard]] std::optional<Failed> make_factors(double time, std::span<const double> q,
                                                   std::span<const double> history);
  [[nodiscard]] std::optional<Failed> find_factors(double time);
  [[nodiscard]] std::optional<Failed> renew_factors(double time, std::span<const double> q,
                                                    std::span<const double> history);
  void make_room();
  bool use_kept();
  void gather(std::span<const double> q, std::span<const double> history);
  double roundoff(std::span<const double> q) const;
  void use(std::size_t kept);
  void find_places(const Contact& contact);
  [[nodiscard]] bool press(double time, std::span<const double> q, Contact& contact);
  double find_rest(const Vector& loads, bool pressed);
  [[nodiscard]] bool walk(std::vector<double>& q, std::span<const double> history,
                          const Vector& loads, bool pressed);
  double move(std::vector<double>& q, double part);

  const Problem& problem_;
  std::vector<int> dofs_;
  LayerResponse response_;
  std::vector<double> place_;        // of the tangent in use; empty: none yet
  std::array<Factors, 2> kept_;      // bodies go back to where they had others
  std::size_t used_ = 0;             // of these
  bool certain_ = false;             // they are those of place_
  std::vector<double> q_, history_;  // of the whole model, at place_
  Secants secants_;                  // of this substep
  Vector step_, rest_,
      forces_before_;  // [m], [N] (layer); forces before the step
  Vector asked_;       // [N] (layer) that acts on it
  double part_ = 0.0,
         largest_ = 0.0;                // of the step; [m] displacement that results
  Vector free_, pressed_, moved_by_;    // [m], [N], [m] (contact)
  std::vector<int> touched_;            // the contact's coordinates
  std::vector<int> contact_place_;      // of them in the layer; -1: prescribed
  std::size_t version_ = 0;             // of all columns
  Vector unit_, answer_;                // (layer)
  std::unique_ptr<LinearSolver> here_;  // of compliance()
  std::vector<double> moved_;           // [m] (dofs) by a jump
  Vector loads_;                        // [N] (dofs) after it
  ModelResponse whole_;
};

}  // namespace abut
