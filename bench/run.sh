#!/bin/sh
# Runs every performance program, then every whole-run comparison, and prints their figures.
#   usage: bench/run.sh DIRECTORY_OF_PROGRAMS
set -eu
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "${1:?directory of the programs}" && pwd)
ran=0

for program in "$bin"/abut_bench_*; do
  [ -x "$program" ] || continue
  echo "== $(basename "$program")"
  "$program"
  ran=$((ran + 1))
done
for script in "$here"/*.py; do
  [ -f "$script" ] || continue
  echo "== $(basename "$script")"
  /usr/bin/python3 "$script" "$bin"
  ran=$((ran + 1))
done
[ "$ran" -gt 0 ] || { echo "bench/run.sh: nothing to run in $bin or $here" >&2; exit 1; }
