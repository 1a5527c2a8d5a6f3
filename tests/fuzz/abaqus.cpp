// Meshes of Abaqus and CalculiX. The first byte says in how many dimensions facets alone are the
// surface of a shape.
#include "subdomain_solver/fe/abaqus_file.hpp"
#include "subdomain_solver/fe/mesh.hpp"
#include "tests/fuzz/hostile_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace abut;
  if (size == 0) return 0;
  const int surface_in = data[0] == '2' ? 2 : data[0] == '3' ? 3 : 0;
  const std::string bytes = fuzz::text_of(fuzz::input_of(data + 1, size - 1));
  fuzz::read_or_refuse([&bytes, surface_in] {
    std::vector<std::string> notes;
    CellWords words;
    const Mesh mesh = abaqus_mesh(bytes, "/nowhere/mesh.inp", 1.0, "", surface_in, &notes, &words);
    check_mesh(mesh, "mesh.inp");
  });
  return 0;
}
