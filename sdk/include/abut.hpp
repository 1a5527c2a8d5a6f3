#pragma once
// A body of your own in a scene of abut: subclass abut::Body and hand it to abut::serve().
// docs/SOLVER.md goes through it; C++17 or later. The order of calls, in a run:
//
//     the constructor         once; keys are those below model.external of the scene
//     surface()               once; places and facets of the ports
//     kernel(...)             before contact: how the ports give way; by default found by trying
//     then for every window, as often as the coordinator wants:
//         save()              the state at the window's begin
//         step(dt, force)     for every substep, the last of which ends on the window's end
//           displacement(), velocity()                   after every one
//         energy(), momentum(), speed_bound()            at the ends of records
//         restore(saved)      the same window comes again with other forces, many times
//     grid(), node_fields(), cell_fields()               where the scene has output.fields
//
// What step() does must follow from the state and the arguments alone: a window that is repeated
// with the same forces ends in the same bits. Motions and forces are (points, dim), row by row; of
// several ports one after the other, in the order of surface(). All units are SI.
#include <abut.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace abut {
inline namespace user {

using Values = std::vector<double>;
using Energy = abut_energy;  // {kinetic, stored, dissipated, external_work} [J]

/// A step that cannot be made: the scene's policy decides, as with bodies of abut.
struct NotConverged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The keys below model.external. What is missing, impossible or not read is told with file, line
/// and key, and the program ends. Units: "m", "kg/m^3"; "": none.
class Keys {
 public:
  struct Refused {};  // ends the constructor

  explicit Keys(abut_keys* keys) : keys_(keys) {}
  bool has(const char* name) const { return abut_has(keys_, name) != 0; }
  double number(const char* name, const char* unit = "") const {
    return sound(abut_number(keys_, name, unit));
  }
  double positive(const char* name, const char* unit = "") const {
    return sound(abut_positive(keys_, name, unit));
  }
  double get(const char* name, double otherwise, const char* unit = "") const {
    return sound(abut_number_or(keys_, name, unit, otherwise));
  }
  int count(const char* name) const { return sound(abut_count(keys_, name)); }  // above 0
  std::string text(const char* name, const char* otherwise = nullptr) const {
    return sound(abut_text(keys_, name, otherwise));
  }
  Values numbers(const char* name, int count, const char* unit = "") const {
    Values values(static_cast<std::size_t>(count));
    abut_numbers(keys_, name, unit, values.data(), count);
    return sound(values);
  }
  int length(const char* name) const { return abut_length(keys_, name); }  // of a list
  /// An error of yours: "is too heavy", "Give less than 5 kg.".
  [[noreturn]] void refuse(const char* name, const char* what, const char* remedy) const {
    abut_refuse(keys_, name, what, remedy);
    throw Refused();
  }

 private:
  template <class T>
  T sound(T value) const {
    if (abut_refused(keys_) != 0) throw Refused();
    return value;
  }
  abut_keys* keys_;
};

/// A port: points [m] (n, dim) and facets, lists of point numbers: 2 in the plane, 3 or 4 in space.
/// In the plane the body lies to the left of who walks along a facet; in space the points of a
/// facet turn counterclockwise for who looks at the body from outside. Normals follow from that.
struct Surface {
  Values points;
  std::vector<std::vector<int>> facets;
  std::string name = "face";
  double spacing = 0.0;  // [m] distance of mesh nodes behind it; 0: the mean edge of the facets
  double transit = 0.0;  // [s] in which the fastest wave crosses that; 0: rigid or unknown
  double normal = 0.0;   // of a Point
};

/// The port of a body in one dimension: a place [m] and the way it looks, 1.0 or -1.0.
inline Surface Point(double position, double normal, std::string name = "face") {
  return {{position}, {}, std::move(name), 0.0, 0.0, normal};
}

/// What steps change, by name: it refers to a number or to numbers, whose count stays.
struct State {
  State(const char* called, double& number) : name(called), number_(&number) {}
  State(const char* called, Values& numbers) : name(called), numbers_(&numbers) {}
  std::size_t count() const { return numbers_ != nullptr ? numbers_->size() : 1; }
  double* begin() const { return numbers_ != nullptr ? numbers_->data() : number_; }

  std::string name;

 private:
  double* number_ = nullptr;
  Values* numbers_ = nullptr;
};

/// What is drawn: points [m] (n, dim), and cells, each a pair of VTK's number of its kind and its
/// points. Fields: values on the points, or on the cells: (n), (n, 3) or (n, 6).
struct Grid {
  Values points;
  std::vector<std::pair<int, std::vector<int>>> cells;
};
using Fields = std::vector<std::pair<std::string, Values>>;

/// Subclass it; write the constructor, surface and step, and name what changes in `state`. What is
/// not overridden, and what answers nothing (no values, a NaN), follows as abut.h says.
class Body {
 public:
  Body() = default;
  Body(const Body&) = delete;
  Body& operator=(const Body&) = delete;
  virtual ~Body() = default;

  int dim = 1;            // of space: 1, 2 or 3
  std::string model;      // one line for people
  double mass = nothing;  // [kg], per metre in the plane; infinity: nothing moves it
  double substep = 0.0;   // [s] wanted length of a step; 0: one step takes a record's time
  double stable_step = std::numeric_limits<double>::infinity();  // [s] limit; infinity: none
  std::vector<State> state;   // {{"u", u}, {"v", v}}: what steps change
  bool conserves = false;     // its energy changes by forces on ports and external work alone
  bool linear = false;        // it answers forces linearly
  bool quasi_static = false;  // it has no inertia: forces and springs balance after every step
  double surface_mass = 0.0;  // [kg] least mass that moves with a point of a port; 0: not told

  /// Its ports, one at least.
  virtual std::vector<Surface> surface() = 0;
  /// Advances the state by dt [s] under a force on the points [N], which is constant meanwhile; of
  /// a quasi-static body it is the force at the step's end. Throws NotConverged.
  virtual void step(double dt, const Values& force) = 0;
  virtual Values displacement() { return {}; }  // [m]; by default the state `u`
  virtual Values velocity() { return {}; }      // [m/s]; by default the state `v`
  virtual Values work() { return {}; }          // [J] through each port in the last step
  virtual Energy energy() { return {nothing, 0.0, 0.0, 0.0}; }
  virtual Values momentum() { return {}; }             // [kg m/s] (dim)
  virtual double speed_bound() { return nothing; }     // [m/s] while nothing touches the body
  virtual double acceleration_bound() { return 0.0; }  // [m/s^2] by which loads may raise it
  virtual Values save();                               // all that steps change, as numbers
  virtual void restore(const Values& saved);           // back to that, exactly
  virtual void rest() {}  // to the state from which kernels are found; by default the first one
  /// [m] (count, patterns, n, dim): what forces [N] (patterns, n, dim) over the first of `count`
  /// steps of this length do to the port, at the end of each.
  virtual Values kernel(int port, int patterns, const Values& force, double step, int count);
  virtual Grid grid() { return {}; }           // by default the surfaces of the ports
  virtual Fields node_fields() { return {}; }  // by default displacement and velocity of those
  virtual Fields cell_fields() { return {}; }

  static constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
};

using Make = std::function<std::unique_ptr<Body>(const Keys&)>;

/// Runs this program as a body of a scene: `--connect ENDPOINT --body NAME`, as abut starts it.
/// make(keys) gives the body. Returns the program's exit code.
int serve(int argc, char** argv, const Make& make);

/// The same of a class that takes its keys: `return abut::serve<MyBody>(argc, argv);`
template <class MyBody>
int serve(int argc, char** argv) {
  return serve(argc, argv, [](const Keys& keys) { return std::make_unique<MyBody>(keys); });
}

}  // namespace user
}  // namespace abut
