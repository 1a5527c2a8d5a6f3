# ABUT_SANITIZE: empty, "address,undefined,float-cast-overflow" or "thread". Undefined behaviour
# ends the program, so that a test cannot pass with a report on its error output alone.
set(ABUT_SANITIZE "" CACHE STRING "Sanitizers to build with")
# How many times as long a test may take before it counts as hanging: what the sanitizers, and the
# weaker optimisation of their presets, cost the slowest.
set(ABUT_SLOWER 1)
if(ABUT_SANITIZE)
  set(ABUT_SLOWER 20)
  add_compile_options(-fsanitize=${ABUT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${ABUT_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # GCC 12.2 crashes in this pass with precompiled headers of Protocol Buffers.
    add_compile_options(-fno-ipa-cp)
  endif()
endif()
# The address sanitizer sees what a null pointer, or one beyond its object, is used for; without a
# look at each of them a build takes two thirds of the time.
if(ABUT_SANITIZE MATCHES "address.*undefined")
  add_compile_options(-fno-sanitize=null,alignment,vptr,object-size)
endif()
