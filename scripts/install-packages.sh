#!/usr/bin/env bash
# install-packages.sh GROUP: installs missing Debian packages of a group of packages.txt.
# Does nothing, and asks for nothing, if all are installed; never removes a package. States before it installs what it installs and
# with whose rights. With NO_INSTALL=1 in the environment it names the missing packages and installs nothing.
set -euo pipefail
here=$(dirname "$(readlink -f "$0")")

packages_of() {
  local word
  while read -r word; do
    case $word in
      @*) packages_of "${word#@}" ;;
      *) echo "$word" ;;
    esac
  done < <(awk -v group="$1" '$1 == group { for (i = 2; i <= NF; ++i) print $i }' "$here/packages.txt")
}

installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

group=${1:-run}
mapfile -t packages < <(packages_of "$group")
if [ ${#packages[@]} -eq 0 ]; then
  echo "install-packages.sh: no group '$group' (packages.txt does not name it); valid: run, python, deb, docs, mpi, test, ci, dev" >&2
  exit 2
fi
if ! command -v dpkg-query >/dev/null; then
  echo "install-packages.sh: cannot check packages (this is not Debian); provide: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  installed "$package" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

if [ "${NO_INSTALL:-0}" != 0 ]; then
  echo "install-packages.sh: packages are missing (NO_INSTALL=$NO_INSTALL); the build needs their contents: ${missing[*]}" >&2
  exit 0
fi
root=()
rights="your rights (root)"
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "install-packages.sh: packages are missing (and they need root or sudo); as root run:" \
      "apt-get install ${missing[*]}; or build without installing: make … NO_INSTALL=1" >&2
    exit 2
  fi
  root=(sudo)
  rights="root's rights, which sudo grants you"
fi
echo "This installs Debian packages with $rights: ${missing[*]}"
echo "To install nothing, stop here and add NO_INSTALL=1: make program NO_INSTALL=1"
"${root[@]}" apt-get update -qq
"${root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -qq -y --no-install-recommends --no-remove -o Dpkg::Use-Pty=0 "${missing[@]}" >/dev/null
