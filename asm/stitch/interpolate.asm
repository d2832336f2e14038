; Interpolation: pixel position, coverage, planes (src/spec/pixel/interpolate.h).
;
; m14 and m15 are loaded once in a run and never changed.

%include "fragment.inc"
%include "constant.inc"

%define x               m0
%define y               m1
%define live            m2
%define w               m3

fragment pixel_constants, CONSTANTS, M(14) | M(15), NOTHING
                vmovdqa         m14, [constants + BYTE_X]
                vmovdqa         m15, [constants + HALF_X]
end_fragment

; Arguments: x, y of struct entry; origin_x, origin_y of the head; x, y of the lane table.
fragment position, ENTRY | TRIANGLE | LANES, M(0) | M(1), M(8) | M(9)
    fill .entry_x,   vbroadcastss    x, [at_entry]
    fill .entry_y,   vbroadcastss    y, [at_entry]
    fill .origin_x,  vbroadcastss    m8, [at_triangle]
    fill .origin_y,  vbroadcastss    m9, [at_triangle]
                vsubps          x, x, m8
                vsubps          y, y, m9
    fill .lane_x,    vaddps          x, x, [at_lanes]
    fill .lane_y,    vaddps          y, y, [at_lanes]
end_fragment

; Arguments: coverage of struct entry, bit of the lane table.
fragment coverage, ENTRY | LANES, M(2), M(8)
    fill .bit,       vmovdqu         m8, [at_lanes]
    fill .coverage,  vpbroadcastd    live, [at_entry]
                vpand           live, live, m8
                vpcmpeqd        live, live, m8
end_fragment

; One plane at the pixel: result = x * dx + (y * dy + value). The plane is three words from argument + offset.
%macro plane 4 ; result, scratch, argument, offset
    fill %3,    vbroadcastss    %1, [at_triangle + %4 + PLANE_VALUE]
    fill %3,    vbroadcastss    %2, [at_triangle + %4 + PLANE_DY]
                vfmadd231ps     %1, y, %2
    fill %3,    vbroadcastss    %2, [at_triangle + %4 + PLANE_DX]
                vfmadd231ps     %1, x, %2
%endmacro

; Argument: the plane of 1 / w.
fragment pixel_w, TRIANGLE | CONSTANTS | M(0) | M(1), M(3), M(8) | M(9)
                plane           w, m8, .plane, 0
                vmovaps         m9, [constants + ONE_F]
                vdivps          w, m9, w
end_fragment

; No varying is smooth, but a plane is read: the specification multiplies its value by 1.
fragment pixel_w_one, CONSTANTS, M(3), NOTHING
                vmovaps         w, [constants + ONE_F]
end_fragment

; Converts a channel from 0..1 to a byte. max and min in this order convert a NaN to 0.
%macro quantize 2 ; register, a zero
                vmulps          %1, %1, [constants + BYTE_F]
                vmaxps          %1, %1, %2
                vminps          %1, %1, [constants + BYTE_F]
                vcvtps2dq       %1, %1
%endmacro

; Packs bytes, red in m4, green in m5, blue in m10, alpha in m11, to pairs: m4 = 0 B | 0 R, m5 = 0 A | 0 G
%macro pack_pairs 0
                vpslld          m10, m10, 16
                vpslld          m11, m11, 16
                vpor            m4, m4, m10
                vpor            m5, m5, m11
%endmacro

%macro quantize_channels 0
                vxorps          m9, m9, m9
                quantize        m4, m9
                quantize        m5, m9
                quantize        m10, m9
                quantize        m11, m9
                pack_pairs
%endmacro

; Argument: the first of four planes.
fragment diffuse_smooth, TRIANGLE | CONSTANTS | M(0) | M(1) | M(3), M(4) | M(5), M_TO(8, 13)
                plane           m4, m8, .planes, 0
                plane           m5, m9, .planes, PLANE_BYTES
                plane           m10, m12, .planes, 2 * PLANE_BYTES
                plane           m11, m13, .planes, 3 * PLANE_BYTES
                vmulps          m4, m4, w
                vmulps          m5, m5, w
                vmulps          m10, m10, w
                vmulps          m11, m11, w
                quantize_channels
end_fragment

; Argument: the first of four words.
fragment diffuse_flat, TRIANGLE | CONSTANTS, M(4) | M(5), M_TO(9, 11)
    fill .words,     vbroadcastss    m4, [at_triangle]
    fill .words,     vbroadcastss    m5, [at_triangle + 4]
    fill .words,     vbroadcastss    m10, [at_triangle + 8]
    fill .words,     vbroadcastss    m11, [at_triangle + 12]
                quantize_channels
end_fragment

fragment diffuse_white, M(14), M(4) | M(5), NOTHING
                vmovdqa         m4, m14
                vmovdqa         m5, m14
end_fragment

; Argument: the first of two planes.
fragment texcoord_smooth, TRIANGLE | M(0) | M(1) | M(3), M(8) | M(9), M(10) | M(11)
                plane           m8, m10, .planes, 0
                plane           m9, m11, .planes, PLANE_BYTES
                vmulps          m8, m8, w
                vmulps          m9, m9, w
end_fragment

; Argument: the first of two words.
fragment texcoord_flat, TRIANGLE, M(8) | M(9), NOTHING
    fill .words,     vbroadcastss    m8, [at_triangle]
    fill .words,     vbroadcastss    m9, [at_triangle + 4]
end_fragment
