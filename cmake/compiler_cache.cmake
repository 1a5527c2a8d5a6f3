# Compile through ccache when it is there; nothing depends on it.
find_program(ABUT_CCACHE ccache)
mark_as_advanced(ABUT_CCACHE)
if(ABUT_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ABUT_CCACHE})
endif()
