# SPDX-License-Identifier: CC0-1.0
"""Runs the tasks of an Open Job Description template, as far as samples/farm/openjd.yaml goes: a stand-in where openjd-cli is not.

    python3 tests/farm/openjd.py samples/farm/openjd.yaml -p InputFolder=in -p OutputFolder=out -p Frames=1-12

Checks the template against the rules of specification 2023-09 that it touches, makes the chunks, fills in the format strings, runs
each task's command without a shell, reads the openjd_ lines it prints and stops at the first task that fails. Exits 1 on any of it.
"""
import argparse
import re
import subprocess
import sys

import yaml

PERIOD = (1, 600)  # of a notify period, in seconds


def need(truth, message):
    if not truth:
        sys.exit("openjd: " + message)


def known(thing, allowed, where):
    for key in thing:
        need(key in allowed, "%s has an unknown key '%s'" % (where, key))


def check(t):
    known(t, {"specificationVersion", "extensions", "name", "description", "parameterDefinitions", "steps"}, "the template")
    need(t["specificationVersion"] == "jobtemplate-2023-09", "another specification")
    for p in t["parameterDefinitions"]:
        known(p, {"name", "type", "objectType", "dataFlow", "description", "default", "minValue"}, "a parameter")
        need(re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{0,63}", p["name"]), "the name '%s'" % p["name"])
        need(p["type"] in ("STRING", "INT", "FLOAT", "PATH"), "the type of " + p["name"])
        need("objectType" not in p or p["type"] == "PATH", "objectType of " + p["name"])
    need(len(t["steps"]) == 1, "one step is expected")
    step = t["steps"][0]
    known(step, {"name", "parameterSpace", "script", "hostRequirements"}, "the step")
    run = step["script"]["actions"]["onRun"]
    known(run, {"command", "args", "timeout", "cancelation"}, "onRun")
    need(isinstance(run["timeout"], int) and run["timeout"] > 0, "timeout")
    cancel = run["cancelation"]
    known(cancel, {"mode", "notifyPeriodInSeconds"}, "cancelation")
    need(cancel["mode"] == "NOTIFY_THEN_TERMINATE", "the cancel mode")
    need(PERIOD[0] <= cancel["notifyPeriodInSeconds"] <= PERIOD[1], "the notify period")
    gpus = [a for a in step["hostRequirements"]["amounts"] if a["name"] == "amount.worker.gpu"]
    need(len(gpus) == 1 and gpus[0]["min"] == 0, "the GPU is to be an optional requirement")
    (frames,) = step["parameterSpace"]["taskParameterDefinitions"]
    need(frames["type"] == "CHUNK[INT]" and "TASK_CHUNKING" in t["extensions"], "chunked frames need TASK_CHUNKING")
    need(frames["chunks"]["rangeConstraint"] in ("CONTIGUOUS", "NONCONTIGUOUS"), "the range constraint")
    return step, run, frames


def fill(text, values):
    def value(match):
        need(match[1] in values, "nothing is called '%s'" % match[1])
        return str(values[match[1]])
    return re.sub(r"\{\{\s*([A-Za-z0-9_.]+)\s*\}\}", value, text)


def parameters(t, given):
    values = {}
    for p in t["parameterDefinitions"]:
        value = given.pop(p["name"], p.get("default"))
        need(value is not None, "the parameter '%s' is missing" % p["name"])
        values["Param." + p["name"]] = value
    need(not given, "there is no parameter " + ", ".join(given))
    return values


def expand(text):
    frames = []
    for item in text.split(","):
        m = re.fullmatch(r"\s*(-?\d+)\s*(?:-\s*(-?\d+)\s*(?::\s*(\d+))?)?\s*", item)
        need(m, "'%s' is not a range" % item)
        frames += range(int(m[1]), int(m[2] or m[1]) + 1, int(m[3] or 1))
    need(len(set(frames)) == len(frames), "the ranges overlap")
    return sorted(frames)


def range_text(frames):
    """Runs of neighbours as ranges, the rest one by one: 1-3,5,7-9."""
    runs = []
    for f in frames:
        if runs and f == runs[-1][1] + 1:
            runs[-1][1] = f
        else:
            runs.append([f, f])
    return ",".join(str(a) if a == b else "%d-%d" % (a, b) for a, b in runs)


def run_task(command):
    """The percents and the failure it told, and its exit code."""
    percents, told = [], []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as task:
        for line in task.stdout:
            if m := re.fullmatch(r"openjd_progress: (\d+(?:\.\d+)?)\n", line):
                percents.append(float(m[1]))
            elif line.startswith("openjd_fail: "):
                told.append(line[13:].rstrip())
    return percents, told, task.returncode


def main():
    parser = argparse.ArgumentParser(prog="openjd.py")
    parser.add_argument("template")
    parser.add_argument("-p", action="append", default=[], metavar="NAME=VALUE")
    args = parser.parse_args()
    with open(args.template) as f:
        template = yaml.safe_load(f)
    step, run, frames = check(template)
    values = parameters(template, dict(p.split("=", 1) for p in args.p))
    every, size = expand(fill(frames["range"], values)), int(fill(str(frames["chunks"]["defaultTaskCount"]), values))
    for i in range(0, len(every), size):
        values["Task.Param." + frames["name"]] = range_text(every[i:i + size])
        command = [fill(run["command"], values)] + [fill(a, values) for a in run["args"]]
        percents, told, code = run_task(command)
        need(code == 0 and not told, "task %s ended with %d: %s" % (range_text(every[i:i + size]), code, "; ".join(told)))
        need(percents and percents == sorted(percents) and percents[-1] == 100, "the percents were %s" % percents)
    print("openjd: %d tasks of at most %d frames" % (-(-len(every) // size), size))


main()
