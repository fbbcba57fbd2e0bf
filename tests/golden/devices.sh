#!/bin/sh
# A software device has its reason, which a farm can ask for as an error; a debug context tells where a shader is wrong, and changes
# no byte.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
die() { echo "FAILED: $*"; exit 1; }
export XDG_CACHE_HOME="$dir/cache" # a program from the cache would not be compiled
mkdir "$dir/cache"
run() { "$SSDO" samples/still.exr --samples 2 --method ssdo --layers occlusion --keep none "$@"; }

run -q -o "$dir/a.exr" --report "$dir/report" || die "the plain run"
run -q -o "$dir/required.exr" --require-gpu 2>"$dir/err"
code=$?
if grep -q '"why_software":"..*"' "$dir/report" || grep -q '"why_software": "..*"' "$dir/report"; then
    [ $code = 5 ] || die "--require-gpu gave exit code $code on a software device"
    why=$(sed -n 's/.*"why_software": *"\([^"]*\)".*/\1/p' "$dir/report" | sed 's|\\/|/|g')
    grep -qF "runs on the CPU: $why" "$dir/err" || die "--require-gpu does not say why: $(cat "$dir/err")"
    [ ! -e "$dir/required.exr" ] || die "--require-gpu left an output"
    "$SSDO" --list-devices | grep -q '^note: ' || die "--list-devices does not say why"
    # A device that is named, and is software, is none either.
    run -q -o "$dir/required.exr" --require-gpu --device 0 2>"$dir/err"
    code=$?
    [ $code = 5 ] || die "--require-gpu --device 0 gave exit code $code"
    grep -q 'device 0 names it' "$dir/err" || die "--device 0: $(cat "$dir/err")"
else
    [ $code = 0 ] || die "--require-gpu gave exit code $code on hardware: $(cat "$dir/err")"
fi

run -q -o "$dir/b.exr" --gpu-debug 2>"$dir/err" || die "--gpu-debug: $(cat "$dir/err")"
cmp "$dir/a.exr" "$dir/b.exr" || die "--gpu-debug changes the output"

# A wrong line, behind a part that is left out here.
cp -r shaders "$dir/shaders"
line=$(grep -n '^void main' shaders/ssdo.comp | cut -d: -f1)
sed -i "${line}s/^/@ /" "$dir/shaders/ssdo.comp"
SSDO_SHADER_DIR=$dir/shaders run -o "$dir/c.exr" -v --gpu-debug 2>"$dir/err"
code=$?
[ $code = 5 ] || die "exit code $code with a wrong shader"
grep -q "^ssdo-filter: ssdo.comp:$line: the driver refuses shader ssdo.comp: " "$dir/err" || die "no place: $(cat "$dir/err")"
grep -q "^ssdo-filter: shader ssdo.comp: ssdo.comp:$line: " "$dir/err" || die "no log: $(cat "$dir/err")"
grep -q "^ssdo-filter: gpu error in ssdo: ssdo.comp:$line: " "$dir/err" || echo "figure: this driver's debug messages do not tell of shaders"
[ ! -e "$dir/c.exr" ] || die "an output is left"

# Without EGL, or without the library of OpenGL's functions: libepoxy would end the process.
cat >"$dir/without.c" <<'C'
#include <dlfcn.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
void *dlopen(const char *name, int flags);
void *dlopen(const char *name, int flags)
{
    void *(*next)(const char *, int);
    *(void **)&next = dlsym(RTLD_NEXT, "dlopen");
    const char *left_out = getenv("LEFT_OUT");
    for (size_t n; name && *(left_out += strspn(left_out, " ")); left_out += n)
        if (n = strcspn(left_out, " "), strncmp(name, left_out, n) == 0 && !name[n]) return NULL;
    return next(name, flags);
}
C
${CC:-cc} -D_GNU_SOURCE -shared -fPIC -o "$dir/without.so" "$dir/without.c" -ldl || die "no compiler"
for missing in libEGL.so.1 'libOpenGL.so.0 libGL.so.1'; do
    LEFT_OUT=$missing LD_PRELOAD=$dir/without.so run -q -o "$dir/none.exr" 2>"$dir/err"
    code=$?
    [ $code = 5 ] || die "without $missing: exit code $code: $(cat "$dir/err")"
    grep -q "${missing%% *}.* can.* be loaded; install" "$dir/err" || die "without $missing: $(cat "$dir/err")"
    LEFT_OUT=$missing LD_PRELOAD=$dir/without.so "$SSDO" --list-devices >"$dir/said" || die "--list-devices without $missing"
done
