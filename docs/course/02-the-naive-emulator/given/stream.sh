#!/bin/bash
# Prints a draw stream of lab 2: a square of 32 x 32 pixels with a pixel shader that executes an instruction
# COUNT times.
#
#   stream.sh COUNT INSTRUCTION
#
# INSTRUCTION writes r0 and reads r0 to r3, for example "lrp r0, r1, r2, r3". The numbers of r0 to r3 differ
# from pixel to pixel. The target has binary32 numbers, so a picture contains every bit of the result.
set -euo pipefail
cat <<'END'
triptych 1
target 32 32 color A32B32G32R32F
vertices square position:float3 texcoord:float4 texcoord1:float4 {
    -1  1 0   -1.5  0.25  3  0      0.1  7    -2   1e-3
     1  1 0    2    0.5  -1  1e-40  0.9 -3.5   4   1
     1 -1 0    0.75 1     0  1      0    0.01  1  -1
    -1 -1 0   -0.5  8     2 -1      1    1e9  -1   1e-30
}
shader corners {
    vs_3_0
    dcl_position v0
    dcl_texcoord v1
    dcl_texcoord1 v2
    dcl_position o0
    dcl_texcoord o1
    dcl_texcoord1 o2
    mov o0, v0
    mov o1, v1
    mov o2, v2
}
shader slots {
    ps_3_0
    dcl_texcoord v0
    dcl_texcoord1 v1
    mov r0, v0
    mov r1, v1
    mov r2, v0.wzyx
    mov r3, v1.yxwz
END
for ((i = 0; i < $1; i++)); do
    echo "    $2"
done
cat <<'END'
    mov oC0, r0
}
clear color 0 0 0 1
state cullmode none
state zenable false
bind vertices square
vertexshader corners
pixelshader slots
draw fan 0 2
frame
END
