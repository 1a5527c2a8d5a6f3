# What the compiler spends on a file.

# GCC looks for memory to free whenever it has taken some 100 MB: a tenth of its time. It may take
# this much [kB] first; large files need as much either way.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(--param=ggc-min-heapsize=1000000)
endif()

# Targets that read and write words (scenes, command lines, tables) or make bodies: what a run
# spends its time with is none of theirs. A quarter less to compile; results have the same bits at
# every level (cmake/floating_point.cmake).
function(abut_compile_with_less_effort)
  foreach(target IN LISTS ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()
