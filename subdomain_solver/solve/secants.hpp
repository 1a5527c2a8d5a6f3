#pragma once

#include <array>
#include <cstddef>

#include "subdomain_solver/model.hpp"

namespace abut {

/// What the last steps of an iteration with one factor have shown of the tangent, which corrects
/// those after them (limited memory BFGS; J. Nocedal, 1980).
class Secants {
 public:
  void clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  /// A step [m] changed the internal forces by so much [N]. One that shows no stiffness is left
  /// out.
  void add(const Vector& step, double part, const Vector& before, const Vector& after);
  /// Solves for the step [m] of a rest [N]; `solve(b, x)` has the factor. False: it has no answer.
  template <class Solve>
  [[nodiscard]] bool solve(const Vector& rest, Vector& step, const Solve& solve);

 private:
  static constexpr std::size_t most = 6;
  struct Pair {
    Vector step, change;
    double inverse = 0.0;  // [1/J] of their product
    double share = 0.0;
  };
  Pair& pair(std::size_t k) { return pairs_[(first_ + k) % most]; }

  std::array<Pair, most> pairs_;
  std::size_t first_ = 0, count_ = 0;
  Vector left_;
};

template <class Solve>
bool Secants::solve(const Vector& rest, Vector& step, const Solve& solve) {
  if (count_ == 0) return solve(rest, step);
  left_ = rest;
  for (std::size_t k = count_; k-- > 0;) {
    Pair& p = pair(k);
    p.share = p.inverse * p.step.dot(left_);
    left_ -= p.share * p.change;
  }
  if (!solve(left_, step)) return false;
  for (std::size_t k = 0; k < count_; ++k) {
    Pair& p = pair(k);
    step += (p.share - p.inverse * p.change.dot(step)) * p.step;
  }
  return true;
}

}  // namespace abut
