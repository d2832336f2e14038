; The clip code (src/spec/vertex/clip.h) of the clip-space position in m8 to m11.
;
; Bits are computed from the highest to the lowest. Doubling the code and subtracting a mask, which is -1
; where the vertex is outside, appends one bit. "Outside" is "not less or equal", unordered, so a NaN is
; outside of every plane.

%include "fragment.inc"
%include "constant.inc"

%define x               m8
%define y               m9
%define z               m10
%define w               m11
%define code            m12
%define outer           m13
%define bound           m14
%define sign            m15

; Appends the bit of not (a <= b).
%macro outside 2 ; a, b
                vcmpnleps       outer, %1, %2
                vpaddd          code, code, code
                vpsubd          code, code, outer
%endmacro

; Appends the bit of the upper bound, then that of the lower bound, which is minus the upper.
%macro outside_pair 1 ; value
                outside         %1, bound
                vxorps          bound, bound, sign
                outside         bound, %1
%endmacro

; Arguments: the bounds of the job's guard band, slot of the code.
fragment clip_code, JOB | OUTPUT | CONSTANTS | M_TO(8, 11), NOTHING, M(7) | M_TO(12, 15)
                vmovaps         sign, [constants + SIGN]
                vsubps          m12, x, x                   ; +0, or NaN where x is not finite
                vsubps          m13, y, y
                vsubps          m14, z, z
                vaddps          m12, m12, m13
                vsubps          m13, w, w
                vaddps          m12, m12, m14
                vaddps          m13, m12, m13
                vxorps          m7, m7, m7
                vcmpnleps       outer, m13, m7
                vpsrld          code, outer, 31             ; CLIP_INVALID
    fill .guard_top, vbroadcastss    bound, [at_job]
                vmulps          bound, bound, w
                outside         y, bound                    ; CLIP_GUARD_TOP
    fill .guard_bottom, vbroadcastss bound, [at_job]
                vmulps          bound, bound, w
                outside         bound, y                    ; CLIP_GUARD_BOTTOM
    fill .guard_right, vbroadcastss  bound, [at_job]
                vmulps          bound, bound, w
                outside         x, bound                    ; CLIP_GUARD_RIGHT
    fill .guard_left, vbroadcastss   bound, [at_job]
                vmulps          bound, bound, w
                outside         bound, x                    ; CLIP_GUARD_LEFT
                vmovaps         bound, [constants + EYE_W_F]
                outside         bound, w                    ; CLIP_EYE
                outside         z, w                        ; CLIP_FAR
                outside         m7, z                       ; CLIP_NEAR
                vmovaps         bound, w
                outside_pair    y                           ; CLIP_TOP, CLIP_BOTTOM
                vmovaps         bound, w
                outside_pair    x                           ; CLIP_RIGHT, CLIP_LEFT
    fill .code,      vmovdqa         [at_output], code
end_fragment

; A user clip plane, after `clip_code`. Arguments: the plane in the job, the number of its bit, the slot of
; the code.
fragment clip_plane, JOB | OUTPUT | M_TO(8, 11), NOTHING, M(12) | M(13)
    fill .plane,     vbroadcastss    m12, [at_job + 12]
    fill .plane,     vbroadcastss    m13, [at_job + 8]
                vmulps          m12, m12, w
                vfmadd231ps     m12, z, m13
    fill .plane,     vbroadcastss    m13, [at_job + 4]
                vfmadd231ps     m12, y, m13
    fill .plane,     vbroadcastss    m13, [at_job]
                vfmadd231ps     m12, x, m13
                vxorps          m13, m13, m13
                vcmpnleps       m13, m13, m12
                vpsrld          m13, m13, 31
    fill_byte .bit,  vpslld         m13, m13, 0
    fill .code,      vpor            m13, m13, [at_output]
    fill .code,      vmovdqa         [at_output], m13
end_fragment
