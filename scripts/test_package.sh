#!/bin/sh
# Installs the packages of `make package` on a bare Debian 12 and uses them there as somebody would:
# the demo, a mesh, a report, a study, man pages, completions, a solver in C++ that links them; then
# removes them and looks for what is left. Needs root, debootstrap and a Debian mirror; changes
# nothing outside a temporary folder.
#   usage: scripts/test_package.sh [FOLDER]      default: build/release/packages
#   environment: MIRROR (default: the one that apt uses here), KEEP=1 (leaves the system there)
set -eu
cd "$(dirname "$0")/.."

packages=${1:-build/release/packages}
[ "$(id -u)" -eq 0 ] || { echo "$0: is for root: it makes a system of its own" >&2; exit 2; }
command -v debootstrap >/dev/null ||
  { echo "$0: install Debian's package debootstrap" >&2; exit 2; }
ls "$packages"/abut_*.deb "$packages"/libabut-dev_*.deb >/dev/null 2>&1 ||
  { echo "$0: no packages in $packages: run make package first" >&2; exit 2; }
mirror=${MIRROR:-$(apt-get indextargets --format '$(SITE)' 'Codename: bookworm' 'Component: main' |
  sort -u | head -n 1)}

root=$(mktemp -d)
chmod 755 "$root"
clean() {
  umount "$root/proc" 2>/dev/null || true
  if [ "${KEEP:-}" = 1 ]; then echo "the system is in $root"; return; fi
  rm -rf --one-file-system "$root"
}
trap clean EXIT
trap 'exit 1' INT TERM

echo "bare Debian 12 from $mirror"
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 ||
  { tail -n 20 "$root.log"; exit 1; }
rm -f "$root.log"
cp /etc/resolv.conf "$root/etc/" 2>/dev/null || true
mount -t proc proc "$root/proc"
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"
chmod 755 "$root/packages"
cp scripts/test_package_inside.sh "$root/inside.sh"
chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  ${http_proxy:+http_proxy="$http_proxy"} sh /inside.sh
echo "all of it works on a bare Debian 12"
