#!/bin/sh
# make.sh BUILD VERSION: Debian packages of the committed source, in BUILD/deb, and what lintian says of them.
set -eu
build=$(cd "$1" && pwd) version=$2
# A native package's version has no hyphen: 0.2.0-4-gabc1234 becomes 0.2.0+4.gabc1234.
plain=$(echo "$version" | sed 's/-/+/; s/-/./g')
to=$build/deb
tree=$to/ssdo-filter-$plain
rm -rf "$to"
mkdir -p "$tree"
git archive HEAD | tar -x -C "$tree"
echo "$version" >"$tree/VERSION"
sed -i "1s/(.*)/($plain)/" "$tree/debian/changelog"
(cd "$tree" && dpkg-buildpackage -b -us -uc) >"$to/log" 2>&1 || { tail -30 "$to/log" >&2; exit 1; }
# The authors publish no mail address, so there is none to give; the packages go to no archive that would write to it.
lintian --allow-root --fail-on error,warning --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog "$to"/*.changes
ls "$to"/*.deb
