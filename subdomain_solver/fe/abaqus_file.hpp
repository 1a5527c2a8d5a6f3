#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "subdomain_solver/fe/cell_words.hpp"

namespace abut {

/// The mesh of an input file of Abaqus or CalculiX (.inp), with coordinates times `scale` [m per
/// unit of the file]: nodes, elements, sets and surfaces, flat or of parts and their instances.
///
/// `part`: the instance, part or set of elements that is the body, in any case; empty: all of the
/// file. Sets of elements become blocks and sets of nodes, sets of nodes stay, surfaces become
/// sides (those between cells, sets of nodes), under the names as they are written first; elements
/// of one dimension less than the cells name sides by their set, and those of lines sets of nodes.
/// Names of parts that are met again are INSTANCE.NAME; a set of elements or nodes with the name of
/// a surface of other nodes is NAME_cells or NAME_nodes.
///
/// `notes` gets lines for people: cells that were divided, keywords that were passed over, names
/// that were changed. `words` gets what the file calls every cell, with its line. Throws InputError
/// with file and line. Call check_mesh on the result.
Mesh read_abaqus(const std::string& path, double scale = 1.0, const std::string& part = {},
                 int surface_in = 0, std::vector<std::string>* notes = nullptr,
                 CellWords* words = nullptr);

/// The same of a file's bytes; `name` is its path, for messages and for files that it includes.
Mesh abaqus_mesh(std::string bytes, const std::string& name, double scale = 1.0,
                 const std::string& part = {}, int surface_in = 0,
                 std::vector<std::string>* notes = nullptr, CellWords* words = nullptr);

/// Digest of a file and of those that it includes (file_digest.hpp).
std::uint64_t digest_of_abaqus(const std::string& path);

}  // namespace abut
