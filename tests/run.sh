#!/bin/sh
# run.sh BUILD TEST...: the unit programs and then the end-to-end scripts tests/*/*.sh. Output of a passing test is kept short.
# A unit program or script exits 0 (passed) or 77 (skipped, with its reason as the last line); anything else failed.
# JOBS_TEST (2) run at a time; those that tests/serial.txt names run alone, after them. T: only tests whose name holds this text.
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
    for t in ${SSDO_SCRIPTS-tests/golden/*.sh tests/hard/*.sh}; do [ -e "$t" ] && echo "$t"; done
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
took=$(($(date +%s) - start))
grep -l -e ERROR: -e 'runtime error' "$reports".* >"$log.found" 2>/dev/null && { xargs head -40 <"$log.found" >>"$log"; code=66; }
{
    case $code in
    0) echo "ok      $name ($took s)"; grep '^figure:' "$log" ;;
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
alone -v | xargs -r -P "${JOBS_TEST:-2}" -n 1 sh "$logs/one"
alone | xargs -r -n 1 sh "$logs/one"
count() { cat "$logs"/*.mark | grep -c "^$1$"; }
passed=$(count passed) failed=$(count failed) skipped=$(count skipped)
lost=$(($(wc -l <"$logs/list") - passed - failed - skipped)) # killed before it could say
echo "$(($(date +%s) - began)) s"
[ "$failed" = 0 ] || echo "failed: $(grep -l failed "$logs"/*.mark | sed 's|.*/||; s|\.log\.mark$||' | tr '\n' ' ')"
echo "$passed passed, $((failed + lost)) failed, $skipped skipped"
[ "$((failed + lost))" = 0 ]
