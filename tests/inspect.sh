#!/bin/bash
# `triptych inspect`: what it prints and writes, and that the pictures of docs/inspecting.md are its own.
# GOLDENS=write only writes these pictures.
# Given BUILD and TRIPTYCH by tests/support/scripts/run.sh.
set -uo pipefail
cd "$(dirname "$0")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

verdict() # NAME PROBLEM : ok when there is none
{
    if [[ -z $2 ]]; then
        printf 'ok %s\n' "$1"
    else
        printf 'FAIL %s\n     %s\n' "$1" "$2"
        failures=1
    fi
}

inspect() # ARGUMENT... : prints to $work/out
{
    timeout 120 "$TRIPTYCH" inspect "$@" >"$work/out" 2>"$work/err" </dev/null
}

shows() # NAME PATTERN ARGUMENT... : exit status 0, and a line that the pattern matches
{
    local name=$1 pattern=$2 problem=
    shift 2
    if ! inspect "$@"; then
        problem="failed: $(head -n 1 "$work/err")"
    elif ! grep -qE -- "$pattern" "$work/out"; then
        problem="no line has \"$pattern\""
    fi
    verdict "$name" "$problem"
}

refuses() # NAME PATTERN ARGUMENT... : exit status 2, one line on stderr that the pattern matches, no output
{
    local name=$1 pattern=$2 status=0 problem=
    shift 2
    inspect "$@" || status=$?
    if ((status != 2)); then
        problem="exit status $status, expected 2"
    elif (($(wc -l <"$work/err") != 1)) || ! grep -qE -- "$pattern" "$work/err"; then
        problem="stderr is \"$(cat "$work/err")\", expected a line with \"$pattern\""
    elif [[ -s $work/out ]]; then
        problem='something on stdout'
    fi
    verdict "$name" "$problem"
}

json() # NAME PROGRAM : the Python expression holds for `j`, the report
{
    local problem
    problem=$(python3 -c "import json, sys
j = json.load(open(sys.argv[1]))
if not ($2): print('does not hold: ' + '''$2''')" "$work/j.json" 2>&1)
    verdict "$1" "$problem"
}

# The pictures of docs/inspecting.md.
picture() # FILE ARGUMENT...
{
    local file=docs/images/inspect/$1 problem=
    shift
    if [[ ${GOLDENS-} == write ]]; then
        inspect "$@" --overdraw "$file"
    elif ! inspect "$@" --overdraw "$work/picture.png" || ! "$TRIPTYCH" compare "$file" "$work/picture.png" >"$work/out"; then
        problem="differs: $(head -n 1 "$work/out")"
    fi
    verdict "$file is up to date" "$problem"
}

picture covered.png tests/data/scenes/foliage.tri
picture passed.png tests/data/scenes/foliage.tri --count passed
[[ ${GOLDENS-} != write ]] || exit "$failures"

cat >"$work/two.tri" <<'END'
triptych 1
target 40 30 depth d24s8
texture t 2d A8R8G8B8 4 4 fill { 0xff808080 }
vertices v position:float3 diffuse:color texcoord:float2 {
    -1 -1 0.5 0xff0000ff 0 0
    -1  1 0.5 0xff0000ff 0 1
     1 -1 0.5 0xff0000ff 1 0
     1  1 0.5 0xff0000ff 1 1
}
state lighting false
bind vertices v
clear color 0 0 0 1 depth 1
draw strip 0 2
state alphablendenable true
state srcblend srcalpha
bind texture t
sampler 0 magfilter linear
draw strip 0 2
END

shows 'the draws of a frame' '^ +1 +2 +1200 +1200 +1200 +line 18 +draw strip 0 2$' "$work/two.tri"
shows 'a state that differs from its default' '^  state alphablendenable true +default false$' "$work/two.tri" --draw 1
verdict 'states with their defaults are left out' "$(grep zfunc "$work/out")"
shows 'a sampler state' '^  sampler 0 magfilter linear +default point$' "$work/two.tri" --draw 1
shows 'a texture with its size and format' '^ +0 +t +2d +A8R8G8B8 +4 x 4 +1 +64 +sampled' "$work/two.tri" --draw 1
shows 'a buffer with its elements' '^  elements +v, 96 bytes, .*position:float3@0 diffuse:color@12 texcoord:float2@16$' \
    "$work/two.tri" --draw 1
shows 'the target' '^target: 40 x 30 pixels, 1 sample$' "$work/two.tri" --draw 1
shows 'the state of an earlier draw' '^draw strip 0 2: 2 primitives; pixels covered 1200, ' "$work/two.tri" --draw 0
verdict 'a later state is not in it' "$(grep blend "$work/out")"
shows 'the history of a pixel' '^    stored colour 0 +0 0 0 255 -> 0 0 255 255$' "$work/two.tri" --pixel 5,20
shows 'a clear in the history' '^line 12: clear color 0 0 0 1 depth 1$' "$work/two.tri" --pixel 5,20
shows 'a depth test in the history' '^    depth test +passes: 0.5 lessequal 0.5' "$work/two.tri" --pixel 5,20
shows 'overdraw' '^overdraw: counted 2400 times in 1200 pixels, at most 2 times in one' "$work/two.tri" --overdraw "$work/o.png" \
    --json "$work/j.json"
json 'overdraw as JSON' "j['overdraw']['most'] == 2 and j['overdraw']['rows'][2]['pixels'] == 1200"
"$TRIPTYCH" compare "$work/o.png" "$work/o.png" >/dev/null 2>&1
verdict 'the heat map is a picture' "$( (($? == 0)) || echo 'cannot be read')"

# The last values of histories are the pixels of the picture that another engine renders.
inspect tests/data/streams/stencil-shadow.tri --pixel 150,110 --json "$work/j.json"
"$TRIPTYCH" render tests/data/streams/stencil-shadow.tri --engine stitch --out "$work/p.png" 2>/dev/null ||
    "$TRIPTYCH" render tests/data/streams/stencil-shadow.tri --engine emulate --out "$work/p.png"
python3 - "$work/p.png" 150 110 >"$work/pixel" <<'END'
import struct, sys, zlib
data, x, y = open(sys.argv[1], 'rb').read(), int(sys.argv[2]), int(sys.argv[3])
at, body, width = 8, b'', 0
while at < len(data):
    size, kind = struct.unpack('>I4s', data[at:at + 8])
    if kind == b'IHDR': width, channels = struct.unpack('>I', data[at + 8:at + 12])[0], {2: 3, 6: 4}[data[at + 17]]
    if kind == b'IDAT': body += data[at + 8:at + 8 + size]
    at += size + 12
rows, pitch, before = zlib.decompress(body), width * channels, None
for r in range(y + 1):
    kind, row = rows[r * (pitch + 1)], bytearray(rows[r * (pitch + 1) + 1:(r + 1) * (pitch + 1)])
    before = before or bytearray(pitch)
    for i in range(pitch):
        a, b, c = row[i - channels] if i >= channels else 0, before[i], before[i - channels] if i >= channels else 0
        p = a + b - c
        paeth = min((a, b, c), key=lambda v: abs(p - v))
        row[i] = row[i] + (0, a, b, (a + b) // 2, paeth)[kind] & 255
    before = row
print(*(list(before[x * channels:(x + 1) * channels]) + [255])[:4])
END
json 'the last colour is that of the picture' \
    "j['pixel']['last'][0]['colors'][0]['bytes'] == [int(c) for c in open('$work/pixel').read().split()]"
json 'the history has the draws of the shadow' "any('stencil' in t for e in j['pixel']['events']
 for p in e.get('primitives', []) for t in p.get('tests', []))"

refuses 'no such draw' 'frame 0 has no draw 2, it has 2, from 0' "$work/two.tri" --draw 2
refuses 'no such frame' 'has no frame 1, its last is 0' "$work/two.tri" --frame 1
refuses 'a pixel outside of the target' 'pixel 40,0 is outside of the target of 40 x 30 pixels' "$work/two.tri" --pixel 40,0
refuses 'half a pixel' '--pixel is "4", expected X,Y' "$work/two.tri" --pixel 4
refuses 'a count without overdraw' '--count is given without --overdraw, expected both$' "$work/two.tri" --count shaded
refuses 'an unknown count' '--count is "all", expected one of: covered, shaded, passed' "$work/two.tri" --count all
cp "$work/two.tri" "$work/named.png" && mkdir "$work/folder.png"
refuses 'a heat map that is not a PNG' 'o.jpg: unknown kind of picture, expected .png$' "$work/two.tri" --overdraw "$work/o.jpg"
refuses 'a heat map over its stream' '--overdraw is ".*.png", the file of STREAM, expected another$' \
    "$work/named.png" --overdraw "$work/named.png"
refuses 'a folder as the heat map' 'is a folder' "$work/two.tri" --overdraw "$work/folder.png"
exit "$failures"
