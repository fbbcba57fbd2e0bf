#!/bin/sh
# libraries.sh FOLDER FILE...: copies every shared library that the FILEs need into FOLDER, but those that a machine has of its own,
# and makes each copy find the others beside it. A FILE's own search path is the caller's to set.
set -eu
folder=$1
shift
mkdir -p "$folder"
# The machine's own: the C library and the compilers' run time (those of the machine are newer, and its driver needs them so); the
# driver, what dispatches to it, and what it talks to the display and the kernel by: two copies of these in a process do not meet.
# libGLX travels along: OpenCV names it, nobody calls it, and a machine without a display may lack it.
own='^(ld-linux|lib(c|m|dl|rt|pthread|resolv|util|nsl|anl|mvec|stdc\+\+|gcc_s)\.so|lib(GL|EGL|OpenGL|GLdispatch|GLES[v0-9_A-Z]*|gbm|glapi|drm[_a-z0-9]*)\.so'
own="$own"'|lib(X11|X11-xcb|xcb(-dri[23]|-present|-sync|-xfixes|-randr|-glx)?|Xau|Xdmcp|expat|z)\.so)'
for file in "$@"; do
    missing=$(ldd "$file" | grep 'not found' || true)
    [ -z "$missing" ] || { echo "libraries: $file: $missing" >&2; exit 1; }
    ldd "$file" | sed -n 's/^[[:space:]]*\([^ ]*\) => \(\/[^ ]*\) .*/\1 \2/p'
done | sort -u | grep -Ev "$own" | while read -r name path; do
    [ -e "$folder/$name" ] && continue
    cp -L "$path" "$folder/$name"
    chmod 755 "$folder/$name"
    patchelf --set-rpath '$ORIGIN' "$folder/$name"
done
