"""Prints the circles among the includes of src: of headers, and of modules. A module is a .c and the .h of its name. A header without a
.c of its own (types, or what the files of a room share) belongs to each module that includes it. Prints nothing where there is none."""
import glob
import os
import re
import sys


def includes_of(path):
    with open(path) as f:
        return [os.path.normpath(i) for i in re.findall(r'^#include "([^"]+)"', f.read(), re.M)]


def circles(graph):
    """The strongly connected sets of more than one node (Tarjan 1972)."""
    order, low, stack, found = {}, {}, [], []

    def visit(v):
        order[v] = low[v] = len(order)
        stack.append(v)
        for w in graph.get(v, ()):
            if w not in order:
                visit(w)
            if w in stack:
                low[v] = min(low[v], low[w])
        if low[v] == order[v]:
            at = stack.index(v)
            if len(stack) - at > 1:
                found.append(sorted(stack[at:]))
            del stack[at:]

    for v in list(graph):
        if v not in order:
            visit(v)
    return found


def modules(headers, sources):
    """What each module includes, also through headers that belong to no module."""
    names = {os.path.splitext(s)[0] for s in sources}

    def reached(path, seen):
        for i in sources.get(path) or headers.get(path, []):
            name = os.path.splitext(i)[0]
            if name in names:
                yield name
            elif i not in seen:
                seen.add(i)
                yield from reached(i, seen)

    return {n: {m for p in (n + ".c", n + ".h") for m in reached(p, set())} - {n} for n in names}


os.chdir(sys.argv[1] if len(sys.argv) > 1 else "src")
headers, sources = ({p: includes_of(p) for p in glob.glob("*/*" + end)} for end in (".h", ".c"))
if not headers or not sources:
    sys.exit("include_circles.py: no sources here")
for kind, graph in (("headers", headers), ("modules", modules(headers, sources))):
    for circle in circles(graph):
        print(f"{kind}: {' '.join(circle)}")
