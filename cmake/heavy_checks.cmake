# ABUT_CHECK_HEAVY: the standard library and Eigen look at every index and every shape, and end the
# program where one is wrong. The address sanitizer sees memory alone: an index past the end of a
# vector that has grown, or into the next row of a matrix, is memory of the program's own.
if(ABUT_CHECK_HEAVY)
  add_compile_definitions(_GLIBCXX_ASSERTIONS)
  add_compile_options(-UNDEBUG)  # after the flags of the build type
endif()
