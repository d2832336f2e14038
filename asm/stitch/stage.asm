; Texture stages (src/spec/pixel/stage.h): combine the colour (m4, m5), the texture (m6, m7) and the
; factor.
;
; The most frequent combinations have fragments of their own. All others load their arguments into pairs of
; registers:
;
;            first       second      third
;   rb ga    m8 m9       m10 m11     m12 m13         scratch m0
;
; Each argument is loaded from a source, then optionally replicated and complemented. The operation
; combines them into the first. If alpha has another operation, the result of colour is kept in m1 and m3.
; Positions and w are no longer needed.

%include "fragment.inc"
%include "fixed.inc"

fragment stage_replace, M(6) | M(7), M(4) | M(5), NOTHING
                vmovdqa         m4, m6
                vmovdqa         m5, m7
end_fragment

fragment stage_modulate, M_TO(4, 7) | M(14) | M(15), M(4) | M(5), M(8) | M(9)
                modulate        m4, m6, m8
                modulate        m5, m7, m9
end_fragment

fragment stage_add, M_TO(4, 7) | M(14), M(4) | M(5), NOTHING
                add_saturated   m4, m6
                add_saturated   m5, m7
end_fragment

; ---- arguments

%macro argument 3 ; which, numbers of its registers
fragment %1_diffuse, M(4) | M(5), M(%2) | M(%3), NOTHING
                vmovdqa         m%2, m4
                vmovdqa         m%3, m5
end_fragment

fragment %1_texture, M(6) | M(7), M(%2) | M(%3), NOTHING
                vmovdqa         m%2, m6
                vmovdqa         m%3, m7
end_fragment

; Argument: texture_factor of the job.
fragment %1_factor, JOB | M(14), M(%2) | M(%3), NOTHING
    fill .texture_factor, vpbroadcastd    m%3, [at_job]
                vpand           m%2, m%3, m14
                vpsrlw          m%3, m%3, 8
end_fragment

fragment %1_replicate, M(%3), M(%2) | M(%3), NOTHING
                vpshuflw        m%3, m%3, 0xf5
                vpshufhw        m%3, m%3, 0xf5
                vmovdqa         m%2, m%3
end_fragment

fragment %1_complement, M(%2) | M(%3) | M(14), M(%2) | M(%3), NOTHING
                vpsubw          m%2, m14, m%2
                vpsubw          m%3, m14, m%3
end_fragment
%endmacro

argument first, 8, 9
argument second, 10, 11
argument third, 12, 13

; ---- operations

%macro combine_modulate 2 ; first and result, second
                modulate        %1, %2, m0
%endmacro

%macro combine_modulate_2x 2
                modulate        %1, %2, m0
                add_saturated   %1, %1
%endmacro

%macro combine_modulate_4x 2
                combine_modulate_2x %1, %2
                add_saturated   %1, %1
%endmacro

%macro combine_add 2
                add_saturated   %1, %2
%endmacro

%macro combine_add_signed 2
                vpaddw          %1, %1, %2
                vpsubusw        %1, %1, m15
                vpminuw         %1, %1, m14
%endmacro

%macro combine_add_signed_2x 2
                vpaddw          %1, %1, %2
                vpsubusw        %1, %1, m15
                add_saturated   %1, %1
%endmacro

%macro combine_subtract 2
                vpsubusw        %1, %1, %2
%endmacro

%macro combine_two 1 ; operation
fragment stage_two_%1, M_TO(8, 11) | M(14) | M(15), M(8) | M(9), M(0)
                combine_%1      m8, m10
                combine_%1      m9, m11
end_fragment
%endmacro

combine_two modulate
combine_two modulate_2x
combine_two modulate_4x
combine_two add
combine_two add_signed
combine_two add_signed_2x
combine_two subtract

fragment stage_multiply_add, M_TO(8, 15), M(8) | M(9), M(0)
                modulate        m8, m10, m0
                modulate        m9, m11, m0
                add_saturated   m8, m12
                add_saturated   m9, m13
end_fragment

%macro interpolate 3 ; first and result, second, weight
                vpsubw          m0, m14, %3
                vpmullw         %1, %1, %3
                vpmullw         %2, %2, m0
                vpaddw          %1, %1, %2
                divide_255      %1, m0
%endmacro

fragment stage_lerp, M_TO(8, 15), M(8) | M(9), M(0) | M(10) | M(11)
                interpolate     m8, m10, m12
                interpolate     m9, m11, m13
end_fragment

; Signed halves: red and blue, then green with a zero in alpha's place.
fragment stage_dot, M_TO(8, 11) | M(14) | M(15), M(8) | M(9), M(0) | M(10) | M(11)
                vpsubw          m8, m8, m15
                vpsubw          m9, m9, m15
                vpsubw          m10, m10, m15
                vpsubw          m11, m11, m15
                vpxor           m0, m0, m0
                vpblendw        m9, m9, m0, 0xaa
                vpmaddwd        m8, m8, m10
                vpmaddwd        m9, m9, m11
                vpaddd          m8, m8, m9
                vpsrad          m8, m8, 6
                vpmaxsd         m8, m8, m0
                vpsrld          m9, m14, 16
                vpminsd         m8, m8, m9
                vpslld          m9, m8, 16
                vpor            m8, m8, m9
                vmovdqa         m9, m8
end_fragment

; ---- results

fragment stage_result, M(8) | M(9), M(4) | M(5), NOTHING
                vmovdqa         m4, m8
                vmovdqa         m5, m9
end_fragment

fragment stage_keep_color, M(8) | M(9), M(1) | M(3), NOTHING
                vmovdqa         m1, m8
                vmovdqa         m3, m9
end_fragment

; Alpha is the odd half of ga.
fragment stage_join_alpha, M(1) | M(3) | M(9), M(4) | M(5), NOTHING
                vmovdqa         m4, m1
                vpblendw        m5, m3, m9, 0xaa
end_fragment
