#!/bin/sh
# run.sh BUILD TEST...: the unit programs and then the end-to-end scripts tests/*/*.sh. Output of a passing test is kept short.
# A unit program or script exits 0 (passed) or 77 (skipped, with its reason as the last line); anything else failed.
# JOBS_TEST (2) run at a time, but never two of those that tests/serial.txt names. T: only tests whose name holds this text.
build=$1
shift
logs=$(cd "$build" && pwd)/tests/logs
rm -rf "$logs"
mkdir -p "$logs"
SSDO=$(cd "$build" && pwd)/ssdo-filter
export SSDO logs
began=$(date +%s)

all() {
    for t in "$@"; do echo "$t"; done
    for t in ${SSDO_SCRIPTS-tests/hard/*.sh tests/golden/*.sh}; do [ -e "$t" ] && echo "$t"; done
}

# Runs one test and tells at once what became of it, in one piece; the log beside its mark is what is counted in the end.
cat >"$logs/one" <<'ONE'
name=$1 log=$logs/$(basename "$1").log
# What a sanitizer has to say fails the test, also where a script expects its program to fail (tests/sanitize/options.c has the rest).
reports=$log.reports
export ASAN_OPTIONS="log_path=$reports" UBSAN_OPTIONS="log_path=$reports"
case $1 in *.sh) set -- sh "$1" ;; *) name=$(basename "$1") ;; esac
start=$(date +%s)
"$@" >"$log" 2>&1
code=$?
times >"$log.times" # the second line is the children's: user and system time as 1m2.3s
took="$(($(date +%s) - start)) s, $(tail -1 "$log.times" | tr 'ms' '  ' | awk '{ printf "%.0f", 60 * ($1 + $3) + $2 + $4 }') s of CPU"
grep -l -e ERROR: -e 'runtime error' "$reports".* >"$log.found" 2>/dev/null && { xargs head -40 <"$log.found" >>"$log"; code=66; }
{
    case $code in
    0) echo "ok      $name ($took)"; grep '^figure:' "$log" ;;
    77) echo "skipped $name: $(tail -1 "$log")" ;;
    *) echo "FAILED  $name (exit $code)"; tail -60 "$log" ;;
    esac
} >"$log.said"
case $code in 0) echo passed ;; 77) echo skipped ;; *) echo failed ;; esac >"$log.mark"
cat "$log.said"
exit 0
ONE

all "$@" | grep -F -e "${T-}" >"$logs/list" || { echo "no test's name holds '${T-}'"; exit 1; }
alone() { # -v: the others
    grep -v '^#' tests/serial.txt | sed 's/.*/\/&$/' >"$logs/alone"
    sed 's|^|/|' "$logs/list" | grep "$@" -f "$logs/alone" | sed 's|^/||'
}
alone >"$logs/list.alone"
alone -v >"$logs/list.others"
# lane LIST...: one test after the other that no other lane has taken. By xargs, for what a shell puts into the background is deaf to ^C.
cat >"$logs/lane" <<'LANE'
for list in "$@"; do cat "$logs/$list"; done | while read -r test; do
    mkdir "$logs/$(basename "$test").taken" 2>/dev/null && sh "$logs/one" "$test" </dev/null
done
LANE
{
    echo list.alone list.others
    k=1
    while [ $k -lt "${JOBS_TEST:-2}" ]; do echo list.others && k=$((k + 1)); done
} | xargs -P "${JOBS_TEST:-2}" -L 1 sh "$logs/lane"
count() { cat "$logs"/*.mark | grep -c "^$1$"; }
passed=$(count passed) failed=$(count failed) skipped=$(count skipped)
lost=$(($(wc -l <"$logs/list") - passed - failed - skipped)) # killed before it could say
echo "$(($(date +%s) - began)) s, $(cat "$logs"/*.times | tr 'ms' '  ' | awk 'NR % 2 == 0 { t += 60 * ($1 + $3) + $2 + $4 } END { printf "%.0f", t }') s of CPU"
[ "$failed" = 0 ] || echo "failed: $(grep -l failed "$logs"/*.mark | sed 's|.*/||; s|\.log\.mark$||' | tr '\n' ' ')"
echo "$passed passed, $((failed + lost)) failed, $skipped skipped"
[ "$((failed + lost))" = 0 ]
