#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "abut.h"
#include "base/archive.hpp"
#include "contract/outcome.hpp"
#include "sdk/served/parts.hpp"

namespace abut {

/// A user's body with what the contract wants beside it: what is not told follows from what is, and
/// the state is one thing. Arrays are of the points of all ports, one port after the other.
class UserBody {
 public:
  /// The body is filled. Throws InputError for what is missing or cannot be.
  UserBody(const abut_body& body, const abut_parts& parts);
  UserBody(const UserBody&) = delete;
  UserBody& operator=(const UserBody&) = delete;
  ~UserBody();

  const abut_body& told() const { return body_; }
  std::span<const Port> ports() const { return parts_.ports; }
  std::size_t width(std::size_t port) const { return parts_.ports[port].geometry.points.size(); }
  std::size_t first(std::size_t port) const { return first_[port]; }  // of its values
  std::size_t values() const { return first_.back(); }
  ForceSupport support() const {
    return body_.quasi_static != 0 ? ForceSupport::nodal : ForceSupport::step;
  }

  /// Advances by dt [s] under forces [N] (values). Null, or why it could not be.
  const char* step(double dt, const std::vector<double>& force);
  const std::vector<double>& displacement() const { return own_.u; }  // [m]
  const std::vector<double>& velocity() const { return own_.v; }      // [m/s]
  const std::vector<double>& acceleration() const { return own_.a; }  // [m/s^2] over the step
  const std::vector<double>& rate() const { return own_.rate; }       // [m/s] way over time
  const std::vector<double>& force() const { return own_.force; }     // [N] of the last step
  const std::vector<double>& work() const { return work_; }  // [J] by port, of the last step

  BodyRecord record(double time) const;
  double speed_bound() const;         // [m/s]
  double acceleration_bound() const;  // [m/s^2]
  /// Into the state from which kernels are found.
  void rest();

  /// All that steps change.
  struct State {
    std::vector<double> user;                  // of the user's body
    std::vector<double> u, v, a, rate, force;  // (values)

    void state(Archive& archive);
  };
  State snapshot() const;
  void return_to(const State& state);

 private:
  void look();
  void take(const char* name, std::vector<double>& to) const;
  void work_of_way(const State& before);
  std::vector<double> mean_velocity() const;
  Energy energy() const;
  std::vector<double> momentum() const;
  bool stands() const;
  const abut_parts::State* named(const char* name) const;
  void require_whole() const;

  abut_body body_;
  const abut_parts& parts_;
  std::vector<std::size_t> first_;
  State own_;  // without the user's
  std::vector<double> work_;
  bool glides_ = false;  // without inertia, its velocity is way over time
};

}  // namespace abut
