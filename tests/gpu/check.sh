#!/bin/sh
# check.sh ARCHIVE SUITE...: the archive of make gpu-bundle in fresh Debian roots that have Mesa's driver packages and nothing of ours.
set -u
. tests/systems/root.sh
root_here || exit 77
archive=$1 folder=$(mktemp -d) failed=0
shift
root=$folder/root
trap 'root_leave "$root"; rmdir "$folder"' EXIT
trap 'exit 130' INT TERM
for suite in "$@"; do
    root_make "$suite" "$root" libegl1 libegl-mesa0 libgl1-mesa-dri libopengl0 xz-utils || { echo "FAILED $suite: debootstrap"; failed=1; continue; }
    cp "$archive" "$root/tmp/a.tar.xz"
    if root_run "$root" 1000:1000 'mkdir /tmp/work && cd /tmp/work && tar xf ../a.tar.xz && sh gpu-bundle/run.sh out' >"$folder/log" 2>&1; then
        echo "ok $suite: $(tail -1 "$folder/log")"
    else
        failed=1
        echo "FAILED $suite: $(tail -5 "$folder/log")"
    fi
    rm -f "$folder/log"
    root_leave "$root"
done
exit $failed
