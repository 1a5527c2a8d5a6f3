# What --version tells: version, commit, options. The commit is looked up in every build, because
# it changes without a file that CMake watches (packaging/tell_build.cmake).
set(ABUT_COMMIT "" CACHE STRING "Commit that is built; empty: what git says of the checkout")
set(ABUT_PYTHON_PACKAGE ${CMAKE_BINARY_DIR}/share/abut/python/abut_tools)  # as it is installed

list(JOIN abut_with " " options)
if(NOT options)
  set(options none)
endif()
set(options "optional libraries: ${options}")
if(CMAKE_BUILD_TYPE)
  string(PREPEND options "${CMAKE_BUILD_TYPE}; ")
endif()
if(ABUT_CHECK_HEAVY)
  string(APPEND options "; heavy checks")
endif()
if(ABUT_SANITIZE)
  string(APPEND options "; sanitizers: ${ABUT_SANITIZE}")
endif()

set(abut_build_info ${CMAKE_BINARY_DIR}/generated/build_info.cpp)
add_custom_target(abut_tell_build BYPRODUCTS ${abut_build_info} ${ABUT_PYTHON_PACKAGE}/build_info.py
  COMMAND ${CMAKE_COMMAND} -Dsource=${CMAKE_SOURCE_DIR} -Dversion=${PROJECT_VERSION}
    "-Doptions=${options}"
    "-Dcompiler=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
    "-Dcommit=${ABUT_COMMIT}" -Dcpp=${abut_build_info}
    -Dpython=${ABUT_PYTHON_PACKAGE}/build_info.py
    -P ${CMAKE_SOURCE_DIR}/packaging/tell_build.cmake
  COMMENT "Looking up the commit" VERBATIM)
add_library(abut_build_info STATIC ${abut_build_info})
add_dependencies(abut_build_info abut_tell_build)
target_include_directories(abut_build_info PUBLIC ${CMAKE_SOURCE_DIR})
