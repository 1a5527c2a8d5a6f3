#include "subdomain_solver/fe/gmsh_file.hpp"

#include <cstddef>
#include <utility>

#include "base/input_file.hpp"
#include "base/machine_memory.hpp"
#include "subdomain_solver/fe/divide_cells.hpp"
#include "subdomain_solver/fe/gmsh_data.hpp"

namespace abut {

Mesh gmsh_mesh(std::string bytes, const std::string& name, double scale, int surface_in,
               std::vector<std::string>* notes) {
  FileMesh file = parse_gmsh(std::move(bytes), name);
  divide_cells(file);
  if (notes != nullptr) notes->insert(notes->end(), file.notes.begin(), file.notes.end());
  return mesh_of(std::move(file), scale, surface_in);
}

Mesh read_gmsh(const std::string& path, double scale, int surface_in,
               std::vector<std::string>* notes) {
  // The mesh takes about as much memory as the text that it was read from.
  const std::size_t most = static_cast<std::size_t>(0.5 * machine_memory());
  constexpr const char* remedy = "Check the path of the mesh.";
  check_input_file(path, most, remedy);
  return gmsh_mesh(read_input_file(path, most, remedy), path, scale, surface_in, notes);
}

}  // namespace abut
