#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/archive.hpp"
#include "base/worker_threads.hpp"
#include "subdomain_solver/mass_form.hpp"

namespace abut {

using Vector = Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;  // column by column, indices of 32 bits

/// What of a body changes during a step: its one state list.
struct Motion {
  std::vector<double> q, v, a;  // (dofs) coordinates and their first two derivatives in time
  std::vector<double> force;    // [N] (dofs) internal force r(q)
  std::vector<double> history;  // internal variables of the material points
  double stored = 0.0;          // [J]
  double external_work = 0.0;   // [J] done on the body by loads and prescribed motion
  double dissipated = 0.0;      // [J] by the material
  double step = 0.0;            // [s] that led here, of schemes whose energy knows it
  std::vector<double> control;  // what the integrator keeps from step to step

  void state(Archive& archive) {
    archive.field("q", q);
    archive.field("v", v);
    archive.field("a", a);
    archive.field("force", force);
    archive.field("history", history);
    archive.field("stored", stored);
    archive.field("external_work", external_work);
    archive.field("dissipated", dissipated);
    archive.field("step", step);
    archive.field("control", control);
  }
};

/// What a model answers at given coordinates.
struct ModelResponse {
  Vector force;                 // [N] (dofs) internal force r(q)
  SparseMatrix tangent;         // [N/m] dr/dq, symmetric, both halves stored
  std::vector<double> history;  // at the end of the step
  double stored = 0.0;          // [J]
  double dissipation = 0.0;     // [J] since the history it started from
};

/// What a model answers for its massless coordinates alone, in their order.
struct LayerResponse {
  Vector force;          // [N]
  SparseMatrix tangent;  // [N/m] dr/dq among them; always of one pattern
  // What else of a state it depends on, and sizes of its numbers; from the first answer on, of
  // nonlinear models.
  std::vector<int> coordinates;      // of the model, ascending
  std::vector<std::size_t> history;  // which numbers of the model's
  std::vector<int> heirs;            // (massless) coordinate with mass near each
  double size = 0.0;                 // [N] of the forces of the layer's cells on all their nodes
  double force_unit = 0.0;           // [N] of a cell at unit strain, the largest
  double gradient_unit = 0.0;        // [1/m] of a shape function, the largest
};

/// A nodal force sums up some 200 products, over cells, quadrature points and components: their
/// roundings, which are independent, add up to the root of that.
constexpr double summed_roundings = 16.0;

/// Semi-discrete body in its own coordinates q:   M q'' + r(q) = f(t)   [M.40]. Integrators see
/// nothing else of a body. The fidelity ladder is made of models under the same integrators.
class Model {
 public:
  enum class Want { force, tangent };

  virtual ~Model() = default;
  virtual int dofs() const = 0;
  virtual bool is_linear() const = 0;  // the tangent never changes: factor once
  virtual std::size_t history_size() const = 0;
  virtual const SparseMatrix& mass() const = 0;   // [kg] consistent
  virtual const Vector& lumped_mass() const = 0;  // [kg] (dofs) of the same total
  /// Threads that steps may use too; null: none.
  virtual WorkerThreads* threads() { return nullptr; }
  /// [N] size of the round-off in r(q): a balance of forces below it cannot be improved. It holds
  /// `summed_roundings` of every number.
  virtual double roundoff(std::span<const double> q) const = 0;
  /// r(q), from the history at the step's begin; the tangent when wanted. False: q is inadmissible
  /// (an inverted element, a material point without an answer), and out undefined.
  [[nodiscard]] virtual bool evaluate(std::span<const double> q, std::span<const double> history,
                                      Want want, ModelResponse& out) = 0;

  /// Coordinates without mass, ascending: the surface layer [M.85]. Usually none.
  virtual const std::vector<int>& massless() const;
  /// Of these alone, which costs as much as they are many; the tangent when wanted. False: q is
  /// inadmissible.
  [[nodiscard]] virtual bool evaluate_layer(std::span<const double> q,
                                            std::span<const double> history, Want want,
                                            LayerResponse& out);
};

/// [kg] in the form that a scheme asks for; averaged is half lumped, half consistent.
SparseMatrix mass_matrix(const Model& model, MassForm form);

}  // namespace abut
