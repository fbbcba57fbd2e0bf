#!/bin/sh
# make install into an empty folder: the program finds its modules there, the shells complete every option of --help with the values
# of its tables, and make uninstall leaves nothing.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
unset MAKEFLAGS MFLAGS MAKELEVEL
build=$(dirname "$SSDO")
make install BUILD="$build" DESTDIR="$dir" PREFIX=/usr >"$dir/log" 2>&1 || die "make install: $(cat "$dir/log")"
for f in bin/ssdo-filter lib/ssdo-filter/ssdo-images.so lib/ssdo-filter/ssdo-colour.so share/man/man1/ssdo-filter.1 \
    share/bash-completion/completions/ssdo-filter share/zsh/vendor-completions/_ssdo-filter share/doc/ssdo-filter/README.md \
    share/doc/ssdo-filter/examples/slurm.sh share/doc/ssdo-filter/examples/openjd.yaml; do
    [ -s "$dir/usr/$f" ] || die "no $f"
done
"$dir/usr/bin/ssdo-filter" -q samples/still.exr -o "$dir/out.exr" --samples 4 --preview "$dir/out.png" || die "the installed program"

# complete WORD...: what bash offers for the last word, one a line.
cat >"$dir/complete.bash" <<'B'
. "$1"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
compopt() { :; } # works only while bash completes
_ssdo_filter
printf '%s\n' "${COMPREPLY[@]}"
B
complete() { bash "$dir/complete.bash" "$dir/usr/share/bash-completion/completions/ssdo-filter" ssdo-filter "$@" | sort -u | tr '\n' ' '; }
"$SSDO" --help | sed -n 's/^  *\(-., \)*--\([a-z-]*\).*/--\2/p' | sort -u | tr '\n' ' ' >"$dir/options"
[ "$(complete --)" = "$(cat "$dir/options")" ] || die "bash offers $(complete --), help has $(cat "$dir/options")"
methods=$("$SSDO" samples/still.exr -o "$dir/none.exr" --method none 2>&1 | sed 's/.*methods are //; s/,//g' | tr ' ' '\n' | sort | tr '\n' ' ')
case $methods in *raytrace*) ;; *) die "the methods are said to be $methods" ;; esac
[ "$(complete --method "")" = "$methods" ] || die "methods: $(complete --method "") instead of $methods"
[ "$(complete --method h)" = "hbao hemisphere " ] || die "methods: $(complete --method h)"
[ "$(complete --method = h)" = "hbao hemisphere " ] || die "--method=: $(complete --method = h)"
[ "$(complete --layers occlusion,ind)" = "occlusion,indirect " ] || die "layers: $(complete --layers occlusion,ind)"
[ "$(complete samples/hor)" = "samples/horizon.exr samples/horizon_truth.exr " ] || die "inputs: $(complete samples/hor)"
[ "$(complete --radius 0)" = " " ] || die "a number is completed: $(complete --radius 0)"
for option in $(cat "$dir/options"); do
    grep -q -- "$option[^a-z-]" "$dir/usr/share/zsh/vendor-completions/_ssdo-filter" || die "zsh does not know $option"
done
command -v zsh >/dev/null 2>&1 && { zsh -n "$dir/usr/share/zsh/vendor-completions/_ssdo-filter" || die "zsh cannot read its completion"; }

make uninstall BUILD="$build" DESTDIR="$dir" PREFIX=/usr >"$dir/log" 2>&1 || die "make uninstall: $(cat "$dir/log")"
[ -z "$(find "$dir/usr" ! -type d)" ] || die "uninstall leaves $(find "$dir/usr" ! -type d)"
[ -z "$(find "$dir/usr" -path '*ssdo-filter*')" ] || die "uninstall leaves folders"
