#!/bin/sh
# mutate.sh BUILD: proof that the tests see errors of 5 %. Each line of `mutations` changes one shader in a copy of shaders/
# (SSDO_SHADER_DIR); the programs named must fail on it. Prints what was caught; exits 1 if anything was not.
# Not part of `make check`: it takes some minutes.
build=${1:-build}
dir=$build/mutate
log=$dir/log
mkdir -p "$dir"

# what | file | sed expression | programs, any of which must fail
mutations() {
    cat <<'LIST'
ssdo: cosine to the power 1.05|ssdo.comp|s/open += visible \* s\.cosine/open += visible * pow(s.cosine, 1.05)/|convergence
ssdo: weight 2 / N times 0.95|ssdo.comp|s#norm = 2\.0 /#norm = 1.9 /#|convergence
ssdo: thickness times 1.05|include/ssdo.glsl|s/<= params\.thickness/<= 1.05 * params.thickness/|convergence
ssdo: radius times 1.05|include/ssdo.glsl|s/lambda = params\.radius/lambda = 1.05 * params.radius/|convergence closed_forms
ssdo bounce: cosine of the sender times 1.05|ssdo_bounce.comp|s/float F = patch_area/float F = 1.05 * patch_area/|convergence
alchemy: cosine times 1.05|alchemy.comp|s/dot(N, w) - bias/1.05 * dot(N, w) - bias/|convergence
alchemy: weight 2 pi 0.1 R times 1.05|alchemy.comp|s/2\.0 \* PI \* 0\.1/2.1 * PI * 0.1/|convergence
alchemy: measure, taps 5 % wider|alchemy.comp|s/alpha \* disc/1.05 * alpha * disc/|convergence
hemisphere: points 5 % farther|hemisphere.comp|s/mix(0\.1, 1\.0/mix(0.105, 1.05/|convergence
hbao: weight, 1 - 1.05 r^2|hbao.comp|s#1\.0 - ww / rr#1.0 - 1.05 * ww / rr#|convergence
slices: cosine, sin^2 term times 1.05|include/arc_slice.glsl|s/0\.5 \* (s\.cos_n \* st/0.5 * (1.05 * s.cos_n * st/|arc closed_forms
slices: measure, second term times 1.05|include/arc_slice.glsl|s/s\.sin_n \* (t - st/1.05 * s.sin_n * (t - st/|arc closed_forms
slices: measure of the far half times 1.05|include/arc_slice.glsl|s/s\.below = 0\.5/s.below = 0.525/|arc closed_forms
slices: scale of the measure times 1.05|include/arc_slice.glsl|s#s\.scale = 1\.0 /#s.scale = 1.05 /#|arc closed_forms
slices: angle of the normal times 1.05|include/arc_slice.glsl|s/n = atan(sideways, up)/n = 1.05 * atan(sideways, up)/|arc closed_forms
slices: weight, length of the projected normal left out (5 % of it divide away)|include/arc_slice.glsl|s/weight = squared \* inverse_length \*/weight =/|arc closed_forms
bitmask: thickness times 1.05|include/arc_taps.glsl|s/w + params\.thickness/w + 1.05 * params.thickness/|arc
gtao, bitmask: radius squared times 1.05|include/arc_taps.glsl|s/< params\.radius \* params\.radius/< 1.05 * params.radius * params.radius/|arc closed_forms
LIST
}

fails() { # program
    SSDO_SHADER_DIR=$dir/shaders "$build/tests/test_$1" >"$log" 2>&1 && return 1
    # A shader that no longer compiles would fail for the wrong reason.
    ! grep -q 'the driver refuses shader' "$log"
}

# A program that fails already shows nothing.
usable=
missed=0
for t in convergence arc closed_forms; do
    rm -rf "$dir/shaders" && cp -r shaders "$dir/shaders"
    if fails "$t"; then
        echo "UNUSABLE test_$t fails on the true shaders"
        missed=$((missed + 1))
    else
        usable="$usable $t "
    fi
done

mutations >"$dir/list"
while IFS='|' read -r what file edit programs; do
    rm -rf "$dir/shaders" && cp -r shaders "$dir/shaders"
    sed -i "$edit" "$dir/shaders/$file"
    if cmp -s "shaders/$file" "$dir/shaders/$file"; then
        echo "STALE   $what: shaders/$file has no such line"
        missed=$((missed + 1))
        continue
    fi
    by=
    for t in $programs; do
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
