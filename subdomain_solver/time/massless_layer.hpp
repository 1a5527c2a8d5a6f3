#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "contract/outcome.hpp"
#include "subdomain_solver/solve/linear_solver.hpp"
#include "subdomain_solver/time/contact.hpp"
#include "subdomain_solver/time/problem.hpp"

namespace abut {

/// The coordinates of a model that have no mass: wherever the others are, these lie where their
/// forces balance [M.85], and what presses on them is solved for there [M.86].
class MasslessLayer final : private Compliance {
 public:
  /// The problem must outlive it.
  explicit MasslessLayer(const Problem& problem);

  bool empty() const { return dofs_.empty(); }
  const std::vector<int>& dofs() const { return dofs_; }
  /// A window begins: factors of places before it are not used any more, as what a body answers
  /// depends on its state and the request alone.
  void renew();
  /// Moves the layer of `q` to balance at a time, under `loads` [N] (dofs; empty: none) and what
  /// `contact` presses (null: nothing). Other coordinates stay.
  [[nodiscard]] std::optional<Failed> settle(double time, std::vector<double>& q,
                                             std::span<const double> history, const Vector& loads,
                                             Contact* contact);
  /// The forces on the layer change by `change` [N] (dofs) at once: it moves, and the body's answer
  /// with it, by `answer` [N] (dofs).
  [[nodiscard]] std::optional<Failed> jump(double time, Motion& motion, const Vector& change,
                                           Vector& answer);
  /// Compliance of one of its coordinates [m/N] at q.
  double compliance(std::span<const double> q, std::span<const double> history, int dof);

 private:
  const Vector* column(int k) override;
  std::size_t version() const override { return version_; }
  [[nodiscard]] bool respond(std::span<const double> q, std::span<const double> history,
                             Model::Want want);
  [[nodiscard]] bool factor();
  void find_places(const Contact& contact);
  [[nodiscard]] bool press(double time, std::span<const double> q, Contact& contact);
  double find_rest(const Vector& loads, bool pressed);
  [[nodiscard]] bool walk(std::vector<double>& q, std::span<const double> history,
                          const Vector& loads, bool pressed);
  double move(std::vector<double>& q, double part);

  const Problem& problem_;
  std::vector<int> dofs_;
  LayerResponse response_;
  std::unique_ptr<LinearSolver> factors_;
  bool factored_ = false;              // since renew(), at some place
  bool factors_last_ = false;          // for good: the model is linear
  Vector step_, rest_;                 // [m], [N] (layer)
  double part_ = 0.0, largest_ = 0.0;  // of the step; [m] displacement that results
  Vector free_, pressed_;              // [m], [N] (contact)
  std::vector<int> touched_;           // the contact's coordinates
  std::vector<int> place_;             // of them in the layer; -1: prescribed
  std::vector<Vector> columns_;        // [m/N] (contact) of the compliance
  std::vector<char> known_;            // (contact) which of them
  std::size_t version_ = 0;            // of all of them
  Vector unit_, answer_;               // (layer)
  std::vector<double> moved_;          // [m] (dofs) by a jump
  Vector loads_;                       // [N] (dofs) after it
  ModelResponse whole_;
};

}  // namespace abut
