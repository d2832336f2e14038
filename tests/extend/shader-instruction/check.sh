#!/bin/bash
# The instruction med3, the middle of three values: assembled, validated, printed, and drawn by every engine.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/middle.psa" <<'SHADER'
ps_3_0
def c0, 0.25, 0.5, 0.75, 1
dcl_texcoord v0
med3 r0, v0.xyxy, c0.xyzw, c0.wzyx
mov oC0, r0
SHADER

# Text to bytecode and back: the same text.
"$TRIPTYCH" shader validate "$work/middle.psa" >/dev/null
"$TRIPTYCH" shader assemble --out "$work/middle.pso" "$work/middle.psa"
"$TRIPTYCH" shader disassemble "$work/middle.psa" >"$work/first"
"$TRIPTYCH" shader disassemble "$work/middle.pso" >"$work/second"
cmp "$work/first" "$work/second"
grep -q '^med3 r0, v0.xyxy, c0, c0.wzyx$' "$work/first"
grep -q med3 < <("$TRIPTYCH" list shaders) # A pipe would fail here: grep ends before the list does.

# A source that was never written is refused.
sed 's/v0.xyxy/r1/' "$work/middle.psa" >"$work/unwritten.psa"
if "$TRIPTYCH" shader validate "$work/unwritten.psa" 2>"$work/reason"; then exit 1; fi
grep -q 'found r1.x, expected something to write it' "$work/reason"

cat >"$work/middle.tri" <<STREAM
triptych 1
target 32 32
vertices square position:float3 texcoord:float2 {
    -1  1 0   0 0
     1  1 0   1 0
     1 -1 0   1 1
    -1 -1 0   0 1
}
shader corners {
    vs_3_0
    dcl_position v0
    dcl_texcoord v1
    dcl_position o0
    dcl_texcoord o1
    mov o0, v0
    mov o1, v1
}
shader middle "middle.psa"
clear color 0 0 0 1
state cullmode none
state zenable false
bind vertices square
vertexshader corners
pixelshader middle
draw fan 0 2
frame
STREAM
"$TRIPTYCH" verify "$work/middle.tri" --threads 2 | tail -1 | grep -q identical
