#!/bin/sh
# Faults around the program: a full disk, a target that cannot be written, renamed or found, no memory, no GL, a lost context, a
# killed batch. In every case: the documented exit code and one sentence, never a partial file under the target's name, the input
# as it was, and a next run that completes. SSDO_HARD=whole tries every allocation and 200 kills.
set -u
dir=$(mktemp -d)
build=$(dirname "$SSDO")
mounted=
cleanup() {
    chmod -R u+w "$dir" 2>/dev/null
    [ -n "$mounted" ] && umount "$dir/small"
    rm -rf "$dir"
}
trap cleanup EXIT
die() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; exit 1; }
oiiotool samples/still.exr --cut 96x72+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" >/dev/null || die oiiotool
cp "$dir/in.exr" "$dir/kept.exr"
args="-q $dir/in.exr --samples 8 --threads 2"
"$SSDO" $args -o "$dir/good.exr" 2>"$dir/err" || die "the clean run"
size=$(stat -c %s "$dir/good.exr")

# whole FILE WHAT: a file of ours that is there is a whole one.
whole() { cmp -s "$1" "$dir/good.exr" || die "$2: a partial or different file under the target's name"; }
# failed CODE TEXT WHAT: the last run's exit code, one sentence with TEXT, the input untouched.
failed() {
    [ "$code" = "$1" ] || die "$3: exit code $code, not $1"
    [ "$(wc -l <"$dir/err")" = 1 ] && grep -qF -- "$2" "$dir/err" || die "$3: the sentence"
    cmp -s "$dir/in.exr" "$dir/kept.exr" || die "$3: the input changed"
}
run() { "$SSDO" $args "$@" 2>"$dir/err" >/dev/null; code=$?; }

# --- a disk that fills up at any point of the file ---
full=0
mkdir "$dir/small"
if mount -t tmpfs -o size=512k none "$dir/small" 2>/dev/null; then
    mounted=1
    for room in 0 1 2 3 5 8 13 21 34 55 $((size / 1024 - 12)); do # kilobytes left; tmpfs counts pages of 4
        rm -f "$dir"/small/*
        mount -o remount,size=$((4 * ((room + 3) / 4 + 2)))k "$dir/small" || die remount
        dd if=/dev/zero of="$dir/small/ballast" bs=4096 count=1 2>/dev/null
        run -o "$dir/small/out.exr"
        failed 4 "No space left" "a full disk with $room kB left"
        [ "$(ls -A "$dir/small")" = ballast ] || die "a full disk left something behind: $(ls -A "$dir/small")"
        full=$((full + 1))
    done
    rm -f "$dir"/small/*
    mount -o remount,size=4096k "$dir/small"
    run -o "$dir/small/out.exr"
    [ $code = 0 ] || die "the run after the full disk"
    whole "$dir/small/out.exr" "the run after the full disk"
    mount -o remount,ro "$dir/small"
    run -o "$dir/small/out.exr"
    failed 4 "Read-only" "a read-only disk"
    whole "$dir/small/out.exr" "a read-only disk"
fi

# --- targets ---
targets=0
run -o "$dir/none/out.exr"; failed 4 "none" "a missing folder"
mkdir "$dir/folder.exr"; run -o "$dir/folder.exr"; failed 4 "folder" "a folder as target"
mkfifo "$dir/pipe.exr"; run -o "$dir/pipe.exr"; failed 4 "regular" "a pipe as target"
run -o /dev/full; failed 4 "/dev/full" "a device as target"
targets=4
cat >"$dir/fault.c" <<'C'
// Preloaded: calls that fail as SSDO_FAULT says, and a GL that loses its context or runs out of memory at the n-th glFinish.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static int starts(const char *text, const char *with) // strcmp may be a sanitizer's, which asks dlsym before it is ready
{
    while (*with && *text == *with) text++, with++;
    return !*with;
}
static int same(const char *a, const char *b) { return starts(a, b) && starts(b, a); }
static int fault(const char *name)
{
    const char *f = getenv("SSDO_FAULT");
    return f && same(f, name);
}
int rename(const char *a, const char *b)
{
    int (*real)(const char *, const char *) = (int (*)(const char *, const char *))dlsym(RTLD_NEXT, "rename");
    if (!fault("rename")) return real(a, b);
    errno = EXDEV;
    return -1;
}
int fsync(int fd)
{
    int (*real)(int) = dlsym(RTLD_NEXT, "fsync");
    char path[64], name[4096];
    if (fault("fsync")) {
        errno = EIO;
        return -1;
    }
    if (!fault("vanish")) return real(fd);
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    ssize_t n = readlink(path, name, sizeof name - 1);
    if (n > 0) {
        name[n] = 0;
        unlink(name); // somebody cleans the folder while we write
    }
    return real(fd);
}
static int countdown(void)
{
    static int at;
    const char *n = getenv("SSDO_FAULT_AT");
    return ++at >= (n ? atoi(n) : 1);
}
static unsigned lost(void) { return countdown() ? 0x8253u : 0u; /* GL_GUILTY_CONTEXT_RESET */ }
static unsigned out_of_memory(void)
{
    static int said;
    if (!countdown() || said) return 0;
    said = 1;
    return 0x0505u; /* GL_OUT_OF_MEMORY */
}
static void *no_context(void) { return NULL; }
static void *(*egl_lookup)(const char *);
static void *stand_in(const char *name);
static void *lookup(const char *name)
{
    void *mine = stand_in(name);
    return mine ? mine : egl_lookup(name);
}
static void *stand_in(const char *name)
{
    if (fault("context") && same(name, "eglCreateContext")) return (void *)no_context;
    if (fault("lost") && starts(name, "glGetGraphicsResetStatus")) return (void *)lost;
    if (fault("memory") && same(name, "glGetError")) return (void *)out_of_memory;
    return NULL;
}
// epoxy finds GL and EGL by dlsym on the libraries' handles, and by eglGetProcAddress.
void *dlsym(void *handle, const char *name)
{
    static void *(*real)(void *, const char *);
    if (!real) real = (void *(*)(void *, const char *))dlvsym(RTLD_NEXT, "dlsym", "GLIBC_2.2.5");
    void *mine = stand_in(name);
    if (mine) return mine;
    if (!fault("none") && same(name, "eglGetProcAddress") && getenv("SSDO_FAULT")) {
        egl_lookup = (void *(*)(const char *))real(handle, name);
        return (void *)lookup;
    }
    return real(handle, name);
}
C
if ${CC:-gcc} -shared -fPIC -O1 -o "$dir/fault.so" "$dir/fault.c" -ldl 2>"$dir/err"; then
    # A sanitizer looks for its own names after the library whose dlsym it gets, so it comes first.
    sanitizer=$(ldd "$SSDO" | sed -n 's/.*=> \(.*lib[at]san[^ ]*\).*/\1/p')
    inject() { # FAULT CODE TEXT
        rm -f "$dir/out.exr"
        SSDO_FAULT=$1 SSDO_FAULT_AT=${4:-1} LD_PRELOAD="$sanitizer $dir/fault.so" "$SSDO" $args -o "$dir/out.exr" 2>"$dir/err" >/dev/null
        code=$?
        failed "$2" "$3" "injected: $1"
        [ ! -e "$dir/out.exr" ] && [ -z "$(find "$dir" -name '.*tmp')" ] || die "injected $1: something is left"
        targets=$((targets + 1))
    }
    inject rename 4 "out.exr"
    inject fsync 4 "out.exr"
    inject vanish 4 "out.exr"
    inject context 5 "OpenGL 4.5"
    inject lost 5 "lost"
    inject lost 5 "lost" 3
    # At any question for GL's errors. Where the answer only means that a cached program does not fit, the run completes.
    for n in 1 2 4 6 7 8 9 10 12; do
        rm -f "$dir/out.exr"
        SSDO_FAULT=memory SSDO_FAULT_AT=$n LD_PRELOAD="$sanitizer $dir/fault.so" "$SSDO" $args -o "$dir/out.exr" 2>"$dir/err" >/dev/null
        code=$?
        [ $code = 0 ] && whole "$dir/out.exr" "GL out of memory at $n" && continue
        failed 6 "memory" "GL out of memory at $n"
        [ ! -e "$dir/out.exr" ] && [ -z "$(find "$dir" -name '.*tmp')" ] || die "GL out of memory: something is left"
        targets=$((targets + 1))
    done
fi

# --- memory: the n-th allocation fails ---
# An allocation that only a cache needed does not stop the run; the last one has been passed when many in a row succeed.
memory=0 spared=0 row=0 n=1 step=1 enough=120
[ "${SSDO_HARD-}" = whole ] || { step=17 enough=5; }
# The record names the variable, so the files are not the same bytes.
same_pixels() { oiiotool --diff "$dir/out.exr" "$dir/two.exr" >/dev/null; }
"$SSDO" $args --layers occlusion,radiance -o "$dir/two.exr" 2>"$dir/err" || die "the clean run"
while [ $row -lt $enough ]; do
    rm -f "$dir/out.exr"
    SSDO_FAIL_ALLOC=$n "$SSDO" $args --layers occlusion,radiance -o "$dir/out.exr" 2>"$dir/err" >/dev/null
    code=$?
    if [ $code = 0 ]; then
        same_pixels || die "allocation $n: another result"
        spared=$((spared + 1)) row=$((row + 1)) n=$((n + step))
        continue
    fi
    row=0
    failed 6 "memory" "allocation $n"
    [ ! -e "$dir/out.exr" ] && [ -z "$(find "$dir" -name '.*tmp')" ] || die "allocation $n: something is left"
    memory=$((memory + 1)) n=$((n + step))
    [ $n -gt 20000 ] && die "more than 20000 allocations"
done
# Rounds keep more: each of their allocations.
row=0 n=1
[ "${SSDO_HARD-}" = whole ] && step=1 || step=7
"$SSDO" $args --layers occlusion,error --error 0.05 --samples 64 -o "$dir/two.exr" 2>"$dir/err" || die "the clean run of rounds"
while [ $row -lt $enough ]; do
    rm -f "$dir/out.exr"
    SSDO_FAIL_ALLOC=$n "$SSDO" $args --layers occlusion,error --error 0.05 --samples 64 -o "$dir/out.exr" 2>"$dir/err" >/dev/null
    code=$?
    n=$((n + step))
    [ $code = 0 ] && same_pixels && row=$((row + 1)) && continue
    row=0
    failed 6 "memory" "allocation $((n - step)) of rounds"
    [ ! -e "$dir/out.exr" ] || die "allocation $((n - step)) of rounds: something is left"
    memory=$((memory + 1))
done
echo "figure: $full full disks, $targets faults of target and GL, $memory failed allocations ($((spared - row)) more did not matter): 0 partial outputs, 0 lost inputs"
