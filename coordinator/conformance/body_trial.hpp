#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "contract/subdomain.hpp"

namespace abut {

/// A clause of the contract that a body does not keep: what it does, and where to look.
class BrokenClause : public std::runtime_error {
 public:
  BrokenClause(std::string does, std::string look)
      : std::runtime_error(does), what_it_does(std::move(does)), where_to_look(std::move(look)) {}

  std::string what_it_does;
  std::string where_to_look;
};

/// A constant force on all points of a port along one axis, or a course of it.
struct Push {
  int port = 0;
  Waveform force;  // [N] on all points
};

/// A body on trial: asked for windows from where it stands, as a coordinator asks. Knows the time.
class BodyTrial {
 public:
  /// `length` [s] of a window of a body that has no step of its own; `begin` [s] of the first.
  BodyTrial(Subdomain& body, double begin, double length);

  const Description& about() const { return body_.describe(); }
  Subdomain& body() { return body_; }
  double now() const { return now_; }
  /// [s] of a substep.
  double step() const { return step_; }
  /// [s] of a window of a few substeps.
  double length() const { return length_; }

  /// Advances by so much [s]. Throws BrokenClause where the body fails to.
  Response window(double length, const std::vector<Push>& pushes = {}, int records = 1);
  void save();
  void restore();
  /// From the saved state, which is returned to first.
  Response again(double length, const std::vector<Push>& pushes = {});

  /// [N] on every point that move the port by a ten-thousandth of its size in a window; 0: the port
  /// takes no forces, or nothing moves it.
  double light_force(int port);
  /// That force along an axis over a window that begins now.
  Push push(int port, int axis, double length, double force) const;
  /// Of forces [N] on every value of a port, over a window that begins now.
  Push push(int port, double length, const std::vector<double>& forces) const;

 private:
  double find_light_force(int port);

  Subdomain& body_;
  double now_, saved_at_ = 0.0;
  std::int64_t index_ = 0, saved_index_ = 0;
  double step_, length_;
  std::vector<double> light_;  // by port; negative: not known yet
};

/// Of a number, of its size.
inline constexpr double one_rounding = std::numeric_limits<double>::epsilon();

/// Of the size of a port, by which light forces move it in a window.
inline constexpr double light_way = 1.0e-4;

/// What clauses say of a body whose ports no force moves.
inline constexpr const char* not_moved = "no force moves its ports";

/// Why no force can be tried at any port; empty: it can.
std::string why_no_force(BodyTrial& trial);

/// [m] a typical size of a port: distance of its mesh's nodes, or its extent.
double size_of_port(const PortGeometry& surface);

/// The first thing in which two replies differ, in words; empty: they are the same bits.
std::string first_difference(const Response& one, const Response& other, const Description& body);

}  // namespace abut
