; Texture sampling: addressing of each axis, then point or bilinear (src/spec/texture/sample.h).
;
; Addressing converts a coordinate to indices of texels, in the coordinate's register where possible:
;
;            in      first   second   weight, in both halves
;   across   m8      m8      m6       m10
;   down     m9      m9      m7       m11           scratch m12, m13
;
; m6 and m7 are free here: they receive the texture's colour only with the sample. The fragments of the two
; axes, of all addressing modes and of both filters are the same text. Arguments: size_256, last and size
; of the job's axis.
;
; With a border, indices are not changed: the samples for borders test which taps are inside the image.

%include "fragment.inc"
%include "constant.inc"

%macro clamp_index 1 ; index
                vpxor           m13, m13, m13
                vpmaxsd         %1, %1, m13
    fill .last,  vpbroadcastd    m13, [at_job]
                vpminsd         %1, %1, m13
%endmacro

%macro power_index 1 ; index
    fill .last,  vpbroadcastd    m13, [at_job]
                vpand           %1, %1, m13
%endmacro

; Adds `size` under a mask, then subtracts it under a mask: the two selects of the specification.
%macro wrap_index 1 ; index
    fill .size,  vpbroadcastd    m13, [at_job]
                vpsrad          m12, %1, 31
                vpand           m12, m12, m13
                vpaddd          %1, %1, m12
    fill .last,  vpbroadcastd    m12, [at_job]
                vpcmpgtd        m12, %1, m12
                vpand           m12, m12, m13
                vpsubd          %1, %1, m12
                clamp_index     %1
%endmacro

; The larger of the index and its complement: the one that is not negative.
%macro fold_index 1 ; index
                vpcmpeqd        m13, m13, m13
                vpxor           m13, %1, m13
                vpmaxsd         %1, %1, m13
%endmacro

%macro mirror_once_index 1 ; index
                fold_index      %1
    fill .last,  vpbroadcastd    m13, [at_job]
                vpminsd         %1, %1, m13
%endmacro

%macro mirror_index 1 ; index
                fold_index      %1
    fill .size,  vpbroadcastd    m12, [at_job]
    fill .last,  vpbroadcastd    m13, [at_job]
                vpaddd          m12, m12, m13
                vpsubd          m12, m12, %1
                vpminsd         %1, %1, m12
                vpxor           m13, m13, m13
                vpmaxsd         %1, %1, m13
%endmacro

%macro mirror_power_index 1 ; index
    fill .size,  vpbroadcastd    m13, [at_job]
                vpand           m12, %1, m13
                vpcmpeqd        m12, m12, m13
                vpxor           %1, %1, m12
    fill .last,  vpbroadcastd    m13, [at_job]
                vpand           %1, %1, m13
%endmacro

%macro border_index 1 ; index
%endmacro

; Removes whole periods of the coordinate, unless the size is a power of two.
%macro axis_position 2 ; register, addressing
  %ifidn %2, wrap
                vroundps        m12, %1, 1
                vsubps          %1, %1, m12
  %elifidn %2, mirror
                vmulps          m12, %1, [constants + HALF_F]
                vroundps        m12, m12, 1
                vaddps          m12, m12, m12
                vsubps          %1, %1, m12
  %endif
    fill .size_256, vbroadcastss m12, [at_job]
                vmulps          %1, %1, m12
                vcvtps2dq       %1, %1
%endmacro

; The weight of a position, scratch m12.
%macro both_halves 2 ; weight, position
                vpand           %1, %2, [constants + BYTE_I]
                vpslld          m12, %1, 16
                vpor            %1, %1, m12
%endmacro

%macro axis_point 3 ; across or down, register's number, addressing
fragment %1_%3_point, JOB | CONSTANTS | M(%2), M(%2), M(12) | M(13)
                axis_position   m%2, %3
                vpsrad          m%2, m%2, 8
                %3_index        m%2
end_fragment
%endmacro

%macro axis_linear 5 ; across or down, numbers of first, second and weight, addressing
fragment %1_%5_linear, JOB | CONSTANTS | M(%2), M(%2) | M(%3) | M(%4), M(12) | M(13)
                axis_position   m%2, %5
                vpsubd          m%2, m%2, [constants + HALF_I]
                both_halves     m%4, m%2
                vpsrad          m%2, m%2, 8
                vpaddd          m%3, m%2, [constants + ONE_I]
                %5_index        m%2
                %5_index        m%3
end_fragment
%endmacro

%macro axes 1 ; addressing
                axis_point      across, 8, %1
                axis_point      down, 9, %1
                axis_linear     across, 8, 6, 10, %1
                axis_linear     down, 9, 7, 11, %1
%endmacro

; Only across: the second column is the one after the first (address_pairs in src/spec/texture/address.h).
; Arguments: size_256; last, or last_256 when clamped.
fragment across_power_pair, JOB | CONSTANTS | M(8), M(8) | M(10), M(12) | M(13)
                axis_position   m8, power
                vpsubd          m8, m8, [constants + HALF_I]
                both_halves     m10, m8
                vpsrad          m8, m8, 8
                power_index     m8
end_fragment

fragment across_clamp_pair, JOB | CONSTANTS | M(8), M(8) | M(10), M(12) | M(13)
                axis_position   m8, clamp
                vpsubd          m8, m8, [constants + HALF_I]
                clamp_index     m8
                both_halves     m10, m8
                vpsrad          m8, m8, 8
end_fragment

axes wrap
axes power
axes clamp
axes mirror
axes mirror_power
axes mirror_once
axes border

; Arguments: texels and pitch of the job. The factors of the row's offset are below 2^15, so vpmaddwd is
; exact, and it is faster than vpmulld.
fragment sample_point, JOB | M(8) | M(9) | M(14), M(6) | M(7), R_AX | M(8) | M(9) | M(10)
    fill .pitch,     vpbroadcastd    m10, [at_job]
    fill .texels,    mov             rax, [at_job]
                vpmaddwd        m9, m9, m10
                vpaddd          m8, m8, m9
                vpcmpeqd        m10, m10, m10
                vpgatherdd      m7, [rax + m8 * 4], m10
                vpand           m6, m7, m14
                vpsrlw          m7, m7, 8
end_fragment

; round((a * (256 - f) + b * f) / 256) in halves, computed as a * 256 + (b - a) * f + 128 modulo 2^16: the
; same sum with one product.
%macro lerp 4 ; a and result, a * 256, b and scratch, f
                vpsubw          %3, %3, %1
                vpmullw         %3, %3, %4
                vpaddw          %3, %3, %2
                vpaddw          %3, %3, m15
                vpsrlw          %1, %3, 8
%endmacro

; Blends two texels across, each A B G R in a lane, to the pairs rb = 0 B | 0 R and ga = 0 A | 0 G. Green
; and alpha are in the upper byte of their half of the word, so they are already multiplied by 256.
%macro blend_texels 7 ; left and rb, right, ga, weight, scratch, scratch, scratch
                vpand           %5, %1, m14                 ; left rb
                vpand           %6, %2, m14                 ; right rb
                vpsrlw          %3, %1, 8                   ; left ga
                vpsrlw          %2, %2, 8                   ; right ga
                vpandn          %7, m14, %1                 ; left ga * 256
                lerp            %3, %7, %2, %4
                vpsllw          %7, %5, 8
                lerp            %5, %7, %6, %4
                vmovdqa         %1, %5
%endmacro

; Blends four texels, upper m6 m13, lower m12 m9, with the weights m10 across and m11 down, into m6, m7.
%macro blend_four 0
                blend_texels    m6, m13, m7, m10, m0, m1, m8
                blend_texels    m12, m9, m13, m10, m0, m1, m8
                vpsllw          m0, m6, 8
                vpsllw          m1, m7, 8
                lerp            m6, m0, m12, m11
                lerp            m7, m1, m13, m11
%endmacro

; Arguments: texels and pitch of the job.
;
;   m8 m6    columns        m10  weight across
;   m9 m7    rows           m11  weight down
fragment sample_bilinear, JOB | M_TO(6, 11) | M(14) | M(15), M(6) | M(7), \
                R_AX | M(0) | M(1) | M_TO(8, 13)
    fill .pitch,     vpbroadcastd    m12, [at_job]
    fill .texels,    mov             rax, [at_job]
                vpmaddwd        m9, m9, m12                 ; upper row
                vpmaddwd        m7, m7, m12                 ; lower row
                vpaddd          m12, m9, m8
                vpaddd          m9, m9, m6
                vpaddd          m8, m7, m8
                vpaddd          m7, m7, m6
                vpcmpeqd        m0, m0, m0
                vpcmpeqd        m1, m1, m1
                vpgatherdd      m6, [rax + m12 * 4], m0     ; upper left
                vpgatherdd      m13, [rax + m9 * 4], m1     ; upper right
                vpcmpeqd        m0, m0, m0
                vpcmpeqd        m1, m1, m1
                vpgatherdd      m12, [rax + m8 * 4], m0     ; lower left
                vpgatherdd      m9, [rax + m7 * 4], m1      ; lower right
                blend_four
end_fragment

; Loads the texels at the indices of a register and the next texel of each: eight loads of 64 bits in two
; gathers. The middle pairs of indices are exchanged, so that the gathered pairs can be separated within
; 128-bit halves.
%macro gather_pairs 6 ; indices, left, right, scratch, scratch, scratch's number
                vpermq          %1, %1, 0xd8
                vextracti128    xmm%6, %1, 1
                vpcmpeqd        m0, m0, m0
                vpcmpeqd        m1, m1, m1
                vpgatherdq      %4, [rax + %5 * 4], m0
                vpgatherdq      %3, [rax + xmm%6 * 4], m1
                vshufps         %2, %4, %3, 0x88
                vshufps         %3, %4, %3, 0xdd
%endmacro

; Arguments: texels and pitch of the job.
;
;   m8       first columns  m10  weight across
;   m9 m7    rows           m11  weight down
fragment sample_bilinear_pair, JOB | M_TO(7, 11) | M(14) | M(15), M(6) | M(7), \
                R_AX | M(0) | M(1) | M_TO(8, 13)
    fill .pitch,     vpbroadcastd    m12, [at_job]
    fill .texels,    mov             rax, [at_job]
                vpmaddwd        m9, m9, m12                 ; upper row
                vpmaddwd        m7, m7, m12                 ; lower row
                vpaddd          m9, m9, m8
                vpaddd          m8, m7, m8
                gather_pairs    m9, m6, m13, m7, xmm9, 12
                gather_pairs    m8, m12, m9, m7, xmm8, 12
                blend_four
end_fragment

; ---- with a border
;
; Taps inside the image are gathered over the border colour under a mask. Other taps are not read. Indices
; on an axis without a border are always inside. Arguments: texels, pitch, last_u, last_v and border of the
; job.


%macro inside 3 ; mask, index, last: 0 <= index <= last
                vpminud         %1, %2, %3
                vpcmpeqd        %1, %1, %2
%endmacro

fragment sample_point_border, JOB | M(8) | M(9) | M(14), M(6) | M(7), R_AX | M_TO(8, 12)
    fill .last_u, vpbroadcastd   m10, [at_job]
                inside          m11, m8, m10
    fill .last_v, vpbroadcastd   m10, [at_job]
                inside          m12, m9, m10
                vpand           m11, m11, m12
    fill .pitch,     vpbroadcastd    m10, [at_job]
    fill .texels,    mov             rax, [at_job]
                vpmaddwd        m9, m9, m10
                vpaddd          m8, m8, m9
    fill .border, vpbroadcastd   m7, [at_job]
                vpgatherdd      m7, [rax + m8 * 4], m11
                vpand           m6, m7, m14
                vpsrlw          m7, m7, 8
end_fragment

%macro gather_tap 3 ; result, index, mask
    fill .border, vpbroadcastd   %1, [at_job]
                vpgatherdd      %1, [rax + %2 * 4], %3
%endmacro

; Registers as for sample_bilinear.
fragment sample_bilinear_border, JOB | M_TO(6, 11) | M(14) | M(15), M(6) | M(7), \
                R_AX | M(0) | M(1) | M(3) | M_TO(8, 13)
    fill .last_u, vpbroadcastd   m12, [at_job]
                inside          m0, m8, m12                 ; left
                inside          m1, m6, m12                 ; right
    fill .last_v, vpbroadcastd   m12, [at_job]
                inside          m3, m9, m12                 ; upper
                inside          m13, m7, m12                ; lower
    fill .pitch,     vpbroadcastd    m12, [at_job]
    fill .texels,    mov             rax, [at_job]
                vpmaddwd        m9, m9, m12
                vpmaddwd        m7, m7, m12
                vpaddd          m12, m9, m8
                vpaddd          m9, m9, m6
                vpaddd          m8, m7, m8
                vpaddd          m7, m7, m6
                vpand           m6, m1, m3
                vpand           m3, m0, m3
                vpand           m1, m1, m13
                vpand           m0, m0, m13
                gather_tap      m13, m9, m6                 ; upper right
                gather_tap      m6, m12, m3                 ; upper left
                gather_tap      m12, m8, m0                 ; lower left
                gather_tap      m9, m7, m1                  ; lower right
                blend_four
end_fragment

fragment texture_white, M(14), M(6) | M(7), NOTHING
                vmovdqa         m6, m14
                vmovdqa         m7, m14
end_fragment
