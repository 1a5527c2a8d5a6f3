#!/bin/sh
# Gives every target inputs of libFuzzer's making for so many seconds, beginning with those that
# are kept, and ends with 1 when one of them ended a target: its file is told. What libFuzzer finds
# worth going on from is kept in the build directory. A file that ended a target belongs into
# tests/fuzz/corpus/TARGET, under a name that says what was wrong, once that is mended.
#   usage: tests/fuzz/run.sh DIRECTORY_OF_PROGRAMS SECONDS [TARGET...]
set -u
here=$(cd "$(dirname "$0")" && pwd)
bin=$(cd "${1:?directory of the programs}" && pwd)
seconds=${2:?seconds for each target}
shift 2
failed=0
[ $# -gt 0 ] || set -- abaqus checkpoints gmsh replies requests scenes tables
for target in "$@"; do
  work="$bin/../hostile/$target"
  mkdir -p "$work/corpus"
  more=""
  [ "$target" != scenes ] || more="$here/../../configs $here"
  # shellcheck disable=SC2086  # more than one directory, none with blanks inside the checkout
  if "$bin/abut_hostile_$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 \
      -max_len=65536 -artifact_prefix="$work/" -print_final_stats=1 "$work/corpus" \
      "$here/corpus/$target" $more >"$work/log" 2>&1; then
    runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")
    echo "$target: $runs inputs, none ended it"
  else
    failed=1
    echo "$target: ended by $(sed -n 's/.*Test unit written to //p' "$work/log"); see $work/log"
  fi
done
exit $failed
