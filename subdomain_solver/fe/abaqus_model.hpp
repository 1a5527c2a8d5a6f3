#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "subdomain_solver/fe/abaqus_cursor.hpp"
#include "subdomain_solver/fe/abaqus_elements.hpp"

namespace abut {

/// What an input file says of meshes, in its own terms: parts with nodes, elements, sets and
/// surfaces, instances of them, and the assembly. A file without parts is the assembly alone.
struct AbaqusModel {
  /// Numbers from first to last by step, of the scope or of an instance.
  struct Picked {
    std::int64_t first = 0, last = 0, step = 1;
    std::int32_t instance = -1;   // -1: of the scope that the set is in
    bool generated = false;       // those of them that there are
    bool elements_nodes = false;  // in a set of nodes: those of the elements of these numbers
    AbaqusLine line;
  };
  struct Set {
    std::string name;       // as written first
    bool internal = false;  // of the program that wrote it: no name for people
    std::vector<Picked> picked;
    AbaqusLine line;
  };
  using Sets = std::map<std::string, Set>;  // by the name in capitals
  struct Elements {
    std::string name;  // of the type
    const AbaqusElement* type = nullptr;
    std::vector<std::int64_t> numbers, nodes;
    std::vector<AbaqusLine> lines;
  };
  struct Surface {
    struct Row {
      std::vector<Picked> picked;
      int face = 0;  // 1 for S1; 0: all that no other cell shares, and of sets of nodes
      AbaqusLine line;
    };
    std::string name;
    bool of_nodes = false, internal = false;
    std::vector<Row> rows;
    AbaqusLine line;
  };
  /// A part, or the assembly.
  struct Scope {
    std::string name;
    std::vector<std::int64_t> numbers;                        // (nodes)
    std::vector<double> points;                               // (nodes, 3)
    std::unordered_map<std::int64_t, std::int32_t> place_of;  // of a node's number
    std::vector<Elements> elements;
    Sets node_sets, element_sets;
    std::vector<Surface> surfaces;
  };
  /// A part that is moved, and then turned about an axis from a to b by an angle.
  struct Instance {
    std::string name;
    std::int32_t part = 0;
    std::array<double, 3> move{}, a{}, b{};
    double degrees = 0.0;
  };
  /// A set of elements that a section gives something to.
  struct Section {
    std::string keyword, set;  // in capitals
    std::int32_t part = -1;    // -1: of the assembly
    AbaqusLine line;
  };

  Scope assembly;
  std::vector<Scope> parts;
  std::vector<Instance> instances;
  std::vector<Section> sections;
  std::vector<std::string> skipped;  // keywords that are not of meshes, each once
};

/// Reads a file up to its end. Throws InputError with file and line: elements that we do not have,
/// keywords that make nodes and elements of others, what cannot be read.
AbaqusModel parse_abaqus(AbaqusCursor& file);

}  // namespace abut
