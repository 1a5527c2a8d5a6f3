# Libraries that abut can do without. One is used when ABUT_WITH names it, and never because it
# happens to be there: what is built depends on the command alone. A named one that is missing is an
# error. Each gives a target abut_with_<name> and ABUT_<name>_INCLUDE, which only the files that see
# it get, so that a change of mind compiles no more than those.
set(ABUT_WITH "" CACHE STRING "Optional libraries to use, by name: cholmod, exodus, petsc")

set(ABUT_OPTIONAL_cholmod cholmod cholmod.h suitesparse libsuitesparse-dev)  # GPL: docs/adr/0007
set(ABUT_OPTIONAL_exodus netcdf netcdf.h "" libnetcdf-dev)
set(ABUT_OPTIONAL_petsc petsc_real petscksp.h petsc libpetsc-real-dev)

string(REGEX MATCHALL "[^ ,;]+" abut_with "${ABUT_WITH}")
list(REMOVE_DUPLICATES abut_with)
foreach(name IN LISTS abut_with)
  if(NOT DEFINED ABUT_OPTIONAL_${name})
    message(FATAL_ERROR "There is no optional library '${name}' to build with; there are: "
      "cholmod, exodus, petsc.")
  endif()
  list(GET ABUT_OPTIONAL_${name} 0 library)
  list(GET ABUT_OPTIONAL_${name} 1 header)
  list(GET ABUT_OPTIONAL_${name} 2 folder)
  list(GET ABUT_OPTIONAL_${name} 3 package)
  find_library(ABUT_${name}_LIBRARY ${library})
  find_path(ABUT_${name}_INCLUDE ${header} PATH_SUFFIXES ${folder})
  mark_as_advanced(ABUT_${name}_LIBRARY ABUT_${name}_INCLUDE)
  if(NOT ABUT_${name}_LIBRARY OR NOT ABUT_${name}_INCLUDE)
    message(FATAL_ERROR "'${name}' was asked for, and ${header} or lib${library} is missing. "
      "Install Debian's ${package}, or build without: leave '${name}' out of WITH (of ABUT_WITH).")
  endif()
  # Named again as a system folder, the compiler's own one would hide the C library from <cstdlib>.
  if(ABUT_${name}_INCLUDE IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
    set(ABUT_${name}_INCLUDE "")
  endif()
  add_library(abut_with_${name} INTERFACE)
  target_link_libraries(abut_with_${name} INTERFACE ${ABUT_${name}_LIBRARY})
endforeach()
if(TARGET abut_with_petsc)  # whose headers are of the MPI that it was built with
  find_path(ABUT_mpi_INCLUDE mpi.h PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openmpi/include
    PATH_SUFFIXES mpi)
  find_library(ABUT_mpi_LIBRARY mpi PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/openmpi/lib)
  mark_as_advanced(ABUT_mpi_INCLUDE ABUT_mpi_LIBRARY)
  if(NOT ABUT_mpi_LIBRARY OR NOT ABUT_mpi_INCLUDE)
    message(FATAL_ERROR "'petsc' was asked for, and mpi.h or libmpi is missing. Install Debian's "
      "libpetsc-real-dev, or build without: leave 'petsc' out of WITH (of ABUT_WITH).")
  endif()
  list(APPEND ABUT_petsc_INCLUDE ${ABUT_mpi_INCLUDE})
  target_link_libraries(abut_with_petsc INTERFACE ${ABUT_mpi_LIBRARY})
endif()
