#!/usr/bin/env bash
# image.sh: builds the image of packaging/Containerfile and runs the paper's problem in it, as the user of the image.
# The Debian 12 below it is made by debootstrap, so that no registry of images is needed. Needs root, a network, debootstrap and
# buildah, 6 GB of disk, and the time of `make run`.
set -euo pipefail
source=$(readlink -f "$(dirname "$(readlink -f "$0")")/../..")
work=$(mktemp -d) && chmod 755 "$work"
# Containers are folders here (vfs, chroot): this also works inside a container.
in_store() { buildah --root "$work/store" --runroot "$work/run" --storage-driver vfs "$@"; }
trap 'in_store rm --all >/dev/null; in_store rmi --all --force >/dev/null; rm -rf --one-file-system "$work"' EXIT

debootstrap --variant=minbase bookworm "$work/debian" >"$work/log" 2>&1 || { tail -3 "$work/log" && exit 1; }
# The archive settings of this system, if it has special ones.
cp -r /etc/apt/apt.conf.d "$work/debian/etc/apt/"
base=$(in_store from scratch)
in_store add -q "$base" "$work/debian" / >/dev/null
in_store commit -q "$base" docker.io/library/debian:12 >/dev/null
in_store tag docker.io/library/debian:12 docker.io/library/debian:12-slim
in_store rm "$base" >/dev/null && rm -rf --one-file-system "$work/debian"

in_store build --isolation chroot --pull-never -f "$source/packaging/Containerfile" -t apsis "$source" >"$work/log" 2>&1 ||
  { tail -20 "$work/log" && exit 1; }
[ "$(in_store inspect --type image --format '{{.OCIv1.Config.Entrypoint}} {{.OCIv1.Config.User}}' apsis)" = "[apsis] apsis" ]
container=$(in_store from --pull-never apsis)
# `buildah run` does not apply the entry point of the image: the command names the program.
in_store run --isolation chroot "$container" -- apsis run paper/bgk-mixed --out results/bgk-mixed | grep complete
# shellcheck disable=SC2016 # the shell of the container expands it
in_store run --isolation chroot "$container" -- sh -c 'test "$(id -un)" = apsis && test -s results/bgk-mixed/fields.csv'
echo "image built and run"
