#pragma once

#include <map>
#include <string>
#include <vector>

#include "subdomain_solver/fe/abaqus_pieces.hpp"

namespace abut {

/// The sets and surfaces of a file as names that a scene can use, each name once.
struct AbaqusGroups {
  struct Face {
    std::int32_t element = 0;
    int face = 0;  // 0 for S1
  };
  struct Group {
    std::string name;
    AbaqusLine line;
    std::vector<std::int32_t> elements, nodes;  // one of them, of sets
    std::vector<Face> faces;                    // of surfaces
  };
  std::vector<Group> groups;
  std::vector<std::string> notes;
};

/// `kept`: (elements) 1 for those of the body; groups have nothing else. `whole`: the body is all
/// of the file, and then a set of nothing is refused. Throws InputError.
AbaqusGroups abaqus_groups(const AbaqusPieces& pieces, const AbaqusCursor& file,
                           const std::vector<char>& kept, bool whole);

}  // namespace abut
