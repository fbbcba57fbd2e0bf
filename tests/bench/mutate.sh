#!/bin/sh
# mutate.sh BUILD [WORD]: proof that the tests see errors of 5 %. Each line of `mutations` changes one shader in a copy of shaders/
# (SSDO_SHADER_DIR); a test named must fail on it. Prints what was caught; exits 1 if anything was not, or if a line's pattern no
# longer matches the shader. WORD tries only the lines that hold it. Not part of `make check`: it takes some minutes.
build=${1:-build}
only=${2:-.}
dir=$build/mutate
log=$dir/log
mkdir -p "$dir"

# what | file | sed expression | tests, any of which must fail: PROGRAM or PROGRAM:FILTER
mutations() {
    cat <<'LIST'
ssdo: cosine to the power 1.05|ssdo.comp|s/open += visible \* s\.cosine/open += visible * pow(s.cosine, 1.05)/|bias:ssdo
ssdo: weight 2 / N times 0.95|ssdo.comp|s#norm = 2\.0 /#norm = 1.9 /#|bias:ssdo
ssdo: thickness times 1.05|include/ssdo.glsl|s/<= params\.thickness/<= 1.05 * params.thickness/|bias:ssdo
ssdo: radius times 1.05|include/ssdo.glsl|s/lambda = params\.radius/lambda = 1.05 * params.radius/|bias:ssdo
ssdo bounce: cosine of the sender times 1.05|ssdo_bounce.comp|s/float F = patch_area/float F = 1.05 * patch_area/|convergence:ssdo*
s3ho: cosine to the power 1.05|s3ho.comp|s/open += cosine;/open += pow(cosine, 1.05);/|bias:s3ho
s3ho: weight of the coefficients times 1.05|s3ho.comp|s#PI / total#1.05 * PI / total#|s3ho
s3ho: thickness times 1.05|s3ho.comp|s/<= params\.thickness/<= 1.05 * params.thickness/|bias:s3ho
alchemy: cosine times 1.05|alchemy.comp|s/dot(N, w) - bias/1.05 * dot(N, w) - bias/|bias:alchemy
alchemy: c of the denominator times 1.05|alchemy.comp|s/max(c \* c, ww)/max(1.1025 * c * c, ww)/|bias:alchemy
alchemy: weight 2 pi 0.1 R times 1.05|alchemy.comp|s/2\.0 \* PI \* 0\.1/2.1 * PI * 0.1/|bias:alchemy
alchemy: measure, taps 5 % wider|alchemy.comp|s/alpha \* disc/1.05 * alpha * disc/|bias:alchemy
hemisphere: points 5 % farther|hemisphere.comp|s/mix(0\.1, 1\.0/mix(0.105, 1.05/|bias:hemisphere
hemisphere: weight of a point times 1.05|hemisphere.comp|s/1\.0 - float(count)/1.0 - 1.05 * float(count)/|bias:hemisphere
hbao: weight, 1 - 1.05 r^2|hbao.comp|s#1\.0 - ww / rr#1.0 - 1.05 * ww / rr#|bias:hbao
hbao: rise of the horizon times 1.05|hbao.comp|s/(elevation - horizon)/1.05 * (elevation - horizon)/|bias:hbao
slices: cosine, sin^2 term times 1.05|include/arc_slice.glsl|s/(s\.cos_n \* y - s\.sin_n/(1.05 * s.cos_n * y - s.sin_n/|bias:gtao
slices: measure, second term times 1.05|include/arc_slice.glsl|s/0\.5 \* s\.sin_n \* t + s\.below/0.525 * s.sin_n * t + s.below/|bias:gtao
slices: measure of the far half times 1.05|include/arc_slice.glsl|s/s\.below = 0\.5/s.below = 0.525/|bias:gtao
slices: scale of the measure times 1.05|include/arc_slice.glsl|s#s\.scale = 1\.0 /#s.scale = 1.05 /#|bias:gtao
slices: angle of the normal times 1.05|include/arc_slice.glsl|s/n = fast_atan(abs(sideways)/n = 1.05 * fast_atan(abs(sideways)/|bias:gtao
slices: weight, length of the projected normal left out|include/arc_slice.glsl|s/weight = squared \* inverse_length \*/weight =/|bias:gtao
slices: weight, that length to the power 1.05|include/arc_slice.glsl|s/weight = squared \* inverse_length \*/weight = pow(squared * inverse_length, 1.05) */|bias:gtao
slices: weight, n sin n times 1.05|include/arc_slice.glsl|s/\(weight = .*\)n \* s\.sin_n/\11.05 * n * s.sin_n/|bias:gtao
bitmask: thickness times 1.05|include/arc_taps.glsl|s/w + params\.thickness/w + 1.05 * params.thickness/|bias:bitmask
gtao, bitmask: radius squared times 1.05|include/arc_taps.glsl|s/< params\.radius \* params\.radius/< 1.05 * params.radius * params.radius/|bias:gtao
arc: cosine, sin^2 term times 1.05|include/arc_slice.glsl|s/(s\.cos_n \* y - s\.sin_n/(1.05 * s.cos_n * y - s.sin_n/|arc:arc_agrees*
arc: measure of the far half times 1.05|include/arc_slice.glsl|s/s\.below = 0\.5/s.below = 0.525/|arc:arc_agrees*
arc: scale of the measure times 1.05|include/arc_slice.glsl|s#s\.scale = 1\.0 /#s.scale = 1.05 /#|arc:arc_agrees*
LIST
}

# A filter is the only argument of a test program.
fails() { # PROGRAM[:FILTER]
    set -- "${1%%:*}" "${1#*:}"
    [ "$1" = "$2" ] && set -- "$1"
    program=$build/tests/test_$1
    shift
    SSDO_SHADER_DIR=$dir/shaders timeout 1800 "$program" "$@" >"$log" 2>&1 && return 1
    # A shader that no longer compiles would fail for the wrong reason, and so would a program that is not there.
    grep -q 'FAILED' "$log" && ! grep -q 'the driver refuses shader' "$log"
}

mutations | grep -e "$only" >"$dir/list"

# A test that fails already shows nothing; one that runs nothing neither.
usable=
missed=0
for t in $(cut -d'|' -f4 "$dir/list" | tr ' ' '\n' | sort -u); do
    rm -rf "$dir/shaders" && cp -r shaders "$dir/shaders"
    if fails "$t" || ! grep -q 'OK' "$log"; then
        echo "UNUSABLE test $t fails on the true shaders, or runs nothing"
        missed=$((missed + 1))
    else
        usable="$usable $t "
    fi
done

while IFS='|' read -r what file edit tests; do
    rm -rf "$dir/shaders" && cp -r shaders "$dir/shaders"
    sed -i "$edit" "$dir/shaders/$file"
    if cmp -s "shaders/$file" "$dir/shaders/$file"; then
        echo "STALE   $what: shaders/$file has no such line; mend the pattern in $0"
        missed=$((missed + 1))
        continue
    fi
    by=
    for t in $tests; do
        case $usable in *" $t "*) ;; *) continue ;; esac
        fails "$t" </dev/null && { by=$t; break; }
    done
    if [ -n "$by" ]; then
        echo "caught  $what (test_$by)"
    else
        echo "MISSED  $what"
        missed=$((missed + 1))
    fi
done <"$dir/list"
echo "mutate: $(wc -l <"$dir/list") mutations, $missed not caught or not tried"
[ "$missed" = 0 ]
