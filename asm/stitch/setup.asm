; Setup: projection, area and culling, triangle records (src/spec/setup/setup.h). Each lane is a triangle.
;
; The results of the three corners of eight triangles exceed the registers. They are stored in the stack
; frame, corner i at [frame + i * CORNER_BYTES]:
;
;   LANE   1/W   WINDOW_X   WINDOW_Y   X   Y   CORNER_DEPTH         32 bytes each
;
; Registers after `area`:             and after `gradients`:
;   m0  dx1       m2  dx2                m0  v2        m2  v1
;   m1  dy1       m3  dy2                m1  u2        m3  u1
;   m4  area      m5  visible            m5  visible
; m6 to m15 are scratch. Records are `stride` bytes apart, and stride_3 is three times that. With one step of
; four records, every record has an address without further arithmetic.

%include "fragment.inc"
%include "constant.inc"
%include "gather.inc"

LANE            equ 0
RECIPROCAL_W    equ 32
WINDOW_X        equ 64
WINDOW_Y        equ 96
X               equ 128
Y               equ 160
CORNER_DEPTH    equ 192
CORNER_BYTES    equ 224

section .rodata
    global stitch_corner_bytes:data hidden
stitch_corner_bytes:
    dd CORNER_BYTES

%define corner(i, field) frame + (i) * CORNER_BYTES + field

; Argument: bytes of a record.
fragment record_stride, NOTHING, STRIDE | STRIDE_3, NOTHING
    fill .bytes,     mov             r12d, strict dword 0
                lea             stride_3, [stride + stride * 2]
end_fragment

; Gathers a component of eight vertices.
%macro gather_slot 4 ; numbers of result and scratch register; address of the byte offsets; argument
    fill %4,    lea             rax, [at_vertices]
                gather_words    %1, %2, %3, rax, 1
%endmacro

; Scales and limits ndc. max and min in this order map a NaN to the lower limit.
%macro window_position 3 ; ndc and result, scale, offset
                vfmadd213ps     %1, %2, %3
                vmaxps          %1, %1, [constants + WINDOW_LOW_F]
                vminps          %1, %1, [constants + WINDOW_HIGH_F]
                vcvtps2dq       %1, %1
%endmacro

; Arguments: row of the indices, corner in the frame, slots of x, y and w, the job's scale_x offset_x scale_y
; offset_y.
fragment project, FRAME | CONSTANTS | JOB | INPUT | VERTICES, M(2), \
                  R_AX | R_CX | R_DX | R_13 | M(0) | M(1) | M_TO(3, 9)
    fill .row,   lea             r13, [at_input]
                vmovdqu         m1, [r13]
                gather_slot     2, 3, r13, .w
                vmovaps         m0, [constants + ONE_F]
                gather_slot     4, 3, r13, .x
                gather_slot     5, 3, r13, .y
                vdivps          m2, m0, m2
    fill .viewport, vbroadcastss m6, [at_job + VIEWPORT_SCALE_X]
    fill .viewport, vbroadcastss m7, [at_job + VIEWPORT_OFFSET_X]
    fill .viewport, vbroadcastss m8, [at_job + VIEWPORT_SCALE_Y]
    fill .viewport, vbroadcastss m9, [at_job + VIEWPORT_OFFSET_Y]
                vmulps          m4, m4, m2
                vmulps          m5, m5, m2
                window_position m4, m6, m7
                window_position m5, m8, m9
                vcvtdq2ps       m6, m4
                vcvtdq2ps       m7, m5
                vmulps          m6, m6, [constants + SUBPIXEL_F]
                vmulps          m7, m7, [constants + SUBPIXEL_F]
    fill .corner, vmovdqa        [corner(0, LANE)], m1
    fill .corner, vmovaps        [corner(0, RECIPROCAL_W)], m2
    fill .corner, vmovdqa        [corner(0, WINDOW_X)], m4
    fill .corner, vmovdqa        [corner(0, WINDOW_Y)], m5
    fill .corner, vmovaps        [corner(0, X)], m6
    fill .corner, vmovaps        [corner(0, Y)], m7
end_fragment

; After `project`. Arguments: slot of z, corner in the frame, the job's depth_scale depth_offset.
fragment project_depth, FRAME | JOB | VERTICES | M(2), NOTHING, \
                        R_AX | R_CX | R_DX | R_13 | M(3) | M(4) | M(6) | M(7)
    fill .corner,    lea             r13, [corner(0, LANE)]
                gather_slot     4, 3, r13, .z
    fill .depth_scale, vbroadcastss    m6, [at_job]
    fill .depth_scale, vbroadcastss    m7, [at_job + VIEWPORT_DEPTH_OFFSET]
                vmulps          m4, m4, m2
                vfmadd213ps     m4, m6, m7
    fill .corner,    vmovaps         [corner(0, CORNER_DEPTH)], m4
end_fragment

; Twice the area with Kahan's correction: p = dx2 * dy1 rounded, and the error of its rounding.
fragment area, FRAME, M_TO(0, 4), M_TO(5, 7)
                vmovaps         m6, [corner(0, X)]
                vmovaps         m7, [corner(0, Y)]
                vmovaps         m0, [corner(1, X)]
                vmovaps         m1, [corner(1, Y)]
                vmovaps         m2, [corner(2, X)]
                vmovaps         m3, [corner(2, Y)]
                vsubps          m0, m0, m6
                vsubps          m1, m1, m7
                vsubps          m2, m2, m6
                vsubps          m3, m3, m7
                vmulps          m5, m2, m1                  ; p
                vmovaps         m4, m0
                vmovaps         m6, m2
                vfmsub213ps     m6, m1, m5                  ; dx2 * dy1 - p, the error
                vfmsub213ps     m4, m3, m5                  ; dx1 * dy2 - p
                vsubps          m4, m4, m6
end_fragment

; Argument: VCMPPS predicate of area against 0.
fragment visible, M(4), M(5), M(6)
                vxorps          m6, m6, m6
    fill_byte .predicate, vcmpps         m5, m4, m6, 0
end_fragment

; The head has nine words. Eight of them are the rows of an 8x8 matrix whose columns are the heads. The
; ninth is stored by itself.
;
;   m8  visible 0..7     m12 y0                s0 = visible x0 x1 x2 | of triangle 0, of triangle 4
;   m9  x0               m13 y1       ->       s4 = y0 y1 y2 origin_x | of the same
;   m10 x1               m14 y2
;   m11 x2               m15 origin_x
%macro transpose_4 6 ; four rows; two scratch. Row i becomes columns i (low halves) and i + 4
                vunpcklps       %5, %1, %2
                vunpckhps       %1, %1, %2
                vunpcklps       %6, %3, %4
                vunpckhps       %3, %3, %4
                vunpckhpd       %2, %5, %6
                vunpckhpd       %4, %1, %3
                vunpcklpd       %3, %1, %3
                vunpcklpd       %1, %5, %6
%endmacro

fragment record_head, FRAME | OUTPUT | STRIDE | STRIDE_3 | M(4) | M(5), NOTHING, R_AX | M_TO(6, 15)
                vxorps          m6, m6, m6
                vcmpltps        m6, m4, m6                  ; counterclockwise: exchange corners 1 and 2
                vmovdqa         m7, [corner(1, WINDOW_X)]
                vmovdqa         m8, [corner(2, WINDOW_X)]
                vblendvps       m10, m7, m8, m6
                vblendvps       m11, m8, m7, m6
                vmovdqa         m7, [corner(1, WINDOW_Y)]
                vmovdqa         m8, [corner(2, WINDOW_Y)]
                vblendvps       m13, m7, m8, m6
                vblendvps       m14, m8, m7, m6
                vmovaps         m8, m5
                vmovdqa         m9, [corner(0, WINDOW_X)]
                vmovdqa         m12, [corner(0, WINDOW_Y)]
                vmovaps         m15, [corner(0, X)]
                transpose_4     m8, m9, m10, m11, m6, m7
                transpose_4     m12, m13, m14, m15, m6, m7
                vmovaps         m6, [corner(0, Y)]
                lea             rax, [output + stride * 4]
                vextractf128    xm7, m6, 1
                vmovaps         [output + HEAD_VISIBLE], xm8
                vmovaps         [output + HEAD_Y], xm12
                vmovss          [output + HEAD_ORIGIN_Y], xm6
                vmovaps         [output + stride + HEAD_VISIBLE], xm9
                vmovaps         [output + stride + HEAD_Y], xm13
                vextractps      [output + stride + HEAD_ORIGIN_Y], xm6, 1
                vmovaps         [output + stride * 2 + HEAD_VISIBLE], xm10
                vmovaps         [output + stride * 2 + HEAD_Y], xm14
                vextractps      [output + stride * 2 + HEAD_ORIGIN_Y], xm6, 2
                vmovaps         [output + stride_3 + HEAD_VISIBLE], xm11
                vmovaps         [output + stride_3 + HEAD_Y], xm15
                vextractps      [output + stride_3 + HEAD_ORIGIN_Y], xm6, 3
                vextractf128    [rax + HEAD_VISIBLE], m8, 1
                vextractf128    [rax + HEAD_Y], m12, 1
                vmovss          [rax + HEAD_ORIGIN_Y], xm7
                vextractf128    [rax + stride + HEAD_VISIBLE], m9, 1
                vextractf128    [rax + stride + HEAD_Y], m13, 1
                vextractps      [rax + stride + HEAD_ORIGIN_Y], xm7, 1
                vextractf128    [rax + stride * 2 + HEAD_VISIBLE], m10, 1
                vextractf128    [rax + stride * 2 + HEAD_Y], m14, 1
                vextractps      [rax + stride * 2 + HEAD_ORIGIN_Y], xm7, 2
                vextractf128    [rax + stride_3 + HEAD_VISIBLE], m11, 1
                vextractf128    [rax + stride_3 + HEAD_Y], m15, 1
                vextractps      [rax + stride_3 + HEAD_ORIGIN_Y], xm7, 3
end_fragment

; Argument: the part at the end of the loop's body.
fragment visible_skip, M(5), NOTHING, NOTHING
                vtestps         m5, m5
    jump .to_next,   jz
end_fragment

fragment gradients, CONSTANTS | M_TO(0, 4), M_TO(0, 3), M(4) | M(6)
                vmovaps         m6, [constants + ONE_F]
                vdivps          m4, m6, m4
                vxorps          m6, m4, [constants + SIGN]
                vmulps          m3, m3, m4                  ; u1 =  dy2 / area
                vmulps          m1, m1, m6                  ; u2 = -dy1 / area
                vmulps          m2, m2, m6                  ; v1 = -dx2 / area
                vmulps          m0, m0, m4                  ; v2 =  dx1 / area
end_fragment

; Stores four planes of three words: value and dx together, then dy.
;   pairs  v0 x0 v1 x1   v2 x2 v3 x3
%macro store_planes 3 ; pairs 0 1, pairs 2 3, dy
                vmovlps         [rax + PLANE_VALUE], %1
                vmovss          [rax + PLANE_DY], %3
                vmovhps         [rax + stride + PLANE_VALUE], %1
                vextractps      [rax + stride + PLANE_DY], %3, 1
                vmovlps         [rax + stride * 2 + PLANE_VALUE], %2
                vextractps      [rax + stride * 2 + PLANE_DY], %3, 2
                vmovhps         [rax + stride_3 + PLANE_VALUE], %2
                vextractps      [rax + stride_3 + PLANE_DY], %3, 3
%endmacro

; From the values at the corners, m8 m9 m10, computes the planes m8 + m11 x + m12 y.
%macro make_plane 0
                vsubps          m9, m9, m8                  ; d1
                vsubps          m10, m10, m8                ; d2
                vmulps          m11, m10, m1
                vmulps          m12, m10, m0
                vfmadd231ps     m11, m9, m3                 ; dx = d1 * u1 + (d2 * u2)
                vfmadd231ps     m12, m9, m2                 ; dy = d1 * v1 + (d2 * v2)
%endmacro

%macro store_plane 1 ; argument
    fill %1,    lea             rax, [at_output]
                vunpcklps       m9, m8, m11
                vunpckhps       m10, m8, m11
                store_planes    xm9, xm10, xm12
                lea             rax, [rax + stride * 4]
                vextractf128    xm9, m9, 1
                vextractf128    xm10, m10, 1
                vextractf128    xm12, m12, 1
                store_planes    xm9, xm10, xm12
%endmacro

%macro record_plane 1 ; argument
                make_plane
                store_plane     %1
%endmacro

%macro corner_plane 2 ; name, field of the corners
fragment %1, FRAME | OUTPUT | STRIDE | STRIDE_3 | M_TO(0, 3), NOTHING, R_AX | M_TO(8, 12)
                vmovaps         m8, [corner(0, %2)]
                vmovaps         m9, [corner(1, %2)]
                vmovaps         m10, [corner(2, %2)]
                record_plane    .plane
end_fragment
%endmacro

; Argument: the plane in the record.
corner_plane depth_plane, CORNER_DEPTH
corner_plane reciprocal_w_plane, RECIPROCAL_W

; With a bias. Arguments: the plane in the record, the job's bias, the job's factor of the slope.
%macro biased_plane 2 ; name, 1 if there is a factor
fragment %1, FRAME | JOB | CONSTANTS | OUTPUT | STRIDE | STRIDE_3 | M_TO(0, 3), NOTHING, \
             R_AX | M(6) | M(7) | M_TO(8, 12)
                vmovaps         m8, [corner(0, CORNER_DEPTH)]
                vmovaps         m9, [corner(1, CORNER_DEPTH)]
                vmovaps         m10, [corner(2, CORNER_DEPTH)]
                make_plane
    fill .bias,  vbroadcastss    m10, [at_job]
  %if %2
                vmovaps         m9, [constants + SIGN]
                vxorps          m6, m11, m9
                vxorps          m7, m12, m9
                vmaxps          m6, m11, m6
                vmaxps          m7, m12, m7
                vmaxps          m6, m6, m7                  ; the greatest slope
    fill .slope, vbroadcastss    m7, [at_job]
                vfmadd231ps     m10, m6, m7
  %endif
                vaddps          m8, m8, m10
                store_plane     .plane
end_fragment
%endmacro

biased_plane depth_plane_bias, 0
biased_plane depth_plane_slope, 1

; Arguments: slot of the component, the plane in the record.
fragment smooth_plane, FRAME | VERTICES | OUTPUT | STRIDE | STRIDE_3 | M_TO(0, 3), NOTHING, \
                       R_AX | R_CX | R_DX | M_TO(6, 12)
                gather_slot     8, 6, corner(0, LANE), .slot
                gather_words    9, 7, corner(1, LANE), rax, 1
                gather_words    10, 6, corner(2, LANE), rax, 1
                vmulps          m8, m8, [corner(0, RECIPROCAL_W)]
                vmulps          m9, m9, [corner(1, RECIPROCAL_W)]
                vmulps          m10, m10, [corner(2, RECIPROCAL_W)]
                record_plane    .plane
end_fragment

%macro store_words 1 ; four words
                vmovss          [rax], %1
                vextractps      [rax + stride], %1, 1
                vextractps      [rax + stride * 2], %1, 2
                vextractps      [rax + stride_3], %1, 3
%endmacro

; The first corner's value. Arguments: slot of the component, the word in the record.
fragment flat_word, FRAME | VERTICES | OUTPUT | STRIDE | STRIDE_3, NOTHING, R_AX | R_CX | R_DX | M(6) | M(8)
                gather_slot     8, 6, corner(0, LANE), .slot
    fill .word,      lea             rax, [at_output]
                store_words     xm8
                lea             rax, [rax + stride * 4]
                vextractf128    xm8, m8, 1
                store_words     xm8
end_fragment
