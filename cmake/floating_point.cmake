# Same bits from every placement and every machine that runs this binary: no contraction of a*b+c
# (the compiler would fuse some expressions and not others), and never fast-math (it reorders sums
# and assumes no NaN).
add_compile_options(-ffp-contract=off)
# Eigen cuts the sums of products of large matrices into parts by the caches that it finds: other
# bits on other machines. It takes these sizes instead, whatever the machine has.
add_compile_definitions(EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=32768
  EIGEN_DEFAULT_L2_CACHE_SIZE=1048576 EIGEN_DEFAULT_L3_CACHE_SIZE=33554432)
