#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace abut {

// What a scene makes of a body beside the body's own keys. The coordinator reads it out of the
// interfaces, once; the body is told, and reads neither interfaces nor the keys of other bodies.

/// Of an interface over whose sides two bodies overlap.
struct OverlapRole {
  bool first = true;      // the port is the interface's first side
  bool halves = true;     // the bodies share the material of the overlap
  bool motions = false;   // motions alone pass, no forces
  bool unstable = false;  // even where that gains energy
  bool operator==(const OverlapRole&) const = default;
};

/// A port of another body that an interface names beside a port of this one.
struct PortPartner {
  std::string interface;               // its name in the scene
  std::string body, port;              // the partner's
  bool tied = false;                   // false: they may touch
  bool external = false;               // the partner is of another program
  bool points = false;                 // of contact: rows of single points
  bool finds = false;                  // of contact: the scene lets the partner find it
  std::optional<OverlapRole> overlap;  // of tied bodies
  /// The partner's keys in the scene's form, below bodies.NAME, for bodies that need its mesh:
  /// those that overlap it or are adjusted to it. Empty: not needed, or not readable.
  std::string keys;
  std::uint64_t mesh_digest = 0;  // as BodyContext::mesh_digest, of the partner
  bool operator==(const PortPartner&) const = default;
};

/// What the interfaces make of a port.
struct PortRole {
  std::string port;
  bool touches = false;  // other ports may touch it
  bool tied = false;     // it is joined to others for the whole run
  /// Of a tied port: whether the bodies that hang together by ties integrate alike. Where it has
  /// tied: true: all bodies of its row have one step, and all are explicit or all implicit. Else:
  /// all have the same scheme, step and weights.
  bool alike = true;
  std::vector<PortPartner> partners;
  bool operator==(const PortRole&) const = default;
};

struct BodyContext {
  std::vector<PortRole> ports;  // those that interfaces name
  bool others_touch = false;    // any port may touch any other one
  /// Of the mesh's file, as it is where the coordinator runs; 0: not known.
  std::uint64_t mesh_digest = 0;
  bool operator==(const BodyContext&) const = default;

  PortRole role(std::string_view port) const {
    for (const PortRole& role : ports)
      if (role.port == port) return role;
    return {.port = std::string(port), .touches = others_touch, .partners = {}};
  }
};

}  // namespace abut
