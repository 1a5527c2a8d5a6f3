# Strict warnings as an interface target: link abut_warnings privately.
add_library(abut_warnings INTERFACE)
target_compile_options(abut_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -Wold-style-cast -Woverloaded-virtual)
# GCC 12 finds overlapping copies in std::string's operator+ where there are none (GCC bug 105651).
target_compile_options(abut_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# Clang 14 takes a captured `this` of a generic lambda for unused where the call is a template's.
target_compile_options(abut_warnings INTERFACE
  $<$<CXX_COMPILER_ID:Clang>:-Wno-unused-lambda-capture>)
# A file's own names shadow its neighbour's where files are compiled at once; the presets of
# developers watch each alone.
if(ABUT_UNITY)
  target_compile_options(abut_warnings INTERFACE -Wno-shadow)
endif()
option(ABUT_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
if(ABUT_WARNINGS_AS_ERRORS)
  target_compile_options(abut_warnings INTERFACE -Werror)
endif()
