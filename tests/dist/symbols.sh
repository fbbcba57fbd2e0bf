#!/bin/sh
# symbols.sh FOLDER [GLIBC]: every symbol of the C library newer than 2.28 and of the C++ library newer than 3.4.25 (those of the VFX
# Reference Platform of 2026) that a program or library below FOLDER asks the machine for, a line for each: symbol, version, files.
# With GLIBC, fails if one is newer than that.
set -eu
folder=$1 limit=${2-}
list=$(mktemp)
trap 'rm -f "$list"' EXIT
find "$folder" -type f \( -name '*.so*' -o -path '*/bin/*' \) | sort | while read -r file; do
    objdump -T "$file" 2>/dev/null |
        sed -n "s~.*\\*UND\\*.*[ (]\\(GLIBC\\|GLIBCXX\\)_\\([0-9.]*\\))* *\\([^ ]*\\)\$~\\1 \\2 \\3 ${file##*/}~p"
done >"$list"
[ -s "$list" ] || { echo "symbols: nothing found in $folder" >&2; exit 1; }
# newer A B: whether version A is newer than B.
newer() { [ "$1" != "$2" ] && [ "$(printf '%s\n%s\n' "$1" "$2" | sort -V | tail -1)" = "$1" ]; }
status=0
for library in GLIBC GLIBCXX; do
    [ $library = GLIBC ] && aim=2.28 || aim=3.4.25
    for version in $(sed -n "s/^$library \([0-9.]*\) .*/\1/p" "$list" | sort -uV); do
        newer "$version" $aim || continue
        sed -n "s/^$library $version \(.*\)/\1/p" "$list" | sort |
            awk -v v="${library}_$version" '{if ($1 != s) {if (s) print line; s = $1; line = s " " v ":"} line = line " " $2} END {print line}'
        [ $library = GLIBCXX ] || [ -z "$limit" ] || ! newer "$version" "$limit" || status=1
    done
done
[ $status = 0 ] || { echo "symbols: some of these are newer than GLIBC_$limit" >&2; exit 1; }
