#!/bin/sh
# Installs the Debian packages of the named groups of packages.txt that are missing, and only those.
#   usage: scripts/install_dependencies.sh GROUP...
#   groups: build, test, bench, pictures, runtime; cholmod, exodus, petsc (options of WITH)
# DEPENDENCIES=installed skips the check: for systems without apt, once the list was installed by
# hand.
set -eu

list="$(dirname "$0")/packages.txt"
[ $# -gt 0 ] || { echo "usage: $0 GROUP...   (groups: see packages.txt)" >&2; exit 2; }
[ "${DEPENDENCIES:-}" != installed ] || exit 0

packages_of() {  # names of the packages of one group
  awk -v group="$1" '$1 == group { print $2 }' "$list"
}

wanted=""
for group in "$@"; do
  names=$(packages_of "$group")
  if [ -z "$names" ]; then
    known=$(awk '!/^#/ && NF { print $1 }' "$list" | sort -u | tr '\n' ' ')
    echo "$0: no group named '$group' in $list; there are: $known" >&2
    exit 2
  fi
  wanted="$wanted $names"
done

if ! command -v apt-get >/dev/null 2>&1 || ! command -v dpkg-query >/dev/null 2>&1; then
  {
    echo "This system has no apt, so nothing was installed. abut needs (Debian 12 names, and why):"
    for group in "$@"; do
      awk -v group="$group" \
        '$1 == group { name = $2; $1 = $2 = ""; printf "  %-20s %s\n", name, $0 }' "$list"
    done
    echo "Install their counterparts, then run make again with DEPENDENCIES=installed."
  } >&2
  exit 1
fi

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

missing=""
for name in $wanted; do
  is_installed "$name" || missing="$missing $name"
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null 2>&1; then
    echo "Missing packages, and neither root nor sudo here. Run as root, then try again:" >&2
    echo "  apt-get install --no-install-recommends$missing" >&2
    exit 1
  fi
  as_root=sudo
fi

apt() {  # another apt may hold the lock for a while: wait for it
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 \
    -o Dpkg::Use-Pty=0 "$@"
}

echo "installing:$missing"
apt update
# shellcheck disable=SC2086  # the list is meant to be split
apt install -y --no-install-recommends $missing >/dev/null
