#!/bin/sh
# make.sh BUILD: BUILD/gpu-bundle.tar.xz, for a machine that has a GPU and its driver and nothing of ours: the program, the tests that use
# GL, the samples, what llvmpipe makes of them, the libraries that a bare machine lacks, and tests/gpu/run.sh.
# make.sh BUILD FOLDER: the same in FOLDER, put together without packing and with only the pictures that run.sh compares on a software device.
set -eu
build=$1 place=${2:-$1} stage=${2:-$1}/gpu-bundle
pack='xz -9' cases=.
[ $# = 1 ] || { pack=cat; cases='^box-|^ortho-|^[a-z]*-hemisphere'; }
command -v patchelf >/dev/null 2>&1 || { echo "gpu-bundle: needs patchelf" >&2; exit 1; }
rm -rf "$stage" && mkdir -p "$stage/bin" "$stage/lib" "$stage/recorded" "$stage/samples"

# Tests that need OpenImageIO, OpenColorIO or Embree, the shaders' sources or the samples' truths stay here; run.sh names them.
left_out="test_colour test_raytrace test_batch_memory test_samples test_rounds hard_shader_errors"
for source in $(grep -lE 'rig_open|gpu_open|job_open|hard\.h' tests/unit/test_*.c tests/hard/hard_*.c); do
    name=$(basename "$source" .c)
    case " $left_out " in *" $name "*) continue ;; esac
    cp "$build/tests/$name" "$stage/bin"
done
cp "$build/ssdo-filter" "$build/tests/gpu/compare" "$build/tests/bench/make_input" "$stage/bin"
sh tests/dist/libraries.sh "$stage/lib" "$stage"/bin/*
for f in "$stage"/bin/*; do
    strip "$f"
    patchelf --set-rpath '$ORIGIN/../lib' "$f"
done
# The truths are read only by tests that stay here.
for f in samples/*.exr; do case $f in *_truth.exr) ;; *) cp "$f" "$stage/samples" ;; esac; done
cp samples/*.obj samples/*.mtl "$stage/samples"
cp -r samples/proxies "$stage/samples"
cp tests/gpu/run.sh LICENSE "$stage"
grep -v '^#' tests/gpu/cases.txt | grep -E "$cases" >"$stage/cases.txt"
echo "$left_out" >"$stage/left-out"
"$build/ssdo-filter" --version >"$stage/version"

# What this machine's software renderer makes of the samples.
(cd "$stage" && while read -r name arguments; do
    bin/ssdo-filter $arguments -q --keep none -o "recorded/$name.exr" 2>/dev/null || { echo "gpu-bundle: $name" >&2; exit 1; }
done <cases.txt)
tar -C "$place" --sort=name --owner=0 --group=0 -c gpu-bundle | $pack >"$place/gpu-bundle.tar.xz"
size=$(stat -c %s "$place/gpu-bundle.tar.xz")
echo "gpu-bundle: $place/gpu-bundle.tar.xz, $((size / 1000)) kB, $(ls "$stage/bin" | wc -l) programs, $(ls "$stage/recorded" | wc -l) recorded pictures"
[ $# = 2 ] || [ "$size" -le 26214400 ]
