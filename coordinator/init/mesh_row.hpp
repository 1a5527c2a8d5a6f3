#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace abut {

/// A body of a row, from a mesh file.
struct RowBody {
  std::string name;
  std::filesystem::path file;
  std::string reader;              // key of the scene that reads it: gmsh, abaqus
  std::vector<std::string> notes;  // of the reader
  int nodes = 0;
  std::string cells;                                       // "5678 tet4"
  bool quadratic = false;                                  // some of them
  std::vector<double> lengths;                             // [m] of its box
  std::vector<double> position;                            // [m] of the file's origin
  std::vector<std::pair<std::string, std::string>> ports;  // name, and side of the mesh
  std::vector<std::string> node_sets;

  /// "123 nodes, 456 tet4, 0.1 x 0.2 x 0.3 m".
  std::string words() const;
};

/// A box beyond the last body.
struct RowWall {
  std::vector<double> lengths, position;  // [m]
};

/// Bodies side by side along x, their boxes apart and their middles on one line.
struct MeshRow {
  int dim = 0;
  double scale = 1.0;  // [m] per unit of the files
  std::vector<RowBody> bodies;
  std::optional<RowWall> wall;  // where there is one body
  double longest = 0.0;         // [m] longest edge of a box
  double first_gap = 0.0;       // [m] from the first body to what it meets, along x
};

/// Files are of Gmsh, or of Abaqus and CalculiX where their names end in .inp. Those of larger
/// numbers than those of a machine in metres are taken to be in millimetres. Throws InputError:
/// what cannot be read, meshes of different dimensions, or of lines.
MeshRow mesh_row(const std::vector<std::string>& files);

}  // namespace abut
