#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/index.hpp"
#include "subdomain_solver/bars/bar.hpp"

namespace abut {

/// On which element lengths mass and stiffness are assembled. `current` does it anew in every step,
/// as some published comparisons of contact methods did: an element of length l has the mass
/// rho A l, the stiffness E A / l and, since every step adds stiffness times stretch, the tension
/// E A ln(l / h). At finite strain that is neither the linear bar nor one that conserves mass
/// (docs/METHOD.md, conventional methods).
enum class ElementLengths { reference, current };

/// Two bars as one system: the nodes of the left bar, then those of the right one, left to right.
/// The tips that may touch are neighbours in this numbering, and no element joins them: matrices of
/// the whole are tridiagonal.
class BarPair {
 public:
  BarPair(const BarProperties& left, const BarProperties& right, ElementLengths lengths);

  const Bar& bar(int member) const { return bars_[member]; }
  std::size_t nodes() const { return mass_.size(); }
  std::size_t first(int member) const { return member == 0 ? 0 : split_; }
  std::size_t last(int member) const { return member == 0 ? split_ - 1 : nodes() - 1; }
  /// Node that may touch the other bar.
  std::size_t tip(int member) const { return member == 0 ? split_ - 1 : split_; }
  ElementLengths lengths() const { return lengths_; }

  const std::vector<double>& stiffness() const { return stiffness_; }      // [N/m] (nodes - 1)
  const std::vector<double>& mass() const { return mass_; }                // [kg] (nodes) diagonal
  const std::vector<double>& mass_beside() const { return mass_beside_; }  // [kg] (nodes - 1)

  double reference_gap() const { return reference_gap_; }  // [m]
  double gap(const std::vector<double>& u) const {
    return reference_gap_ + (u[tip(1)] - u[tip(0)]);
  }

  /// Assembles anew on the current lengths, where that is asked for. False: an element has no
  /// length left.
  bool follow(const std::vector<double>& u);
  /// Largest stable step of central difference on the reference lengths [s], with a contact spring
  /// [N/m] between the tips: 2 / omega with the Gershgorin bound of M^-1 K.
  double stable_step(double contact_stiffness) const;

  /// [N]; on current lengths `u` is what follow() was told last.
  void internal_force(const std::vector<double>& u, std::vector<double>& out) const;
  void apply_mass(const std::vector<double>& x, std::vector<double>& out) const;

  // Of one of the bars:
  double stress(int member, std::size_t element, const std::vector<double>& u) const;  // [Pa]
  double mass_norm(int member, const std::vector<double>& x) const;                    // x M x
  double stored(int member, const std::vector<double>& u) const;    // [J] 1/2 tension^2 / stiffness
  double momentum(int member, const std::vector<double>& v) const;  // [kg m/s]

 private:
  void assemble_mass();
  double tension(std::size_t element, const std::vector<double>& u) const {
    if (lengths_ == ElementLengths::current) return tension_[element];
    return stiffness_[element] * (u[element + 1] - u[element]);
  }

  std::array<Bar, 2> bars_;
  ElementLengths lengths_;
  std::size_t split_;  // nodes of the left bar
  double reference_gap_;
  std::vector<double> stiffness_, element_mass_, tension_;  // by element; 0 between the tips
  std::vector<double> mass_, mass_beside_;
};

}  // namespace abut
