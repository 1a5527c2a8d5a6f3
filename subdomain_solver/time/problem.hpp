#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/model.hpp"

namespace abut {

/// Forces that act on a body, as a function of time and place.
class Load {
 public:
  virtual ~Load() = default;
  /// Adds the nodal forces [N] (dofs) at a time and coordinates q.
  virtual void add(double time, std::span<const double> q, Vector& force) const = 0;
  /// Whether the forces depend on q; dead ones do not look at it.
  virtual bool follows() const { return true; }
  /// Adds -df/dq to the tangent, for loads that follow the body. Its pattern is the model's.
  virtual void add_tangent(double, std::span<const double>, SparseMatrix&) const {}
};

/// A coordinate whose value is given.
struct Prescribed {
  int dof = 0;
  std::function<double(double)> value;  // [m] of time [s]
};

class Contact;

/// A model with what acts on it.
struct Problem {
  Model* model = nullptr;
  Contact* contact = nullptr;        // null: nothing may press on it now
  std::vector<Prescribed> supports;  // one per coordinate at most, sorted by dof
  std::vector<std::unique_ptr<Load>> loads;

  /// [N] (dofs); good until it is asked for again.
  const Vector& external_force(double time, std::span<const double> q) const;
  /// Velocities and accelerations of prescribed coordinates at the start, by differences of second
  /// order over thousandths of a step [s] and over steps: others would make an implicit scheme
  /// ring.
  void set_rates(double time, double step, Motion& motion) const;
  /// Accelerations of prescribed coordinates by differences over a step [s] to both sides of the
  /// time: those of central differences. To one side where an expression has no value on the other.
  void set_accelerations(double time, double step, Vector& acceleration) const;

 private:
  mutable Vector external_;
};

/// Free and prescribed coordinates, and the rows and columns of a matrix that belong to free ones.
class FreeCoordinates {
 public:
  /// `without`: others that are not free.
  FreeCoordinates(int dofs, const std::vector<Prescribed>& supports,
                  const std::vector<int>& without = {});

  int count() const { return static_cast<int>(free_.size()); }
  const std::vector<int>& list() const { return free_; }
  int place(int dof) const { return place_[dof]; }  // among the free ones; -1: it is none
  void pick(const Vector& all, Vector& free) const;
  void add(const Vector& free, Vector& all) const;
  void extract(const SparseMatrix& all, SparseMatrix& free);

 private:
  std::vector<int> free_;           // dofs
  std::vector<int> place_;          // (dofs) among the free ones, or -1
  std::vector<Eigen::Index> from_;  // of each entry of the extracted matrix
  Eigen::Index entries_ = -1;       // of the matrix that from_ belongs to
};

}  // namespace abut
