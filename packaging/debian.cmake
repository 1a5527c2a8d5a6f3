# `make package`: abut_VERSION_ARCH.deb, and libabut-dev_VERSION_ARCH.deb for solvers of others.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME abut)
set(CPACK_PACKAGE_CONTACT "The abut authors <abut@localhost>" CACHE STRING
  "Name and address of who makes the Debian packages")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_SOURCE_DIR}/debian_version.cmake)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL programs development)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(licence "")
if("cholmod" IN_LIST abut_with)
  set(licence " Built with CHOLMOD: this package may be passed on under the GPL alone.")
endif()
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME abut)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "python3 (>= 3.11), python3-yaml, libjs-chart.js")
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt recommended REGEX "^(pictures|sdk) ")
list(TRANSFORM recommended REPLACE "^[a-z]+ +([^ ]+) .*" "\\1")
list(REMOVE_DUPLICATES recommended)
list(JOIN recommended ", " recommended)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "${recommended}")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "libabut-dev, paraview")
set(CPACK_DEBIAN_PROGRAMS_DESCRIPTION "collision of solids that are solved by separate programs
Each body advances in a process of its own, with its own mesh, time integrator
and step; a coordinator joins them by Schwarz iteration over windows of time.
Contact, friction and ties in one, two and three dimensions.${licence}")

file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt needed REGEX "^link ")
list(TRANSFORM needed REPLACE "^link +([^ ]+) .*" "\\1")
list(JOIN needed ", " needed)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libabut-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${needed}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "abut")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "serve a body of your own to abut
Libraries, headers and the Protocol Buffers files with which a program becomes
a body of a scene of abut, in C++, C or Fortran, a CMake package, pkg-config
files and examples.")
install(CODE "if(\"\${CMAKE_INSTALL_COMPONENT}\" STREQUAL development)
  file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/share/doc/libabut-dev\" TYPE FILE
    RENAME copyright FILES ${PROJECT_SOURCE_DIR}/LICENSE)
  endif()" COMPONENT development)
include(CPack)
