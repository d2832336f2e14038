; Depth: evaluate and clamp, compare, skip the chunk when no lane is live, write (src/spec/pixel/depth.h).
; Registers as in interpolate.asm. m8 is the new depth, m9 the stored one. The fragments named _unorm are
; for integers of at most 24 bits, stored in the upper bits of the word; there m8 is the integer.

%include "fragment.inc"
%include "constant.inc"

%define live            m2

; The plane at the pixel, at least 0, in m8; the stored depth in m9.
%macro evaluate_depth 0
    fill .plane, vbroadcastss    m8, [at_triangle + PLANE_VALUE]
    fill .plane, vbroadcastss    m9, [at_triangle + PLANE_DY]
                vxorps          m10, m10, m10
                vfmadd231ps     m8, m1, m9
    fill .plane, vbroadcastss    m9, [at_triangle + PLANE_DX]
                vfmadd231ps     m8, m0, m9
                vmaxps          m8, m8, m10
                vmovaps         m9, [depth]
                vminps          m8, m8, [constants + ONE_F]
%endmacro

; Argument: depth's plane.
fragment depth_new, TRIANGLE | CONSTANTS | DEPTH | M(0) | M(1), M(8) | M(9), M(10)
                evaluate_depth
end_fragment

; Arguments: depth's plane, 2^bits - 1 in the job.
fragment depth_new_unorm, TRIANGLE | CONSTANTS | DEPTH | JOB | M(0) | M(1), M(8) | M(9), M(10)
                evaluate_depth
    fill .depth_maximum, vbroadcastss    m10, [at_job]
                vmulps          m8, m8, m10
                vcvtps2dq       m8, m8
end_fragment

; Argument: the comparison's predicate in the encoding of VCMPPS.
fragment depth_compare, M(2) | M(8) | M(9), M(2), M(10)
    fill_byte .predicate, vcmpps         m10, m8, m9, 0
                vandps          live, live, m10
end_fragment

%macro keep_unorm 4 ; name, comparison, its operands of new m8 and stored m10
fragment %1, M(2) | M(8) | M(9), M(2), M(10)
                vpsrld          m10, m9, 8
                %2              m10, %3, %4
                vpand           live, live, m10
end_fragment
%endmacro

%macro drop_unorm 4 ; the same for lanes that are no longer live
fragment %1, M(2) | M(8) | M(9), M(2), M(10)
                vpsrld          m10, m9, 8
                %2              m10, %3, %4
                vpandn          live, m10, live
end_fragment
%endmacro

keep_unorm  depth_less_unorm, vpcmpgtd, m10, m8
keep_unorm  depth_equal_unorm, vpcmpeqd, m8, m10
drop_unorm  depth_less_equal_unorm, vpcmpgtd, m8, m10
keep_unorm  depth_greater_unorm, vpcmpgtd, m8, m10
drop_unorm  depth_not_equal_unorm, vpcmpeqd, m8, m10
drop_unorm  depth_greater_equal_unorm, vpcmpgtd, m10, m8

; Argument: the part where the chunk ends.
fragment live_skip, M(2), NOTHING, NOTHING
                vtestps         live, live
    jump .to_next,   jz
end_fragment

fragment depth_write, DEPTH | M(2) | M(8) | M(9), NOTHING, M(9)
                vblendvps       m9, m9, m8, live
                vmovaps         [depth], m9
end_fragment

; The stencil, in the lower bits, is unchanged.
fragment depth_write_unorm, DEPTH | M(2) | M(8) | M(9), NOTHING, M(8) | M(9) | M(10)
                vpslld          m10, m9, 24
                vpslld          m8, m8, 8
                vpsrld          m10, m10, 24
                vpor            m8, m8, m10
                vblendvps       m9, m9, m8, live
                vmovaps         [depth], m9
end_fragment
