# ABUT_SANITIZE: empty, "address,undefined" or "thread".
set(ABUT_SANITIZE "" CACHE STRING "Sanitizers to build with")
if(ABUT_SANITIZE)
  add_compile_options(-fsanitize=${ABUT_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${ABUT_SANITIZE})
endif()
