#!/bin/sh
# readme.sh KIND: the shell commands of README.md and of the pages it sends to, in the order of reading, whose fence says ```sh KIND, or with KIND empty those whose fence says ```sh alone,
# each with what the README says it prints: the lines of the ```text fence after it come out with "#=> " in front.
awk -v kind="$1" '
    /^```/ && inside { inside = 0; next }
    /^```sh/ { last = $0 == (kind ? "```sh " kind : "```sh"); inside = last ? "sh" : "other"; next }
    /^```text/ { inside = last ? "text" : "other"; next }
    /^```/ { inside = "other"; next }
    inside == "sh" { print }
    inside == "text" { print "#=> " $0 }
' ${README:-README.md src/gbuffer/README.md samples/farm/README.md src/passes/README.md}
