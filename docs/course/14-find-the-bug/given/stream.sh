#!/bin/bash
# Prints a draw stream of lab 14: a square of 16 x 16 pixels with a pixel shader.
#
#   stream.sh NAME        infinite, fraction, product or exchange: the streams whose pictures are wrong;
#                         zero or factors: more inputs for what you mend
#
# The target has binary32 numbers, so a picture contains every bit of the result. The shader's inputs differ
# from pixel to pixel.
set -euo pipefail

infinite()
{
    cat <<'END'
    def c0, 0, 1e30, 0.5, 0.25
    dcl_texcoord v0
    mov_sat r0, v0
    mul r1, r0, c0.y
    mul r2, r1, c0.y
    mul r3, r2, c0.x
    add r4, r3, v0.wzyx
    mov oC0, r4
END
}

fraction()
{
    cat <<'END'
    def c0, 4, 2, 0.5, 0.25
    dcl_texcoord v0
    dcl_texcoord1 v1
    mad r0, v1, c0.x, c0.z
    frc r1, r0
    mul r2, r1, c0.y
    add r3, r2, v1
    mov oC0, r3
END
}

product()
{
    cat <<'END'
    def c0, 1, -1, -1.5, 0.25
    dcl_texcoord v0
    dcl_texcoord1 v1
    mov_sat r0, v0
    add r1, r0, c0.x
    mov_sat r2, v1
    add r3, -r2, c0.y
    mul r4, r1, r3
    min r5, r4, c0.z
    add r6, r5, v1
    mov oC0, r6
END
}

# The rule for a product with zero applies: the factor is from 1 to 2.
zero()
{
    cat <<'END'
    def c0, 0, 1, 0.5, 0.25
    dcl_texcoord v0
    mov_sat r0, v0
    add r1, r0, c0.y
    mul r2, r1, c0.x
    add r3, r2, v0.wzyx
    mov oC0, r3
END
}

# The factors of the stream product in the other order, and two positive ones.
factors()
{
    cat <<'END'
    def c0, 1, -1, -1.5, 2.5
    dcl_texcoord v0
    dcl_texcoord1 v1
    mov_sat r0, v1
    add r1, -r0, c0.y
    mov_sat r2, v0
    add r3, r2, c0.x
    mul r4, r1, r3
    min r5, r4, c0.z
    mul r6, r3, r3
    min r7, r6, c0.w
    add r8, r5, r7
    mov oC0, r8
END
}

exchange()
{
    cat <<'END'
    def c0, 0.75, 0.25, 0.5, 1
    defi i0, 5, 0, 1, 0
    dcl_texcoord v0
    dcl_texcoord1 v1
    mov r0, v1
    mov r1, c0
    rep i0
    mov r2, r0
    mov r0, r1
    mov r1, r2
    endrep
    mad r3, r0, c0.y, r1
    mov oC0, r3
END
}

case ${1-} in
infinite | fraction | product | exchange | zero | factors) ;;
*)
    echo 'usage: stream.sh infinite | fraction | product | exchange | zero | factors' >&2
    exit 2
    ;;
esac

cat <<'END'
triptych 1
target 16 16 color A32B32G32R32F
vertices square position:float3 texcoord:float4 texcoord1:float4 {
    -1  1 0   0.5  2   0.25 1      -3    1.5  2.5 -2
     1  1 0   1.5  0   0.75 0.5     3   -1.5  1    2
     1 -1 0  -0.5  1   0.5  3       0.5  2.5 -4    1.25
    -1 -1 0   0.25 0.5 2   -1       1    4    3   -1
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
shader wrong {
    ps_3_0
END
"$1"
cat <<'END'
}
clear color 0 0 0 1
state cullmode none
state zenable false
bind vertices square
vertexshader corners
pixelshader wrong
draw fan 0 2
frame
END
