# Half of what a file costs to compile is reading the headers of others: they are read once for each
# kind of target and kept. Off in the presets of developers, where a file that lacks an include is
# to be found.
option(ABUT_PRECOMPILED_HEADERS "Read the headers of libraries once for each kind of target" ON)

# Gives targets the headers that their kind reads.
#   kind: its name; TARGETS: who reads them; HEADERS: <of libraries> or by full path;
#   LIBRARIES: whose include directories and definitions the headers need
#   WITH_LESS_EFFORT: the targets are compiled so (cmake/compiler_effort.cmake); GCC keeps the level
#   of optimisation with the headers, and takes it for what includes them
function(abut_precompile_headers kind)
  if(NOT ABUT_PRECOMPILED_HEADERS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 of "WITH_LESS_EFFORT" "" "TARGETS;HEADERS;LIBRARIES")
  set(source ${CMAKE_BINARY_DIR}/precompiled/${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Nothing but the headers of ${kind}.\n")
  add_library(abut_headers_${kind} OBJECT ${source})
  target_include_directories(abut_headers_${kind} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(abut_headers_${kind} PRIVATE ${of_LIBRARIES} abut_warnings)
  if(of_WITH_LESS_EFFORT)
    abut_compile_with_less_effort(abut_headers_${kind})
  endif()
  target_precompile_headers(abut_headers_${kind} PRIVATE ${of_HEADERS})
  if(CMAKE_CXX_COMPILER_LAUNCHER)
    set_target_properties(abut_headers_${kind} PROPERTIES CXX_COMPILER_LAUNCHER
      "sh;${CMAKE_SOURCE_DIR}/cmake/without_old_output.sh;${CMAKE_CXX_COMPILER_LAUNCHER}")
  endif()
  foreach(target IN LISTS of_TARGETS)
    target_precompile_headers(${target} REUSE_FROM abut_headers_${kind})
  endforeach()
endfunction()
