#!/bin/sh
# check.sh SUITE...: README's two commands in fresh roots of Debian releases (debootstrap), on a copy of the tracked files. A line for
# each command with its time; the log of one that failed stays in build/systems. Takes about 30 minutes a release.
set -u
. tests/systems/root.sh
root_here || exit 77
out=$PWD/build/systems folder=$(mktemp -d) failed=0
mkdir -p "$out"
trap 'root_leave "$folder/root"; rmdir "$folder"' EXIT
trap 'exit 130' INT TERM
for suite in "$@"; do
    root=$folder/root
    root_make "$suite" "$root" ca-certificates make git || { echo "FAILED  $suite: debootstrap"; failed=1; continue; }
    mkdir "$root/source"
    git ls-files | tar c -T - | tar x -C "$root/source"
    for command in 'make demo' 'make check'; do
        begin=$(date +%s) log=$out/$suite-${command#make }.log
        if root_run "$root" 0:0 "cd /source && HOME=/root $command" >"$log" 2>&1; then said=ok; else said=FAILED failed=1; fi
        echo "$said $suite: $command, $(($(date +%s) - begin)) s: $(tail -n 1 "$log")"
    done
    root_leave "$root"
done
exit $failed
