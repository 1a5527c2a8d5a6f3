#pragma once

#include <array>
#include <span>
#include <vector>

#include "subdomain_solver/mass_form.hpp"

namespace abut {

/// How the contact node's mass is treated (docs/METHOD.md, contact layer).
enum class ContactLayer {
  none,      // no port at this end
  massless,  // mass of the end element moved to its inner node: the port follows quasi-statically
  kick,      // massive node, contact impulse to the velocities at the substep's start
  massive,   // massive node as in the published scheme
  shared,    // massive node of an implicit bar whose reaction is complete: tied ends only
};

/// What a uniform bar of two-node elements is made of.
struct BarProperties {
  double length = 0.0;  // [m]
  double area = 0.0;    // [m^2]
  int elements = 0;
  double youngs_modulus = 0.0;  // [Pa]
  double density = 0.0;         // [kg/m^3]
  double position = 0.0;        // [m] reference coordinate of the left end
  double velocity = 0.0;        // [m/s] at the start
  double body_force = 0.0;      // [m/s^2] force per mass
  MassForm mass = MassForm::lumped;
  double stiffness_factor = 1.0;  // of the contact element behind a massless port, kappa
  std::array<bool, 2> fixed = {false, false};  // left, right end
  std::array<ContactLayer, 2> layer = {ContactLayer::none, ContactLayer::none};
  // Of massive contact nodes: their acceleration is dropped after every substep in contact.
  bool stabilised = false;
  // Of massive contact nodes: the reaction to prescribed motion holds the node's inertia.
  bool complete_reaction = false;
  double bulk_viscosity = 0.0;  // damping ratio at the grid's cut-off, explicit bars
  double tchamwa = 1.0;         // phi of Tchamwa and Wielgosz, explicit bars

  double wave_speed() const;  // sqrt(E / rho) [m/s]
  double impedance() const;   // rho c A [kg/s]
  double mass_total() const;  // [kg]
};

/// A bar discretised: stiffness per element and mass rows, with the contact layers built in. All
/// arrays are by node, left to right, or by element.
class Bar {
 public:
  explicit Bar(const BarProperties& data);

  const BarProperties& data() const { return data_; }
  int nodes() const { return data_.elements + 1; }
  double spacing() const { return data_.length / data_.elements; }  // [m]
  double element_stiffness() const { return element_stiffness_; }   // E A / h [N/m], interior
  double element_mass() const { return element_mass_; }             // rho A h [kg], interior

  const std::vector<double>& stiffness() const { return stiffness_; }  // [N/m] (elements)
  const std::vector<double>& mass() const { return mass_; }            // [kg] (nodes) diagonal
  // [kg] (elements) off-diagonal
  const std::vector<double>& mass_beside() const { return mass_beside_; }
  const std::vector<double>& row_mass() const { return row_mass_; }  // [kg] (nodes) row sums
  // [1/kg] of the row sums; 0: no motion
  const std::vector<double>& inverse_mass() const { return inverse_mass_; }

  bool lumped() const { return data_.mass == MassForm::lumped; }
  int node_of(int end) const { return end == 0 ? 0 : nodes() - 1; }
  double place_of(int node) const {  // [m] in the reference
    const double along = node < data_.elements ? node * spacing() : data_.length;
    return data_.position + along;
  }
  int inner_of(int end) const { return end == 0 ? 1 : nodes() - 2; }
  static double outward(int end) { return end == 0 ? -1.0 : 1.0; }

  /// Largest step for which central difference with the row-sum mass is stable [s]: 2 / omega with
  /// omega^2 the Gershgorin bound of M^-1 K, on a uniform bar exactly h / c, and less with bulk
  /// viscosity.
  double stable_step() const;

  /// Internal force K x [N] (nodes).
  void internal_force(std::span<const double> x, std::vector<double>& out) const;

  double kinetic(const std::vector<double>& v) const;   // [J] 1/2 v M v
  double stored(const std::vector<double>& x) const;    // [J] 1/2 x K x
  double momentum(const std::vector<double>& v) const;  // [kg m/s]

 private:
  void build_mass();

  BarProperties data_;
  double element_stiffness_;
  double element_mass_;
  std::vector<double> stiffness_, mass_, mass_beside_, row_mass_, inverse_mass_;
};

}  // namespace abut
