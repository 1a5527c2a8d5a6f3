#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/archive.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// What observers need to know of an interface that does not change during a run.
struct InterfaceInfo {
  std::string name;
  int body[2] = {0, 0};      // index into RunStart::bodies
  int port[2] = {0, 0};      // index into Description::ports
  double initial_gap = 0.0;  // [m] 1D: normal distance of the reference positions
  bool tied = false;         // joined from the start, for the whole run
  int partner[2] = {0, 0};   // number of the other side among those that the port meets
  bool many = false;         // of any two surfaces: it has pairs in place of bodies and ports
};

struct RunStart {
  double begin = 0.0, end = 0.0;           // [s]
  std::vector<const Description*> bodies;  // in the scene's order
  std::vector<InterfaceInfo> interfaces;   // in the scene's order
};

/// One interface in one accepted window.
struct InterfaceReport {
  bool closed = false;    // iterated in this window; contact may have come and gone in it
  int kinematic = 0;      // which side (0 or 1) is kinematic; meaningful when closed
  int iterations = 0;     // Schwarz iterations of its island; 0: advanced free
  double residual = 0.0;  // largest scaled residual over the exchanged fields when accepted
  // Of tied surfaces: [m] by how much they missed each other, [N] the largest resultant between
  // them.
  double missed = 0.0, force = 0.0;
  double dissipated = 0.0;  // [J] by friction since the run began
};

/// Two surfaces that were iterated in an accepted window, of an interface of many.
struct PairReport {
  int interface = 0;                       // index into RunStart::interfaces
  int body[2] = {0, 0}, port[2] = {0, 0};  // as of an InterfaceInfo
  int partner[2] = {0, 0};
  int kinematic = 0;        // which side is
  double dissipated = 0.0;  // [J] by friction since the run began
};

/// An accepted stretch of time: one window, or several windows of free flight in one request.
/// All bodies hold the same number of records at the same times.
struct WindowReport {
  TimeWindow window;
  std::span<const Response> responses;          // by body
  std::span<const InterfaceReport> interfaces;  // by interface
  std::int64_t windows = 0;                     // accepted so far, these included
  std::span<const PairReport> pairs = {};       // of interfaces of many
};

/// Something that happened at a time.
struct RunEvent {
  enum class Kind { contact_closed, contact_opened, swap, failure, warning };
  Kind kind = Kind::warning;
  double time = 0.0;                     // [s]; for contact: located inside a window
  std::string subject;                   // interface or body name
  std::string text;                      // one sentence for people
  std::map<std::string, double> values;  // e.g. closing_speed, growth
  bool thrown = false;                   // the error that ends the program says it on the terminal
};

const char* to_string(RunEvent::Kind kind);

/// A body that goes on as another model or on another mesh.
struct Swap {
  double time = 0.0;  // [s]
  std::string body, from, to;
  std::array<double, 2> mass{};  // [kg] before and after, by the meshes
  BodyRecord before, after;      // energies and momenta
  /// [J] of energy that it has no more; negative: work that was added.
  double given_up() const { return before.energy.total() - after.energy.total(); }
  void state(Archive& archive);
};

/// Two bodies that are in the same place, of which no body can be.
struct Overlap {
  int body[2] = {0, 0};                           // index into RunStart::bodies
  double depth = 0.0;                             // [m]
  std::array<double, 3> place = {0.0, 0.0, 0.0};  // [m] where it is deepest
  double time = 0.0;                              // [s] at which it was found
};

/// What passive windows cost.
struct GivenUp {
  bool statics = false;  // no body has inertia: what contact takes then is no loss of motion
  // of passive windows all, those in which steps were halved, in which bodies were held rigid
  std::int64_t windows = 0, halved_windows = 0, rigid_windows = 0;
  std::int64_t unanswered = 0;    // times that the accurate method had no answer
  std::int64_t near_windows = 0;  // of it that have nearly converged, and were accepted
  double missed = 0.0;            // most of the residual in such a window
  std::int64_t steps = 0, refused = 0, rigid = 0;
  double shortest_step = 0.0;  // [s]
  std::int64_t unsettled = 0;  // steps of statics after which bodies did not rest yet
  double unbalanced = 0.0;     // most that such a step left, over the most that any began with
  // [J] lost in normal contact, of it between rigid bodies; by friction, by damping, at changes of
  // form; given to part bodies
  double normal = 0.0, impacts = 0.0, friction = 0.0, damped = 0.0, switched = 0.0, push_out = 0.0;
  double taken_back = 0.0;  // [J] that passive steps gave bodies beside contact, and took again
  double owed = 0.0;        // [J] of normal that what touches at the end gives back as it parts
  double repaid = 0.0;   // [J] that accurate windows gained and that was taken back at their ends
  double deepest = 0.0;  // [m] behind a partner's surface
  // [J] the largest kinetic and stored energy of the run, or all that went into it where that is
  // more: loads may put in again what contact takes
  double largest = 0.0;
  // By body, as long as one has any: [J] lost in its normal contact, and by damping and changes of
  // form; steps that it refused.
  std::vector<double> lost = {}, taken = {}, refused_by = {};

  double joules() const { return normal - push_out + damped + switched; }
};

struct RunEnd {
  std::string status;       // completed | failed | interrupted
  std::string reason = {};  // why it failed, in words; else empty
  double time = 0.0;        // [s] how far the run came
  // over bodies and coordinator, equal in every placement; empty: the bodies were gone
  std::optional<std::uint64_t> state_hash = {};
  std::vector<std::uint64_t> body_hashes = {};  // by body: those of the bodies alone
  std::int64_t windows = 0;                     // accepted
  std::int64_t contact_windows = 0;             // accepted with a closed interface
  std::int64_t exchanges = 0;                   // requests answered by bodies, kernels included
  double wall_seconds = 0.0;                    // first window to last
  std::vector<double> compute_seconds = {};     // by body
  // by body, in the order of its Description::measures; empty where the run did not come to its end
  std::vector<std::vector<double>> body_measures = {};
  double overhead_median_seconds = 0.0;     // per exchange: wall minus compute
  std::vector<Overlap> overlaps = {};       // that were found, each pair once
  std::vector<std::string> never_met = {};  // interfaces that never closed where they should have
  GivenUp given_up = {};
};

/// A customer of a run: log, table, summary, monitor. Never changes what the run computes.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Name of its part of a checkpoint; empty: it has none.
  virtual std::string_view kept_as() const { return {}; }
  /// All that it has gathered of the windows so far; read after on_start of a resumed run.
  virtual void state(Archive&) {}
  virtual void on_start(const RunStart&) {}
  virtual void on_window(const WindowReport&) {}
  /// Events of a window come before it or after it, and before the next one.
  virtual void on_event(const RunEvent&) {}
  /// Before the first window after it.
  virtual void on_swap(const Swap&) {}
  virtual void on_end(const RunEnd&) {}
};

}  // namespace abut
