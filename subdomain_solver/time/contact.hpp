#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/model.hpp"

namespace abut {

/// How the coordinates that contact may press on give way.
class Compliance {
 public:
  virtual ~Compliance() = default;
  /// [m/N] (contact's coordinates) displacements by a unit force on the k-th of them; good until
  /// the step's end. Null: there is no answer.
  virtual const Vector* column(int k) = 0;
  /// [m] (contact's coordinates) displacements by forces [N] on all of them at once: what as many
  /// columns as are pressed would make, by one solution. False: there is no answer.
  [[nodiscard]] virtual bool apply(const Vector& force, Vector& moved) = 0;
  /// Another number whenever columns are others, within a step.
  virtual std::size_t version() const = 0;
};

/// Adds to `places` [m] (contact's coordinates) `sign` times what forces [N] on them move: column
/// by column, and of very many by one solution. `buffer`: memory. False: there is no answer.
[[nodiscard]] bool add_given_way(Compliance& give, double sign, const Vector& force, Vector& buffer,
                                 Vector& places);

/// What may press on some coordinates of a body at the end of a step. Every scheme is affine in
/// such forces, x = free + compliance * force (the port line, [M.86]); who owns the geometry solves
/// for them.
class Contact {
 public:
  virtual ~Contact() = default;
  /// The coordinates that may be pressed, ascending.
  virtual const std::vector<int>& coordinates() const = 0;
  /// The forces [N] (coordinates) at a time, where the coordinates [m] would lie at `free` without
  /// them and give way by `give`; good until the next call. Null: none were found.
  virtual const Vector* solve(double time, const Vector& free, Compliance& give) = 0;
  /// Why the last call found none, for people; empty: it found some, or has nothing to say.
  const std::string& missing() const { return missing_; }
  /// [m] of the last call: places nearer to each other are the same but for rounding.
  double rounding() const { return rounding_; }

 protected:
  std::string missing_;
  double rounding_ = 0.0;
};

}  // namespace abut
