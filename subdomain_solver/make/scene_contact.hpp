#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/yaml_document.hpp"

namespace abut {

/// An interface that lets a port touch another one.
struct SceneContact {
  std::string interface;
  std::string body, port;  // the partner's
  bool points = false;     // rows of single points
  std::string kinematic;   // side to which the scene gives that role; empty: to none
};

/// With whom the interfaces of a scene let a body's port touch, in their order. The scene may be
/// without interfaces: a body alone.
std::vector<SceneContact> contacts_of(const Document& scene, const std::string& body,
                                      const std::string& port);

/// An interface over whose sides a body overlaps another one.
struct SceneOverlap {
  std::string interface;
  std::string body, port;  // the partner's
  bool first = true;       // this body's side is the interface's first
  bool halves = true;      // the material is shared
  bool motions = false;    // motions alone pass, no forces
  bool unstable = false;   // even where they gain energy
};

/// That of a port; nothing: it has none.
std::optional<SceneOverlap> overlap_of(const Document& scene, const std::string& body,
                                       const std::string& port);

/// Whether a port is tied to another one.
bool joins(const Document& scene, const std::string& body, const std::string& port);

/// Whether a port shares its node with another one, tied: true both, and somewhere along the row of
/// bodies that do two step apart: of other steps, or one explicit and one implicit.
bool row_steps_apart(const Document& scene, const std::string& body, const std::string& port);

/// Whether a port of a body in two or three dimensions may touch anything: one that is tied does so
/// only where an interface says it.
bool touches(const Document& scene, const std::string& body, const std::string& port);

}  // namespace abut
