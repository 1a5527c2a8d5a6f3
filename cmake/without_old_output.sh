#!/bin/sh
# Runs a compiler's command after removing the precompiled header that it writes. ccache takes one
# that is there already for a header that is read, and then looks up the new one by the old one's
# content instead of by the headers: targets would go on with structures of before a change.
before=
for word in "$@"; do
  case "$before$word" in
    -o*.gch | -o*.pch) rm -f "$word" ;;
  esac
  before=
  [ "$word" = -o ] && before=-o
done
exec "$@"
