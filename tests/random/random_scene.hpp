#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tests/random/shape.hpp"

namespace abut {

/// The same scene seen otherwise: lengths and masses in other units, turned, moved.
struct View {
  double length = 1.0, mass = 1.0;  // numbers of the new units in one of the old ones
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  // [m] before the turn
  bool bodies_reversed = false;                     // their order
  bool interfaces_reversed = false;                 // their order, and that of their sides
  int finder = -1;       // which side of interfaces finds contact; -1: as abut chooses
  int fields_every = 0;  // windows; 0: no output of fields
};

struct RandomBody {
  enum class Kind { deformable, held, rigid, tool };
  std::string name;
  Kind kind = Kind::deformable;
  Shape shape;
  std::string law;  // of linear_elastic, saint_venant_kirchhoff, neo_hookean, j2_plasticity
  double modulus = 0.0, ratio = 0.0, density = 0.0, yield = 0.0;  // [Pa] [-] [kg/m^3] [Pa]
  std::string scheme;                                             // of the integrator
  double step = 0.0;                                              // [s]
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();             // of the part
  Eigen::Vector3d place = Eigen::Vector3d::Zero();                // [m] of its centre
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();             // [m/s]
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();  // [rad/s] about its place; of tools: for good
  std::string port;                                // the side that it is
  int whole = -1;     // what it was cut out of, with others that are tied to it; -1: nothing
  double area = 0.0;  // [m^2] of bars

  bool moves_by_itself() const { return kind == Kind::deformable || kind == Kind::rigid; }
  double wave_speed() const;                    // [m/s]
  std::vector<Eigen::Vector3d> points() const;  // [m] in space
};

/// Sides, as ports of the bodies, that are one.
struct RandomTie {
  std::array<int, 2> bodies;
  std::array<std::string, 2> ports;
};

/// A scene that a seed makes: bodies that start apart and fly at each other.
struct RandomScene {
  std::uint64_t seed = 0;
  int dim = 2;
  std::vector<RandomBody> bodies;
  std::vector<RandomTie> ties;
  bool everything = false;  // contact.everything in place of interfaces
  double friction = 0.0;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  // [m/s^2]
  double window = 0.0, end = 0.0;                     // [s]
  double speed = 0.0;                                 // [m/s]

  bool free() const;  // nothing outside acts on its bodies
  /// No scheme takes energy by itself: what is lost beside friction and plasticity, contact took.
  bool conserves() const;
  bool turns() const;  // all bodies may turn: their laws are of finite strain
  std::string words() const;
  /// The scene file; bodies have their meshes beside it, as NAME.msh.
  std::string text(const View& view) const;
  /// Writes it, as scene.yaml, with its meshes into a folder that exists.
  void write(const std::filesystem::path& folder, const View& view) const;
};

/// From this seed on there are bars, bodies that are tied, spin, and tools that turn.
constexpr std::uint64_t first_of_all_kinds = 10000;

/// `speed` [m/s]: of the bodies instead of one by chance; 0: by chance.
RandomScene random_scene(std::uint64_t seed, double speed = 0.0);

}  // namespace abut
