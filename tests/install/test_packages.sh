#!/usr/bin/env bash
# test_packages.sh BUILD WORK: builds the Debian packages and checks their contents.
set -euo pipefail
commands=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../app/commands" && ls)
build=$1 work=$2
rm -rf "$work" && mkdir -p "$work/root"
(cd "$build" && cpack -B "$work" >"$work/cpack.log") || { cat "$work/cpack.log" && exit 1; }
program=$(echo "$work"/apsis_*.deb) development=$(echo "$work"/libapsis-dev_*.deb) c_library=$(echo "$work"/libapsis-c[0-9]*_*.deb)

depends=$(dpkg-deb -f "$program" Depends)
for library in libhdf5 libhwy libc6; do
  grep -q "$library" <<<"$depends" || { echo "$library is not among the dependencies: $depends" && exit 1; }
done
dpkg-deb -f "$development" Depends | grep -q libhdf5-dev

# The library of the C interface is a package of its own, which the other two packages do not contain.
depends=$(dpkg-deb -f "$c_library" Depends)
grep -q libstdc++6 <<<"$depends" || { echo "libstdc++6 is not among the dependencies: $depends" && exit 1; }
dpkg-deb -c "$c_library" | grep 'libapsis_c\.so\.[0-9]* ->' >/dev/null
dpkg-deb -c "$development" | grep 'libapsis_c\.so ->' >/dev/null
dpkg-deb -f "$development" Depends | grep -q "$(dpkg-deb -f "$c_library" Package) (= $(dpkg-deb -f "$c_library" Version))"
if dpkg-deb -c "$program" | grep libapsis_c; then exit 1; fi

# Libraries for frameworks are others, which other users of the library do not need.
for framework in sundials petsc; do
  library=$(ls "$work"/libapsis-$framework[0-9]*_*.deb 2>/dev/null) || continue
  grep -q "lib$framework" <<<"$(dpkg-deb -f "$library" Depends)"
  dpkg-deb -c "$library" | grep "libapsis_$framework\.so\.[0-9]* ->" >/dev/null
  if dpkg-deb -f "$development" Depends | grep "$framework"; then exit 1; fi
done

dpkg-deb -x "$program" "$work/root"
cd "$work"
apsis=$work/root/usr/bin/apsis
"$apsis" run paper/ode --out result >summary.txt
grep -q complete summary.txt
"$apsis" info >/dev/null

# The manual page names every command, and the completion offers commands and cases.
page=$work/root/usr/share/man/man1/apsis.1
for command in ${commands//.cpp/}; do
  grep -q "^.SH apsis $command\$" "$page" || { echo "no apsis $command in the manual page" && exit 1; }
done
PATH=$work/root/usr/bin:$PATH bash -c '
  source root/usr/share/bash-completion/completions/apsis
  complete_line() { COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); COMPREPLY=(); _apsis; echo "${COMPREPLY[*]}"; }
  [[ $(complete_line apsis conv) = converge ]]
  [[ $(complete_line apsis run paper/bgk-mixed --res) = --restart ]]
  [[ $(complete_line apsis run paper/bgk-mixed-r) = paper/bgk-mixed-reference ]]
  [[ $(complete_line apsis check md-imex-6-3) = md-imex-6-3 ]]
  [[ $(complete_line apsis list fam) = families ]]'
