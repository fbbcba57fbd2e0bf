#!/bin/sh
# deps.sh [--quiet] PACKAGE...: installs the Debian packages that are missing; does nothing when all are there.
set -eu
quiet=
[ "${1-}" = --quiet ] && { quiet=1; shift; }
if ! command -v dpkg-query >/dev/null 2>&1; then
    [ -n "$quiet" ] || echo "deps: not a Debian machine; needed are: $*"
    exit 0
fi
missing=
for p in "$@"; do
    case $(dpkg-query -W -f '${Status}' "$p" 2>/dev/null || true) in
    *" installed") ;;
    *) missing="$missing $p" ;;
    esac
done
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
if ! { $sudo apt-get update && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing; } >"$log" 2>&1; then
    tail -20 "$log" >&2
    echo "deps: apt-get could not install:$missing" >&2
    exit 1
fi
