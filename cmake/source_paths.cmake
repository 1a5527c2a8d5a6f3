# What is built does not tell where it was built: __FILE__ (of broken invariants, and of what
# generated code asserts) is the file's place in the checkout: two checkouts give the same programs.
add_compile_options(
  -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=
  -fmacro-prefix-map=${PROJECT_BINARY_DIR}/=)
