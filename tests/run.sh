#!/bin/sh
# run.sh BUILD TEST...: the unit programs and then the end-to-end scripts tests/*/*.sh. Output of a passing test is kept short.
# A unit program or script exits 0 (passed) or 77 (skipped, with its reason as the last line); anything else failed.
build=$1
shift
passed=0 failed=0 skipped=0
log=$build/tests/log
mkdir -p "$build/tests"
SSDO=$(cd "$build" && pwd)/ssdo-filter
export SSDO

one() {
    name=$1
    shift
    start=$(date +%s)
    "$@" >"$log" 2>&1
    code=$?
    took=$(($(date +%s) - start))
    case $code in
    0) passed=$((passed + 1)); echo "ok      $name (${took} s)"; grep '^figure:' "$log" ;;
    77) skipped=$((skipped + 1)); echo "skipped $name: $(tail -1 "$log")" ;;
    *) failed=$((failed + 1)); echo "FAILED  $name (exit $code)"; tail -60 "$log" ;;
    esac
}

for t in "$@"; do one "$(basename "$t")" "$t"; done
for t in ${SSDO_SCRIPTS-tests/golden/*.sh tests/hard/*.sh}; do [ -e "$t" ] && one "$t" sh "$t"; done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" = 0 ]
