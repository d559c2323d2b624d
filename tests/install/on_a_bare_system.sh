#!/usr/bin/env bash
# on_a_bare_system.sh BUILD: installs the Debian packages of BUILD with apt in a minimal Debian 12, runs a case there, and
# builds and runs the consumer against libapsis-dev. Needs root, a network and debootstrap; takes some minutes.
set -euo pipefail
build=$(readlink -f "$1")
here=$(dirname "$(readlink -f "$0")")
root=$(mktemp -d) && chmod 755 "$root"
trap 'rm -rf --one-file-system "$root"' EXIT
debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 || { tail -3 "$root.log" && exit 1; }
# The archive settings of this system, if it has special ones.
cp -r /etc/apt/apt.conf.d "$root/etc/apt/" && cp /etc/resolv.conf "$root/etc/"
(cd "$build" && cpack -B "$root/packages" >/dev/null)
cp -r "$here/consumer" "$root/consumer"
chroot "$root" bash -euo pipefail -c '
  apt-get update -qq
  apt-get install -qq -y --no-install-recommends /packages/apsis_*.deb >/log 2>&1 || { tail /log; exit 1; }
  apsis run paper/ode --out /result | grep complete
  apsis info >/dev/null
  apt-get install -qq -y --no-install-recommends /packages/libapsis-dev_*.deb /packages/libapsis-c[0-9]*_*.deb g++-12 cmake ninja-build >/log 2>&1 || { tail /log; exit 1; }
  cmake -S /consumer -B /built -G Ninja -DCMAKE_CXX_COMPILER=g++-12 -DCMAKE_C_COMPILER=gcc-12 -DCMAKE_BUILD_TYPE=Release >/dev/null
  cmake --build /built >/log && /built/consumer'
rm -f "$root.log"
echo "installed and run on a bare system"
