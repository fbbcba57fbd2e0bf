# check.py SSDO FOLDER [OPTION...]: every EXR file below a folder, explained (--explain=json) and then filtered (occlusion only), as
# a table: how the geometry is read, how well it fits, time, exit status, verdict. Options are passed to both runs. Fails if any
# run crashes or takes longer than SSDO_WILD_SECONDS (120), or writes something else than an output or a sentence.
import json
import os
import subprocess
import sys
import tempfile
import time

ROLES = ("position", "normal", "depth")
LIMIT = float(os.environ.get("SSDO_WILD_SECONDS", "120"))


def run(command):
    """Exit status (negative: the signal; None: it ran too long), output, error, seconds."""
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return None, b"", b"", LIMIT
    return done.returncode, done.stdout, done.stderr, time.monotonic() - start


def read_how(report):
    """One cell for the roles of every view: "normal: world space 0.999"."""
    cells = []
    for view in report.get("views", []):
        for role in ROLES:
            found = view["roles"].get(role)
            if not found or "verdict" not in found:
                continue
            fit = found.get("fit")
            cells.append("%s: %s%s%s" % (role, found["reading"] or found["channels"], "" if fit is None else " %.3g" % fit,
                                         "" if found["verdict"] == "taken" else " (%s)" % found["verdict"]))
    return "; ".join(cells) or "-"


def check(ssdo, path, options, out):
    """One row, and what is wrong with it: an empty text if nothing is."""
    code, text, _, took = run([ssdo, path, "--explain=json"] + options)
    how, verdict, wrong = "-", "", ""
    if code is None or code < 0:
        return how, took, code, "", "--explain " + ("hangs" if code is None else "dies of signal %d" % -code)
    try:
        report = json.loads(text)
        how, verdict = read_how(report), report["verdict"]
    except ValueError:
        # What cannot be opened at all has no report, but a sentence and an exit status.
        verdict = "refused"
        if code == 0:
            wrong = "--explain=json is no JSON"
    code, _, error, took = run([ssdo, path, "-o", out, "--layers", "occlusion", "--quality", "draft"] + options)
    if code is None or code < 0 or code > 128:
        wrong = "hangs" if code is None else "dies of a signal"
    elif code != 0 and not error.strip():
        wrong = "fails without a word"
    elif code != 0 and os.path.exists(out):
        wrong = "fails and leaves an output"
    elif code == 0 and not os.path.exists(out):
        wrong = "succeeds without an output"
    if code and error:
        verdict = verdict if verdict != "read" else "refused"
        how = error.decode("utf-8", "replace").strip().splitlines()[-1][:110] if how == "-" else how
    if os.path.exists(out):
        os.remove(out)
    return how, took, code, verdict, wrong


def main():
    ssdo, folder, options = sys.argv[1], sys.argv[2], sys.argv[3:]
    paths = sorted(os.path.join(where, name) for where, _, names in os.walk(folder) for name in names
                   if name.lower().endswith(".exr"))
    if not paths:
        sys.exit("no EXR file below %s" % folder)
    counts, bad = {}, 0
    print("| file | read how | seconds | exit | verdict |\n| --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        for path in paths:
            how, took, code, verdict, wrong = check(ssdo, path, options, os.path.join(scratch, "out.exr"))
            bad += bool(wrong)
            counts[verdict] = counts.get(verdict, 0) + 1
            print("| %s | %s | %.1f | %s | %s |" % (os.path.relpath(path, folder), how.replace("|", "/"), took, code,
                                                   "**%s**" % wrong if wrong else verdict), flush=True)
    print("\nfigure: %d files: %s; %d crashed, hung or broke a promise" %
          (len(paths), ", ".join("%d %s" % (n, v) for v, n in sorted(counts.items()) if v), bad))
    sys.exit(1 if bad else 0)


main()
