// Stands in for exodus_file.cpp in a build without the option exodus.

#include "base/error.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"

namespace abut {

Mesh read_exodus(const std::string& path, double) {
  throw InputError(
      "cannot be read: this program was built without NetCDF, so without Exodus files", path,
      "Build it again with NetCDF: make build WITH=exodus; or convert the mesh to Gmsh's format "
      "4.1.");
}

}  // namespace abut
