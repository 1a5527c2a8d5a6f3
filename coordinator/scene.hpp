#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/fields.hpp"
#include "base/input_errors.hpp"
#include "base/yaml_document.hpp"
#include "contract/port_role.hpp"
#include "contract/subdomain.hpp"
#include "coordinator/interface_spec.hpp"
#include "coordinator/output_spec.hpp"
#include "coordinator/scene_meta.hpp"
#include "coordinator/ssh_launch.hpp"
#include "coordinator/tie_kernel_spec.hpp"
#include "coordinator/time_spec.hpp"

namespace abut {

struct SpawnLaunch {  // the coordinator starts the process
  static constexpr std::string_view name = "spawn";
  std::string program;  // empty: abut-solver beside abut
  void fields(Fields& f);
};
struct ConnectLaunch {  // the coordinator waits for a process that somebody else starts
  static constexpr std::string_view name = "connect";
  double patience = 60.0;  // [s]
  void fields(Fields& f);
};
struct GroupLaunch {  // the coordinator starts one process for all bodies of this group
  static constexpr std::string_view name = "group";
  static constexpr std::string_view shorthand = "name";
  std::string group;    // key name
  std::string program;  // as of SpawnLaunch; the same for all of a group
  void fields(Fields& f);
};

/// What the coordinator reads of a body entry; all other keys are the body's own specification.
struct BodyEntry {
  std::string name;
  std::variant<SpawnLaunch, ConnectLaunch, GroupLaunch, SshLaunch> launch;
  bool external = false;  // of another program, which alone can describe it
  std::string like;       // body that it has the rest from; the document has written it out
  bool adjusts = false;   // its own specification has initial: {adjust: true}
  bool fits = false;      // ... initial: {interference: ...}
  bool stood = false;     // ... initial: {after_statics: true}
  BodyContext context;    // what the interfaces make of it
  void fields(Fields& f);
};

/// A relaxation factor, or the word probe.
struct RelaxationFactor {
  double value = 0.0;  // 0: by impedance probe
  bool probed() const { return value == 0.0; }
  void field(Fields& f, std::string_view key, double high, std::string_view help);
};

struct NoAcceleration {
  static constexpr std::string_view name = "none";
  void fields(Fields& f);
};
struct FixedRelaxation {
  static constexpr std::string_view name = "relaxation";
  RelaxationFactor factor{0.5};
  void fields(Fields& f);
};
struct AitkenAcceleration {
  static constexpr std::string_view name = "aitken";
  RelaxationFactor initial;
  void fields(Fields& f);
};
struct AndersonAcceleration {  // IQN-ILS
  static constexpr std::string_view name = "anderson";
  RelaxationFactor initial;
  int reuse = 5;           // windows whose secants are kept
  double filter = 1.0e-7;  // relative size below which a secant is dropped
  void fields(Fields& f);
};
struct KernelAcceleration {  // port kernels as interface Jacobian, plus secants
  static constexpr std::string_view name = "kernel";
  int reuse = 5;
  double filter = 1.0e-7;
  void fields(Fields& f);
};

enum class OnNonconvergence { passive, stop, halve, accept };

struct SchwarzSpec {
  bool parallel = false;              // "form: alternating | parallel"
  double tolerance = 1.0e-6;          // scaled by reference velocity x step
  std::optional<int> max_iterations;  // absent: as Steps has it
  std::variant<KernelAcceleration, NoAcceleration, FixedRelaxation, AitkenAcceleration,
               AndersonAcceleration>
      accelerator;
  std::optional<TieKernelSpec> ties;  // absent: its defaults
  OnNonconvergence on_nonconvergence = OnNonconvergence::passive;
  double energy_guard = 0.01;  // of the most energy in motion: growth that ends the run
  void fields(Fields& f);
};

enum class OnLostBody { stop, restart };
enum class Transport { automatic, sockets };

struct NetworkSpec {
  // Where bodies with launch: connect find the coordinator.
  std::string endpoint = "tcp://127.0.0.1:5555";
  double request_deadline = 60.0;  // [s] without reply or sign of progress
  double startup_deadline = 10.0;  // [s] for processes that the coordinator starts
  int processes = 0;               // that bodies without a group are dealt to; 0: one for each
  OnLostBody on_lost_body = OnLostBody::stop;
  Transport transport = Transport::automatic;
  std::string keys;  // directory, from the scene's own folder; empty: connected bodies have none
  void fields(Fields& f);
};

/// Keys of the scene that another stage has in another way (Document::next_stage).
struct StageSpec {
  void fields(Fields& f) { f.ignore_rest(); }
};

struct Scene {
  std::string units;  // empty: not told
  Meta meta;
  TimeSpec time;
  std::vector<std::pair<std::string, BodyEntry>> bodies;
  std::vector<std::pair<std::string, InterfaceSpec>> interfaces;
  std::optional<SceneContactSpec> contact;
  SchwarzSpec schwarz;
  OutputSpec output;
  NetworkSpec network;
  std::vector<std::pair<std::string, StageSpec>> stages;  // that follow
  void fields(Fields& f);

  /// The law where everything may touch everything; null: interfaces are written one by one.
  const ContactSpec* everything() const {
    return contact && contact->everything ? &*contact->everything : nullptr;
  }
  /// Coulomb's coefficient of bodies on themselves; empty: they do not touch themselves.
  std::optional<double> own_friction() const {
    if (!contact) return 0.0;
    if (!contact->self) return std::nullopt;
    const ContactSpec* all = everything();
    return contact->self_friction.value_or(all ? sliding(*all) : 0.0);
  }

 private:
  void idle_keys(Fields& f) const;
};

/// The interfaces that the scene's closed form describes.
std::vector<std::string> exact_interfaces(const Scene& scene);

/// A port as scenes name it: "body.port".
struct PortName {
  std::string body, port;
};
PortName split_port(std::string_view text);

/// Reads the whole scene and validates it. Throws InputError.
Scene read_scene(const Document& document);
/// The same, with what is wrong added to the errors: what could be read.
Scene read_scene(const Document& document, InputErrors& errors);

/// Rules across the keys of different maps, such as that a side's body exists. Throws InputError.
void validate(const Scene& scene, const Document& document);

/// Rules that need the bodies: ports that exist and face each other across a gap, one dimension per
/// interface, windows that hold a whole number of every body's steps. `bodies` are in the scene's
/// order; null: an external body that has not told yet what it is. Throws InputError.
void validate_bodies(const Scene& scene, std::span<const Description* const> bodies,
                     const Document& document);

}  // namespace abut
