#!/bin/sh
# readme.sh BUILD: pastes the figures of the last `make bench` and `make bench-unseen` into tests/bench/RESULTS.md, between the markers
# <!-- NAME --> and <!-- /NAME -->, and copies the plot to samples/pictures. What has not been run is left as it is.
build=${1:-build}
page=tests/bench/RESULTS.md
set -e

figures() { # bench.md: what the page shows of it
    sed -n '/^Made by/p; /^Machine:/p; /^A frame nine tenths/p' "$1" | sed 's/$/\n/'
    awk '/^### Rendered scenes, each method as it ships/ {on = 1; next} on && /^[^|]/ {exit} on && /^\|/ {print}' "$1"
    awk '/^Occlusion at the GL time of the default/ {print "\n" $0}' "$1"
}

paste_into() { # NAME FILE
    grep -q "^<!-- $1 -->" "$page" || { echo "$page has no marker <!-- $1 -->" >&2; exit 1; }
    {
        [ "$1" = bench ] && printf '![Error against time of every method, with the Pareto front](../../samples/pictures/speed-error.png)\n\n'
        figures "$2"
    } >"$build/readme.part"
    awk -v name="$1" -v part="$build/readme.part" '
        $0 == "<!-- /" name " -->" {skip = 0}
        !skip {print}
        $0 == "<!-- " name " -->" {skip = 1; while ((getline line < part) > 0) print line}' "$page" >"$build/readme.md"
    cat "$build/readme.md" >"$page"
    echo "$page: $1 from $2"
}

for name in bench bench-unseen; do
    [ -e "$build/$name/bench.md" ] && paste_into "$name" "$build/$name/bench.md" || echo "no $build/$name/bench.md: run make $name"
done
if [ -e "$build/bench/bench.png" ]; then
    cp "$build/bench/bench.png" samples/pictures/speed-error.png
    echo 'samples/pictures/speed-error.png'
fi
