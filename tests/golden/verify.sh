#!/bin/sh
# --verify: a bit that changes on its way to the disk is found wherever it belongs to the input, and then nothing is kept; without
# --verify nobody notices. The bit is flipped by a library that stands between the program and pwrite.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; cat "$dir/said" 2>/dev/null; exit 1; }
cat >"$dir/flip.c" <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
ssize_t pwrite(int fd, const void *from, size_t n, off_t offset)
{
    static ssize_t (*real)(int, const void *, size_t, off_t);
    const char *text = getenv("FLIP_AT");
    off_t at = text ? atoll(text) : -1;
    if (!real) real = (ssize_t(*)(int, const void *, size_t, off_t))dlsym(RTLD_NEXT, "pwrite");
    if (at < offset || at >= offset + (off_t)n) return real(fd, from, n, offset);
    char *copy = malloc(n);
    memcpy(copy, from, n);
    copy[at - offset] ^= 1;
    ssize_t done = real(fd, copy, n, offset);
    free(copy);
    return done;
}
ssize_t pwrite64(int fd, const void *from, size_t n, off_t offset) { return pwrite(fd, from, n, offset); }
END
${CC:-cc} -shared -fPIC -o "$dir/flip.so" "$dir/flip.c" -ldl || die "no compiler"

filter() { "$SSDO" "$1" -o "$dir/out.exr" --layers occlusion --samples 4 --compression "$2" -v $3 >"$dir/said" 2>&1; }
flipped() { # AT INPUT COMPRESSION OPTIONS
    FLIP_AT=$1 LD_PRELOAD=$dir/flip.so export FLIP_AT LD_PRELOAD
    filter "$2" "$3" "$4"
    code=$?
    unset FLIP_AT LD_PRELOAD
}
# found WHAT AT INPUT COMPRESSION OPTIONS: exit 4 naming it, an older output untouched.
found() {
    echo older >"$dir/out.exr"
    flipped "$2" "$3" "$4" "$5 --verify"
    [ $code = 4 ] || die "$1: exit $code"
    grep -q -- "$1" "$dir/said" || die "$1 is not named"
    [ "$(cat "$dir/out.exr")" = older ] && [ -z "$(find "$dir" -name '.out*')" ] || die "$1: the older output is gone, or a temporary file is left"
}
V=ViewLayer
oiiotool samples/still.exr --cut 120x80+100+60 --ch "P.X=$V.Position.X,P.Y=$V.Position.Y,P.Z=$V.Position.Z,Z=$V.Depth.Z,R=$V.Combined.R,G=$V.Combined.G,B=$V.Combined.B,A=$V.Combined.A" \
    --attrib owner somebody -o "$dir/in.exr" >/dev/null 2>&1 || die oiiotool
filter "$dir/in.exr" none "--verify" || die "a sound run"
grep -q -- '--verify: 8 channels and all attributes' "$dir/said" || die "nothing was compared"
size=$(stat -c %s "$dir/out.exr")
owner=$(grep -abo somebody "$dir/out.exr" | head -1 | cut -d: -f1)
ours=$((size - 1)) theirs=$((size - 120 * 2 - 1)) # the last line's last channel is occlusion.R, in halves; before it is Z

flipped $theirs "$dir/in.exr" none ""
[ $code = 0 ] || die "a flipped bit is noticed without --verify: exit $code"
flipped $ours "$dir/in.exr" none "--verify"
[ $code = 0 ] || die "our own layer is nobody's to compare: exit $code"
found "the channel 'Z'" $theirs "$dir/in.exr" none ""
found "the attribute '" "$owner" "$dir/in.exr" none ""
found "the written file" $((size / 4)) "$dir/in.exr" zip ""

# Several parts, and a deep one.
oiiotool "$dir/in.exr" --ch A,Z --deepen --eraseattrib '.*' --attrib oiio:subimagename deep -o "$dir/deep.exr" >/dev/null 2>&1 || die --deepen
oiiotool "$dir/in.exr" --attrib oiio:subimagename flat -o "$dir/flat.exr" >/dev/null 2>&1
exrmultipart -combine -i "$dir/flat.exr" "$dir/deep.exr" -o "$dir/mixed.exr" -override 1 >/dev/null 2>&1 || die exrmultipart
filter "$dir/mixed.exr" none "--verify" || die "a deep part beside the flat one"
size=$(stat -c %s "$dir/out.exr")
found "the deep part 'deep'" $((size - 1)) "$dir/mixed.exr" none ""
filter "$dir/mixed.exr" none "--verify --layout multipart" || die "parts as they are"
exit 0
