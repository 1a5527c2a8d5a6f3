#!/bin/sh
# What scripts/test_package.sh does inside the bare system.
set -eu

step() { echo "== $*"; }
fail() { echo "FAILED: $*" >&2; exit 1; }
install() {
  DEBIAN_FRONTEND=noninteractive apt-get -qq -o Dpkg::Use-Pty=0 install -y \
    --no-install-recommends "$@" >/tmp/apt.log 2>&1 || { tail -n 20 /tmp/apt.log; fail "apt"; }
}
as_user() { su user -s /bin/bash -c "$*"; }
ours() {  # files that no other package has
  find / -xdev -iname '*abut*' | grep -v '^/srv/\|^/packages\|^/proc/' | sort
}

apt-get -qq update
step "abut alone"
install /packages/abut_*.deb
useradd --create-home --home-dir /srv/user user
as_user abut --version
as_user abut report --version | grep -q '^commit ' || fail "report tells no commit"
as_user abut study --version | grep -q '^commit ' || fail "study tells no commit"

step "the demo, a mesh, a report, a study, as a user"
scenes=/usr/share/abut/configs
as_user "cd && abut run $scenes/two_bars.yaml --quiet && abut report runs/two_bars"
grep -q '<canvas' /srv/user/runs/two_bars/report.html || fail "the report has no figures"
as_user "cd && abut run $scenes/solids/gmsh_part.yaml --quiet --set output.fields.every=1"
[ -s /srv/user/runs/gmsh_part/fields.pvd ] || fail "no fields"
as_user "cd && abut study /usr/share/abut/studies/two_bars_window.yaml --quick --quiet"
[ -s /srv/user/runs/two_bars_window/index.html ] || fail "no page of the study"
if as_user "cd && abut run $scenes/nothing.yaml" 2>/tmp/said; then fail "no scene, no error"; fi
grep -q '^error: ' /tmp/said || fail "no words for a scene that is not there"

step "man pages and completions"
install man-db bash-completion zsh
pages="abut abut-run abut-check abut-split abut-reference abut-report abut-study abut-solver"
for page in $pages; do
  man -w "$page" >/dev/null || fail "no man page of $page"
done
MANWIDTH=300 man abut-run | grep -q 'use this value in place of the scene' ||
  fail "abut-run(1) says too little"
cat >/tmp/complete.bash <<'END'
source /usr/share/bash-completion/bash_completion
_completion_loader abut
complete -p abut >/dev/null || exit 1
compopt() { :; }
COMP_LINE="abut run $1 --set bodies.left.mat" COMP_POINT=${#COMP_LINE} _abut
printf '%s\n' "${COMPREPLY[@]}"
END
as_user "bash /tmp/complete.bash $scenes/two_bars.yaml" | grep -qxF bodies.left.material. ||
  fail "bash completes no key"
[ "$(as_user "zsh -fc 'autoload -U compinit; compinit -u -D; print \$_comps[abut]'")" = _abut ] ||
  fail "zsh finds no completion"

step "a solver in C++ that links libabut-dev"
install /packages/libabut-dev_*.deb g++ cmake make
cp -r /usr/share/doc/abut/examples /srv/user/examples
chown -R user /srv/user/examples
as_user "cd ~/examples/cpp_body && cmake -B build >/dev/null && cmake --build build >/dev/null"
program=/srv/user/examples/cpp_body/build/mass_on_spring
as_user "cd ~/examples && abut run python_body/bar_meets_mass.yaml --quiet \
  --set network.endpoint=null --set 'bodies.mass.launch={spawn: {program: $program}}'"
as_user "cd ~/examples/cpp_body && g++ -std=c++17 mass_on_spring.cpp -o by_pkg_config \
  \$(pkg-config --cflags --libs abut-sdk)"
[ -f "$(pkg-config --variable=protodir abut)/abut/v1/subdomain.proto" ] || fail "no protocol"

step "removed again"
apt-get -qq -o Dpkg::Use-Pty=0 purge -y abut libabut-dev >/dev/null
left=$(ours)
[ -z "$left" ] || fail "left behind: $left"
