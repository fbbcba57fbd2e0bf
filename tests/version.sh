#!/bin/sh
# version.sh: the version of this source, from git where there is a tag of the form v1.2.3 (1.2.3, or 1.2.3-4-gabc1234 four commits
# later); from the file VERSION where there is none: with the commit behind it in a clone, as it is in a tarball. -dirty: tracked
# files differ from the commit.
set -eu
cd "$(dirname "$0")/.."
file=$(cat VERSION)
# A tarball unpacked inside somebody else's repository has no history of its own.
if [ "$(git rev-parse --show-prefix 2>/dev/null || echo none)" != "" ] || ! commit=$(git rev-parse --short HEAD 2>/dev/null); then
    echo "$file"
    exit
fi
dirty=
git diff --quiet HEAD 2>/dev/null || dirty=-dirty
if tagged=$(git describe --tags --match 'v[0-9]*' 2>/dev/null); then
    echo "${tagged#v}$dirty"
else
    echo "$file-g$commit$dirty"
fi
