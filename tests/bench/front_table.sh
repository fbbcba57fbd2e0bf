#!/bin/sh
# front_table.sh BUILD: the table and the plot of what front.sh measured.
set -eu
dir=$1/bench/front
awk -F '\t' 'NR == FNR { if ($1 == "copy") copy = $2; time[$1] = $2; next }
    { split($1, a, ":"); printf "%s\t%s\t%s\t%.2f\t%s\t%s\t%s\n", a[1], a[2], a[3], time[$1] / copy, $2, $3, $4 }' "$dir/times" "$dir/errors" >"$dir/points"
{
    echo "| program | samples | resolution | CPU, x oiiotool | occlusion, rmse | radiance / rms | indirect / rms |"
    echo "| --- | ---: | --- | ---: | ---: | ---: | ---: |"
    awk -F '\t' '{ printf "| %s | %s | %s | %s | %s | %s | %s |\n", $1, $2, $3, $4, $5, $6, $7 }' "$dir/points"
} >"$1/bench/front.md"
cat "$1/bench/front.md"
for name in old new; do sort -t "$(printf '\t')" -k 4n "$dir/points" | grep "^$name" >"$dir/$name"; done
gnuplot <<END
set terminal pngcairo size 1200,360 font ',10'
set output '$1/bench/front.png'
set multiplot layout 1,3
set logscale x
set xtics (1, 1.5, 2, 3, 4, 6)
set xlabel 'CPU of the whole job, x copying its file'
set grid
do for [k = 5:7] {
    set title word('occlusion radiance indirect', k - 4)
    plot '$dir/old' using 4:k with points pt 7 lc rgb '#999999' title 'before', '$dir/new' using 4:k with points pt 5 lc rgb '#d62728' title 'now'
}
END
