#!/bin/sh
# Configures a preset when needed and builds some of it.
#   usage: scripts/build.sh demo|programs|tests|bench
#   demo: the two programs; programs: also what is installed with them
#   environment: PRESET (release), JOBS (all cores), WITH (optional libraries by name; none)
# A build directory that was made with other libraries than WITH names is configured again.
# The build directory starts with the programs alone, so that a demo needs neither GoogleTest nor
# Google Benchmark; asking for tests or bench adds them for good.
set -eu
cd "$(dirname "$0")/.."

preset=${PRESET:-release}
directory=build/$preset
jobs=${JOBS:-$(nproc)}

has() {  # is this option already on in the build directory
  grep -q "^$1:BOOL=ON\$" "$directory/CMakeCache.txt" 2>/dev/null
}

configure() {
  log=$(mktemp)
  if ! cmake --preset "$preset" "$@" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    exit 1
  fi
  rm -f "$log"
}

made_with() {  # is this what WITH named when the build directory was configured
  grep -qxF "ABUT_WITH:STRING=${WITH:-}" "$directory/CMakeCache.txt" 2>/dev/null
}

# build.ninja is written last: its absence means that the directory was never configured to the end.
[ -f "$directory/build.ninja" ] || configure -DABUT_TESTS=OFF -DABUT_BENCH=OFF
made_with || configure

case "${1:-}" in
  demo) target="abut abut-solver" ;;
  programs) target=programs ;;
  tests)
    has ABUT_TESTS || configure -DABUT_TESTS=ON
    target=all ;;
  bench)
    has ABUT_BENCH || configure -DABUT_BENCH=ON
    target="programs benchmarks" ;;
  *)
    echo "usage: $0 demo|programs|tests|bench" >&2
    exit 2 ;;
esac

# shellcheck disable=SC2086  # more than one target
exec cmake --build "$directory" --parallel "$jobs" --target $target
