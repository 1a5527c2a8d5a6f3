#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "contract/boundary_data.hpp"
#include "contract/field.hpp"
#include "contract/meeting.hpp"
#include "contract/outcome.hpp"
#include "contract/passive.hpp"
#include "contract/port.hpp"
#include "contract/time_window.hpp"

namespace abut {

/// What a body can do; checked against the scene before the first window.
struct Capabilities {
  bool motion = false;     // accepts BoundaryData::motion
  bool force = false;      // accepts BoundaryData::forces
  bool obstacle = false;   // accepts BoundaryData::obstacles: may be the kinematic side
  bool impulse = false;    // accepts BoundaryData::impulse
  bool kernel = false;     // answers probe()
  bool impedance = false;  // accepts BoundaryData::impedance
  bool yielding = false;   // takes obstacles that give way: Meeting::kernel
  bool friction = false;   // takes laws with friction: FrictionLaw::rubs()
  // Takes how bodies that are tied to it respond: Meeting::kernel of its own surface.
  bool neighbours = false;
  bool passive = false;  // has a passive form: Subdomain::passive()
  // Its surface has mass: it takes obstacles in its passive form alone.
  bool only_passive = false;
  bool bands = false;  // takes kernels that are banded: PortKernel::band
};

/// A solid inside a body that tables show as if it were a body: monolithic models hold several.
struct Member {
  std::string name;
  double mass = 0.0;                // [kg]
  std::vector<std::int32_t> ports;  // indices into Description::ports of those that lie on it
};

struct Description {
  std::string name;
  std::string model;  // one line for people: "fe bar, 200 elements, central difference"
  int dim = 1;
  std::int64_t dofs = 0;
  double mass = 0.0;         // [kg]; infinity: immovable
  double step = 0.0;         // [s] nominal substep; 0: any window is one step
  double stable_step = 0.0;  // [s] limit of the nominal step; infinity: none
  // Its energy changes by port and external work alone, as its records tell: no damping, no heat.
  bool conserves = false;
  bool quasi_static = false;  // it has no inertia: its energy follows its loads step by step
  bool linear = false;        // it answers forces linearly: port kernels tell it exactly
  // Of a body without inertia whose supports leave it rigid motions: (k, dim + rotations) small
  // ones, translation [m] and rotation [rad] about the origin (one number in 2D, three in 3D) per
  // unit of each. Empty: it is held, or has inertia.
  std::vector<double> loose;
  bool stabilised = false;  // springs hold it where only contact would hold a body without inertia
  std::vector<Port> ports;
  Capabilities can;
  std::vector<Member> members;        // empty: the body is one solid
  std::vector<std::string> measures;  // names of what measure() tells, in its order
  std::vector<FieldInfo> fields;      // what fields() tells, in its order; empty: has none
  // what every record tells beside energies and momenta, with its unit: "clamp.reaction_x [N]"
  std::vector<std::string> columns;
  std::vector<double> frequencies;  // [Hz] of a body that moves in modes, ascending
};

/// Of Description::loose.
inline int loose_motions(const Description& body) {
  const int each = body.dim == 2 ? 3 : 6;
  return static_cast<int>(body.loose.size()) / each;
}

/// Which traces a response holds.
enum class Sampling {
  substeps,  // window begin and every substep: needed where an interface may close
  records,   // window begin and the records: free flight
};

/// Which fields of a port's trace are wanted, and of which points.
struct Want {
  bool u = true, v = true, a = true, f = true;
  std::vector<std::int32_t> points;  // of the port, ascending; empty: all of them
};

/// One request: advance through a window with given data on the ports.
struct Advance {
  TimeWindow window;
  // BodyRecords wanted, at the ends of equal parts of the window
  int records = 1;
  Sampling sampling = Sampling::substeps;
  std::vector<BoundaryData> boundary;  // in the order of Description::ports
  std::vector<Want> want;              // the same; empty: everything
  // [s] by which the body goes on after the window, while forces of partners are gone at once, to
  // tell where its ports would be (PortResponse::ahead); it stands at the window's end all the same
  double ahead = 0.0;
  // (substeps, k) where Description::loose motions carry the body, at the substeps' ends; empty:
  // they stay where they are
  std::vector<double> carry;
};

/// A body: something that can be advanced through a window with given data on its ports, and
/// rewound.
///
/// Call sequence of one window:  save  (start finish  restore)*  start finish, then the next save
/// accepts. Substeps divide the window; the last one lands on its end exactly and the adjusted step
/// is not kept.
/// A window of no length advances nothing and reports the state.
/// A reply is a function of the state and of the request, bit for bit, whatever came before.
/// restore() is exact. start() returns at once so that bodies in other processes run
/// concurrently; finish() waits and fills the response. Between start() and finish() nothing else
/// is called.
class Subdomain {
 public:
  virtual ~Subdomain() = default;
  virtual const Description& describe() const = 0;
  /// A partner that a port may meet from the next advance on, or how its surface gives way;
  /// restore() does not take it back. Bodies are not told what they do not take (Capabilities).
  virtual void meet(const Meeting& meeting) = 0;
  virtual void save() = 0;  // the one state that restore() returns to
  virtual void restore() = 0;
  virtual void start(const Advance& request) = 0;  // the request must live until finish() returns
  [[nodiscard]] virtual Outcome finish(Response& response) = 0;
  /// Responses of ports to forces on one of them; the state is left untouched.
  virtual PortKernel probe(const Probing& asked) = 0;
  virtual std::vector<std::byte> checkpoint() = 0;  // durable form of the state
  virtual void resume(std::span<const std::byte> bytes) = 0;
  virtual std::uint64_t state_hash() = 0;  // equal states, equal hashes
  /// Numbers that sum up the present state, in the order of Description::measures; SI units. Asked
  /// for at the end of a run.
  virtual std::vector<double> measure() { return {}; }
  /// Where fields() has its values; never changes. Asked for only where the scene wants fields.
  virtual Grid grid() { return {}; }
  /// Description::fields in the present state, in their order; the state is left untouched. Values
  /// that cannot be told (an inadmissible state) are not finite.
  virtual std::vector<FieldValues> fields() { return {}; }
  /// Null: it has none (Capabilities::passive).
  virtual PassiveForm* passive() { return nullptr; }

  [[nodiscard]] Outcome advance(const Advance& request, Response& response) {
    start(request);
    return finish(response);
  }
};

}  // namespace abut
