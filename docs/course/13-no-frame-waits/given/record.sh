#!/bin/bash
# Prints a trace of the uses of pixel routines, for lab 13:
#
#   bash record.sh TRIPTYCH STREAM [FOLDER]
#
# A line `routine NUMBER INSTRUCTIONS BYTES` for each pixel routine of the stream, by specialize-8. Then, for
# each frame, the word `frame` and NUMBER:USES for each routine in the order of its first use. A use is a
# block of 8 shaded pixels. All frames must make the same draws. The answers of the commands are kept in
# FOLDER; street takes two minutes.
set -euo pipefail
triptych=$1 stream=$2 folder=${3:-$(mktemp -d)}
mkdir -p "$folder"
"$triptych" bench --code --engines specialize-8 --json "$folder/code" "$stream" >"$folder/log"
last=$("$triptych" inspect "$stream" --frame 999999 2>&1 | sed -n 's/.*its last is \([0-9]*\).*/\1/p') || true

ask() # FILE ARGUMENT...: an answer that is not yet in the folder
{
    local file=$1
    shift
    [[ -s $file ]] || "$triptych" "$@" >"$file"
}

for ((frame = 0; frame <= last; frame++)); do
    ask "$folder/frame.$frame" inspect "$stream" --frame $frame
done
for draw in $(awk 'NR > 1 { print $1 }' "$folder/frame.0"); do
    [[ -s $folder/key.$draw ]] ||
        "$triptych" dump "$stream" --draw "$draw" --show key --engine specialize-8 | sed -n 2p >"$folder/key.$draw"
done
export folder last
awk -f - <<'EOF'
function read_routines(   text, unit, key, instructions, bytes) {
    while ((getline text < (folder "/code")) > 0) {
        if (text ~ /"unit":/) unit = text
        if (text ~ /"key":/) { key = text; gsub(/.*"key":[ \t]*"|",?$/, "", key) }
        if (text ~ /"code_bytes":/) { bytes = text; gsub(/[^0-9]/, "", bytes) }
        if (text ~ /"instructions":/ && unit ~ /pixel/) {
            instructions = text; gsub(/[^0-9]/, "", instructions)
            number[key] = routines
            print "routine", routines++, instructions, bytes
        }
    }
}
function read_keys(   name, draw, key) {
    for (draw = 0; (getline key < (folder "/key." draw)) > 0; draw++) {
        if (!(key in number)) { print "the key of draw " draw " has no routine: " key > "/dev/stderr"; exit 1 }
        routine_of[draw] = number[key]
    }
}
function word(text) {
    if (length(line) + length(text) > 100) { print line; line = "" }
    line = line (line == "" ? "" : " ") text
}
function read_frame(file,   text, field, order, count, uses, i) {
    split("", uses); count = 0
    while ((getline text < file) > 0) {
        split(text, field, " ")
        if (field[1] !~ /^[0-9]+$/ || field[4] == 0) continue
        i = routine_of[field[1]]
        if (!(i in uses)) order[count++] = i
        uses[i] += int((field[4] + 7) / 8)
    }
    print "frame"
    for (i = 0; i < count; i++) word(order[i] ":" uses[order[i]])
    print line; line = ""
}
BEGIN {
    routines = 0; folder = ENVIRON["folder"]; last = ENVIRON["last"]
    print "# Uses of pixel routines, by record.sh: routine NUMBER INSTRUCTIONS BYTES, and for each frame NUMBER:USES."
    read_routines()
    read_keys()
    for (frame = 0; frame <= last; frame++) read_frame(folder "/frame." frame)
}
EOF
