# Tests of GoogleTest, a suite at a time: a program starts in a hundredth of a second, which is more
# than most of some thousand cases take. A case alone: bin/PROGRAM --gtest_filter=SUITE.CASE.

# Suites of a program as tests of CTest, each by its name, over all sets of its parameters. They are
# listed when ctest starts, not while a loaded machine is still building.
#   PROPERTIES name value ...: of all tests of the program
function(abut_discover_suites program)
  cmake_parse_arguments(PARSE_ARGV 1 of "" "" "PROPERTIES")
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${program}_suites.cmake)
  file(CONFIGURE OUTPUT ${file}.in @ONLY CONTENT [[
set(program "$<TARGET_FILE:@program@>")
set(properties "@of_PROPERTIES@")
include("@CMAKE_SOURCE_DIR@/cmake/list_suites.cmake")
]])
  file(GENERATE OUTPUT ${file} INPUT ${file}.in)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()
