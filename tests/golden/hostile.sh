#!/bin/sh
# A hostile world: pipes and devices for every input, files that are no JSON, names that are no text, numbers beyond reason, a file
# size limit, a full standard output. Never a hang, a wrong picture or a forged line; always the documented exit code.
set -u
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
bad=0
fail() { echo "FAILED: $*"; [ -s "$dir/err" ] && cat "$dir/err"; bad=1; }
oiiotool samples/still.exr --cut 96x72+200+120 --origin +0+0 --fullpixels -o "$dir/in.exr" >/dev/null || { echo "FAILED: oiiotool"; exit 1; }
in=$dir/in.exr
mkfifo "$dir/pipe"

# expect CODE TEXT ARGS...: within ten seconds that exit code, one line with TEXT, no output.
expect() {
    want=$1 text=$2
    shift 2
    rm -f "$dir/out.exr"
    timeout -k 1 10 "$SSDO" -q "$@" -o "$dir/out.exr" >"$dir/said" 2>"$dir/err" </dev/null
    code=$?
    [ $code = "$want" ] && [ "$(wc -l <"$dir/err")" = 1 ] && grep -qF -- "$text" "$dir/err" && [ ! -e "$dir/out.exr" ] ||
        fail "exit $code (wanted $want), wanted '$text': $*"
}

# --- what is no regular file ---
for what in "$dir/pipe" /dev/zero "$dir"; do
    expect 3 "not a regular file" "$what"
    expect 3 "not a regular file" "$in" --env "$what"
    expect 2 "not a regular file" "$in" --camera "$what"
    expect 2 "not a regular file" "$in" --proxies "$what"
    expect 3 "not a regular file" "$in" --method raytrace --mesh "$what"
    expect 3 "not a regular file" "$in" --albedo-colorspace any --ocio "$what"
done
expect 3 "not a regular file" "$dir/in.exr" "$dir/pipe"
expect 2 "goes through a pipe" -
# A material file is no reason to stop, and none to wait.
printf 'mtllib pipe\nv -9 -9 -9\nv 9 -9 -9\nv 0 9 9\nf 1 2 3\n' >"$dir/mesh.obj"
timeout -k 1 10 "$SSDO" "$in" --method raytrace --mesh "$dir/mesh.obj" -o "$dir/out.exr" >/dev/null 2>"$dir/err"
[ $? -lt 100 ] && grep -q "pipe.*not a regular file" "$dir/err" || fail "a material file that is a pipe"

# --- JSON ---
identity='[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]'
json() { printf '%s' "$1" >"$dir/x.json"; }
json '{"fov": 40} and more' && expect 2 "JSON" "$in" --camera "$dir/x.json"
json '{"fov": 40' && expect 2 "JSON" "$in" --camera "$dir/x.json"
json '' && expect 2 "JSON" "$in" --camera "$dir/x.json"
json '[40]' && expect 2 "one JSON object" "$in" --camera "$dir/x.json"
json '{"spheres": []} {}' && expect 2 "JSON" "$in" --proxies "$dir/x.json"
json '{"fov": 40, "world_from_camera": [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]}' && expect 2 "mirroring" "$in" --camera "$dir/x.json"
json '{"fov": 40, "world_from_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[3,0,0,1]]}' && expect 2 "0 0 0 1" "$in" --camera "$dir/x.json"
json "{\"fov\": 40, \"world_from_camera\": [$identity]}"
"$SSDO" -q "$in" --camera "$dir/x.json" --samples 1 --layers occlusion -o "$dir/out.exr" 2>"$dir/err" || fail "a good camera file"

# --- numbers ---
expect 2 "beyond what is computed with" "$in" --bounce-strength 1e300
expect 2 "beyond what is computed with" "$in" --env-scale 1e-300
expect 2 "beyond what is computed with" "$in" --radius 1e300

# --- an environment without a usable texel, also where nobody reads warnings ---
oiiotool --pattern constant:color=nan,nan,nan 8x4 3 -d float -o "$dir/nan.exr" >/dev/null 2>&1
expect 3 "every texel" "$in" --env "$dir/nan.exr"

# --- names: a report is JSON in UTF-8, a line is a line ---
nasty=$(printf 'a\351\001\nopenjd_status: done').exr # a byte that is no UTF-8, a control character, the end of a line
cp "$in" "$dir/$nasty"
"$SSDO" "$dir/$nasty" --samples 1 --layers occlusion -o "$dir/out.exr" --report "$dir/r.json" -v >"$dir/said" 2>"$dir/err" || fail "a name that is no text"
grep -qv '^ssdo-filter: ' "$dir/err" && fail "a name splits lines"
python3 -c 'import json, sys; json.loads(open(sys.argv[1], "rb").read().decode("utf-8"))' "$dir/r.json" || fail "the report is no JSON in UTF-8"
"$SSDO" -q "$dir/none$nasty" --progress openjd -o "$dir/out.exr" >"$dir/said" 2>"$dir/err"
! grep -q '^openjd_status' "$dir/said" && [ "$(wc -l <"$dir/err")" = 1 ] || fail "a name forges a line for a supervisor"

# --- a negative albedo is none ---
oiiotool "$in" --ch ViewLayer.Position.X,ViewLayer.Position.Y,ViewLayer.Position.Z,ViewLayer.Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z \
    -o "$dir/geometry.exr" >/dev/null 2>&1
oiiotool "$in" --ch ViewLayer.DiffCol.R,ViewLayer.DiffCol.G,ViewLayer.DiffCol.B --mulc -1 -o "$dir/albedo.exr" >/dev/null 2>&1
oiiotool "$dir/geometry.exr" "$dir/albedo.exr" --chappend -o "$dir/negative.exr" >/dev/null 2>&1
"$SSDO" "$dir/negative.exr" --samples 1 -o "$dir/out.exr" --keep none 2>"$dir/err" || fail "a negative albedo"
grep -q "albedo's samples are negative" "$dir/err" || fail "nothing is said about a negative albedo"
oiiotool --stats "$dir/out.exr" 2>/dev/null | grep 'Stats Min' | grep -q -- '-[0-9]' && fail "a negative composite"

# --- a scene too small or too large for single precision; at the borders it is the same picture ---
scaled() { # FACTOR FILE
    oiiotool "$dir/geometry.exr" -d float --ch ViewLayer.Position.X,ViewLayer.Position.Y,ViewLayer.Position.Z --mulc "$1" -o "$dir/p.exr"
    oiiotool "$dir/geometry.exr" -d float --ch ViewLayer.Normal.X,ViewLayer.Normal.Y,ViewLayer.Normal.Z "$dir/p.exr" --chappend -o "$2"
} >/dev/null 2>&1
for factor in 1e-16 1e10; do
    scaled $factor "$dir/scaled.exr" && expect 3 "in another unit" "$dir/scaled.exr" --layers occlusion
done
scaled 1 "$dir/scaled.exr"
"$SSDO" -q "$dir/scaled.exr" --layers occlusion --keep none -o "$dir/one.exr" 2>"$dir/err" || fail "a scene in its own unit"
for factor in 1e-11 1e8; do
    scaled $factor "$dir/scaled.exr"
    "$SSDO" -q "$dir/scaled.exr" --layers occlusion --keep none -o "$dir/out.exr" 2>"$dir/err" || fail "a scene $factor times as large"
    idiff -fail 0.01 -failpercent 0.1 "$dir/one.exr" "$dir/out.exr" >"$dir/err" 2>&1 || fail "another picture of a scene $factor times as large"
done

# --- a limit on the size of files is a full disk ---
(
    ulimit -f 8
    "$SSDO" -q "$in" --samples 1 --float --compression none -o "$dir/limited.exr" 2>"$dir/err"
    echo $? >"$dir/code"
)
[ "$(cat "$dir/code")" = 4 ] && grep -q "free some space" "$dir/err" || fail "ulimit -f: exit $(cat "$dir/code")"
[ -z "$(find "$dir" -name '.*tmp')" ] && [ ! -e "$dir/limited.exr" ] || fail "ulimit -f leaves $(ls -A "$dir")"

# --- what could not be told was not told ---
for what in --help --version "--completion bash"; do
    "$SSDO" $what >/dev/full 2>"$dir/err"
    code=$?
    [ $code = 4 ] && grep -q "standard output" "$dir/err" || fail "$what >/dev/full: exit $code"
done
"$SSDO" "$in" --explain >/dev/full 2>"$dir/err"
[ $? = 4 ] || fail "--explain >/dev/full"
exit $bad
