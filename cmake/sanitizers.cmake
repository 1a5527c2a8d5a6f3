# ABUT_SANITIZE: empty, "address,undefined" or "thread". Undefined behaviour ends the program, so
# that a test cannot pass with a report on its error output alone.
set(ABUT_SANITIZE "" CACHE STRING "Sanitizers to build with")
if(ABUT_SANITIZE)
  add_compile_options(-fsanitize=${ABUT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${ABUT_SANITIZE})
endif()
