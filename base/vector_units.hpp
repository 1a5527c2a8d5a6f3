#pragma once

namespace abut {

#if defined(__x86_64__)
/// Whether this processor has what -march=x86-64-v4 and -march=x86-64-v3 compile for. Clang 14
/// knows no names of levels: there the instructions are asked for that every processor of a level
/// has and none below it all of.
inline bool has_x86_64_v4() {
#if defined(__clang__)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
#else
  return __builtin_cpu_supports("x86-64-v4");
#endif
}

inline bool has_x86_64_v3() {
#if defined(__clang__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
#else
  return __builtin_cpu_supports("x86-64-v3");
#endif
}
#endif

}  // namespace abut
