#!/bin/bash
# The pass that change.patch adds, negate: it is listed, `triptych dump` shows the program after it, it
# removes a double negation, and pictures stay the same with every engine.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

grep -q '^negate ' < <("$TRIPTYCH" list passes)

cat >"$work/twice.tri" <<'STREAM'
triptych 1
target 16 16
vertices square position:float3 texcoord:float2 {
    -1  1 0   0 0
     1  1 0   1 0
     1 -1 0   1 1
    -1 -1 0   0 1
}
shader corners {
    vs_2_0
    dcl_position v0
    dcl_texcoord v1
    mov oPos, v0
    mov oT0, v1
}
shader twice {
    ps_2_0
    dcl t0
    mov r0, -t0
    mov r1, -r0
    mov oC0, r1
}
clear color 0 0 0 1
state cullmode none
state zenable false
state lighting false
bind vertices square
vertexshader corners
pixelshader twice
draw fan 0 2
frame
STREAM

dump() # STAGE: of the pixel routine
{
    "$TRIPTYCH" dump "$work/twice.tri" --draw 0 --unit pixel --engine specialize-8 --show "$1"
}
dump negate >"$work/after"
grep -q '^== after negate: double negations are removed$' "$work/after"
[[ $(dump record | grep -c neg_f) -gt 0 ]]
[[ $(dump dead | awk '/^== after dead/ { count = 0 } / neg_f / { count++ } END { print count + 0 }') == 0 ]]

"$TRIPTYCH" verify "$work/twice.tri" --frames 1 --threads 1,2 | tail -1 | grep -q identical
