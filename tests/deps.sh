#!/bin/sh
# deps.sh [--quiet] PACKAGE...: installs the Debian packages that are missing; does nothing when all are there.
# A/B stands for the first of A and B that the release has: names that hold a version differ between releases.
set -eu
quiet=
[ "${1-}" = --quiet ] && { quiet=1; shift; }
if ! command -v dpkg-query >/dev/null 2>&1; then
    [ -n "$quiet" ] || echo "deps: not a Debian machine; needed are: $*"
    exit 0
fi
installed() {
    case $(dpkg-query -W -f '${Status}' "$1" 2>/dev/null || true) in
    *" installed") return 0 ;;
    esac
    return 1
}
# one_of A/B/...: succeeds if one is installed.
one_of() {
    for name in $(echo "$1" | tr / ' '); do
        installed "$name" && return 0
    done
    return 1
}
# offered A/B/...: the first that the package lists know, or the first.
offered() {
    for name in $(echo "$1" | tr / ' '); do
        [ -n "$(apt-cache madison "$name" 2>/dev/null)" ] && { echo "$name"; return; }
    done
    echo "${1%%/*}"
}
missing=
for p in "$@"; do one_of "$p" || missing="$missing $p"; done
[ -z "$missing" ] && exit 0
sudo=
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null 2>&1 || { echo "deps: missing:$missing; install them as root (no sudo here)" >&2; exit 1; }
    sudo=sudo
fi
echo "deps: will install:$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# A stale package list names versions the mirror no longer has, so it is refreshed first.
$sudo apt-get update >"$log" 2>&1 || { tail -20 "$log" >&2; echo "deps: apt-get could not read its package lists" >&2; exit 1; }
chosen=
for p in $missing; do chosen="$chosen $(offered "$p")"; done
if ! $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $chosen >"$log" 2>&1; then
    tail -20 "$log" >&2
    echo "deps: apt-get could not install:$chosen" >&2
    exit 1
fi
