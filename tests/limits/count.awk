# What each program declares, used or not, against what OpenGL 4.5 core promises of every device (its tables 23.60 to 23.67). Reads
# preprocessed GLSL, a line "@variant NAME" before each program. Prints what is too much and exits 1; else prints the greatest counts.
function worst(what, n) { if (n > most[what]) most[what] = n }
function check(what, n, limit) {
    worst(what, n)
    if (n > limit) { printf "limits: %s: %d %s, GL promises %d\n", name, n, what, limit; bad = 1 }
}
function close_program() {
    if (name == "") return
    check("images", images, 8)
    check("samplers", samplers, 16)
    check("storage blocks", storage, 8)
    check("uniform blocks", blocks, 14)
    check("images, storage blocks and outputs together", images + storage + outputs, 8)
    check("invocations of a work group", side_x * side_y, 1024)
    check("bytes of shared memory", shared, 32768)
    programs++
}
function size_of(type) {
    if (type ~ /^(float|int|uint)$/) return 4
    if (type ~ /^[iu]?vec2$/) return 8
    return 16 # a vec4; there is nothing else
}
function elements(text,  n) {
    if (!match(text, /\[[^]]+\]/)) return 1
    n = substr(text, RSTART + 1, RLENGTH - 2) + 0
    return n > 0 ? n : 1
}
/^@variant / {
    close_program()
    name = substr($0, 10)
    images = samplers = storage = blocks = outputs = shared = inside = 0
    side_x = side_y = 1
    next
}
inside && /}/ { inside = 0; check("bytes of a uniform block", bytes, 16384); next }
inside && NF >= 2 { # "vec4 a, b[3];"
    n = split(substr($0, index($0, $2)), part, ",")
    for (i = 1; i <= n; i++) bytes += size_of($1) * elements(part[i])
    next
}
/binding *= *[0-9]+/ { match($0, /binding *= *[0-9]+/); b = substr($0, RSTART, RLENGTH); sub(/[^0-9]*/, "", b); check("as a binding", b + 0, 7) }
/local_size_x/ {
    match($0, /local_size_x *= *[0-9]+/); side_x = substr($0, RSTART, RLENGTH); sub(/[^0-9]*/, "", side_x)
    match($0, /local_size_y *= *[0-9]+/); side_y = substr($0, RSTART, RLENGTH); sub(/[^0-9]*/, "", side_y)
}
/uniform +[iu]?image2D/ { images++; next }
/uniform +[iu]?sampler/ { samplers++; next }
/(^|[ )])buffer +[A-Za-z]/ { storage++; next }
/layout *\(.*location.*\) *out / { outputs++; next }
/^ *shared / { shared += size_of($2) * elements($0); next }
/uniform +[A-Za-z]+ *{/ { blocks++; inside = 1; bytes = 0; next }
END {
    close_program()
    if (bad) exit 1
    printf "limits: %d programs; at most", programs
    for (what in most) printf " %d %s;", most[what], what
    print ""
}
