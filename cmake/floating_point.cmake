# Same bits from every placement and every machine that runs this binary: no contraction of a*b+c
# (the compiler would fuse some expressions and not others), and never fast-math (it reorders sums
# and assumes no NaN).
add_compile_options(-ffp-contract=off)
