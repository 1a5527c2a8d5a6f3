# Compile through ccache when it is there; nothing depends on it. Of precompiled headers it is told
# that what they contain decides, not when they were written.
find_program(ABUT_CCACHE ccache)
mark_as_advanced(ABUT_CCACHE)
if(ABUT_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${ABUT_CCACHE})
endif()
