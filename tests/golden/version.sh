#!/bin/sh
# The version that a source says: of a tarball, of a clone without tags, at a tag, after it, and with changed files. The program
# says the version that it was built from.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
unset GIT_DIR GIT_WORK_TREE GIT_INDEX_FILE
says() { # WANTED WHEN
    got=$(sh "$dir/source/tests/version.sh") || die "$2: no version"
    [ "$(echo "$got" | sed 's/-g[0-9a-f]\{7,\}/-gCOMMIT/')" = "$1" ] || die "$2: $got instead of $1"
}
mkdir -p "$dir/source/tests" && cp tests/version.sh "$dir/source/tests" && echo 7.8.9 >"$dir/source/VERSION"
says 7.8.9 "a tarball"
g() { where=$1 && shift && git -C "$where" -c user.name=t -c user.email=t@t -c commit.gpgSign=false -c tag.gpgSign=false "$@" >"$dir/log" 2>&1 || die "git $*: $(cat "$dir/log")"; }
git init -q "$dir" 2>/dev/null || die "git init"
g "$dir" commit --allow-empty -m other
says 7.8.9 "a tarball inside another repository"
git init -q "$dir/source"
g "$dir/source" add .
g "$dir/source" commit -m one
says 7.8.9-gCOMMIT "no tag"
touch "$dir/source/VERSION"
says 7.8.9-gCOMMIT "a file only touched"
g "$dir/source" tag other-name
says 7.8.9-gCOMMIT "a tag that is no version"
g "$dir/source" tag v1.2.3
says 1.2.3 "at a tag"
g "$dir/source" commit --allow-empty -m two
says 1.2.3-1-gCOMMIT "after a tag"
echo >>"$dir/source/VERSION"
says 1.2.3-1-gCOMMIT-dirty "changed files"
[ "$("$SSDO" --version)" = "ssdo-filter $(cat "$(dirname "$SSDO")/version")" ] || die "the program says $("$SSDO" --version)"
