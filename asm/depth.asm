; Depth: evaluate and clamp, compare, leave when nothing is left, write (src/spec/depth.h).
; Registers as in interpolate.asm; m8 is the new depth, m9 the stored one.

%include "fragment.inc"
%include "constant.inc"

%define live            m2

; Argument: depth's plane.
fragment depth_new, TRIANGLE | CONSTANTS | DEPTH | M(0) | M(1), M(8) | M(9), M(10)
    fill 0,     vbroadcastss    m8, [at_triangle]
    fill 0,     vbroadcastss    m9, [at_triangle + 8]
                vxorps          m10, m10, m10
                vfmadd231ps     m8, m1, m9
    fill 0,     vbroadcastss    m9, [at_triangle + 4]
                vfmadd231ps     m8, m0, m9
                vmaxps          m8, m8, m10
                vmovaps         m9, [depth]
                vminps          m8, m8, [constants + ONE_F]
end_fragment

; Argument: the comparison's predicate as VCMPPS numbers it.
fragment depth_compare, M(2) | M(8) | M(9), M(2), M(10)
    fill_byte 0, vcmpps         m10, m8, m9, 0
                vandps          live, live, m10
end_fragment

; Argument: the part where the chunk ends.
fragment live_skip, M(2), NOTHING, NOTHING
                vtestps         live, live
    jump 0,     jz
end_fragment

fragment depth_write, DEPTH | M(2) | M(8) | M(9), NOTHING, M(9)
                vblendvps       m9, m9, m8, live
                vmovaps         [depth], m9
end_fragment
