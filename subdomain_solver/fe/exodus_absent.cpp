// Stands in for exodus_file.cpp where NetCDF was not found.

#include "base/error.hpp"
#include "subdomain_solver/fe/exodus_file.hpp"

namespace abut {

Mesh read_exodus(const std::string& path, double) {
  throw InputError(
      "cannot be read: this program was built without NetCDF, so without Exodus files", path,
      "Install libnetcdf-dev (scripts/install_dependencies.sh optional), configure and "
      "build again; or convert the mesh to Gmsh's format 4.1.");
}

}  // namespace abut
