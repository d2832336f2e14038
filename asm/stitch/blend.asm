; Blending (src/spec/pixel/blend.h) of the colour (m4, m5) with the stored one.
;
; m6 is the stored word. Blending unpacks it to m8 and m9, and the write to the target needs it too. The
; three most frequent blendings have one fragment each, with the colour's alpha in both halves of m10 and
; 255 - alpha in m11. All other blendings are joined from parts: the source's factor in (m10, m11), the
; target's factor in (m12, m13), products, and an operation. Position and w are no longer needed: m0, m1,
; m3 and m7 hold the operands of a separate blending of alpha.

%include "fragment.inc"
%include "fixed.inc"

fragment stored_color, COLOR, M(6), NOTHING
                vmovdqa         m6, [color]
end_fragment

; The colour's alpha, the upper half of ga: A | G -> A | A
%macro alpha 1 ; result
                vpshuflw        %1, m5, 0xf5
                vpshufhw        %1, %1, 0xf5
%endmacro

; Stored word A B G R:  m8 = 0 B | 0 R,  m9 = 0 A | 0 G
%macro unpack_stored 0
                vpand           m8, m6, m14
                vpsrlw          m9, m6, 8
%endmacro

fragment blend_over, M_TO(4, 6) | M(14) | M(15), M(4) | M(5), M_TO(8, 11)
                alpha           m10
                unpack_stored
                vpsubw          m11, m14, m10
                vpmullw         m4, m4, m10
                vpmullw         m5, m5, m10
                vpmullw         m8, m8, m11
                vpmullw         m9, m9, m11
                vpaddw          m4, m4, m8
                vpaddw          m5, m5, m9
                divide_255      m4, m8
                divide_255      m5, m9
end_fragment

fragment blend_premultiplied, M_TO(4, 6) | M(14) | M(15), M(4) | M(5), M_TO(8, 12)
                alpha           m10
                unpack_stored
                vpsubw          m11, m14, m10
                modulate        m8, m11, m12
                modulate        m9, m11, m10
                add_saturated   m4, m8
                add_saturated   m5, m9
end_fragment

fragment blend_source, M(4) | M(5) | M(14) | M(15), M(4) | M(5), M_TO(8, 10)
                alpha           m10
                modulate        m4, m10, m8
                modulate        m5, m10, m9
end_fragment

; ---- blending by parts

fragment blend_stored, M(6) | M(14), M(8) | M(9), NOTHING
                unpack_stored
end_fragment

%macro factor_color 4 ; rb and ga of the result, rb and ga of the colour
                vmovdqa         %1, %3
                vmovdqa         %2, %4
%endmacro

%macro factor_alpha 4
                vpshuflw        %1, %4, 0xf5
                vpshufhw        %1, %1, 0xf5
                vmovdqa         %2, %1
%endmacro

; 255 - x is x with all bits of the byte inverted.
%macro invert 2
                vpxor           %1, %1, m14
                vpxor           %2, %2, m14
%endmacro

; One side's factor in all its forms. The colours are (m4, m5) and (m8, m9).
%macro factor_fragments 4 ; side, number of the first of the result's registers, rb, ga
  fragment %1_source_color, M(4) | M(5), M(%2) | M(%2 + 1), NOTHING
                factor_color    %3, %4, m4, m5
  end_fragment
  fragment %1_inverse_source_color, M(4) | M(5) | M(14), M(%2) | M(%2 + 1), NOTHING
                factor_color    %3, %4, m4, m5
                invert          %3, %4
  end_fragment
  fragment %1_source_alpha, M(5), M(%2) | M(%2 + 1), NOTHING
                factor_alpha    %3, %4, m4, m5
  end_fragment
  fragment %1_inverse_source_alpha, M(5) | M(14), M(%2) | M(%2 + 1), NOTHING
                factor_alpha    %3, %4, m4, m5
                invert          %3, %4
  end_fragment
  fragment %1_target_alpha, M(9), M(%2) | M(%2 + 1), NOTHING
                factor_alpha    %3, %4, m8, m9
  end_fragment
  fragment %1_inverse_target_alpha, M(9) | M(14), M(%2) | M(%2 + 1), NOTHING
                factor_alpha    %3, %4, m8, m9
                invert          %3, %4
  end_fragment
  fragment %1_target_color, M(8) | M(9), M(%2) | M(%2 + 1), NOTHING
                factor_color    %3, %4, m8, m9
  end_fragment
  fragment %1_inverse_target_color, M(8) | M(9) | M(14), M(%2) | M(%2 + 1), NOTHING
                factor_color    %3, %4, m8, m9
                invert          %3, %4
  end_fragment
  fragment %1_constant, JOB | M(14), M(%2) | M(%2 + 1), NOTHING
    fill .constant, vpbroadcastd    %4, [at_job]
                vpand           %3, %4, m14
                vpsrlw          %4, %4, 8
  end_fragment
  fragment %1_inverse_constant, JOB | M(14), M(%2) | M(%2 + 1), NOTHING
    fill .constant, vpbroadcastd    %4, [at_job]
                vpand           %3, %4, m14
                vpsrlw          %4, %4, 8
                invert          %3, %4
  end_fragment
  fragment %1_saturated_alpha, M(5) | M(9) | M(14), M(%2) | M(%2 + 1), NOTHING
                factor_alpha    %3, %4, m8, m9
                vpxor           %3, %3, m14
                vpshuflw        %4, m5, 0xf5
                vpshufhw        %4, %4, 0xf5
                vpminuw         %3, %3, %4
                vpblendw        %4, %3, m14, 0xaa
  end_fragment
%endmacro

factor_fragments source, 10, m10, m11
factor_fragments target, 12, m12, m13

fragment source_zero, NOTHING, M(4) | M(5), NOTHING
                vpxor           m4, m4, m4
                vpxor           m5, m5, m5
end_fragment

fragment target_zero, NOTHING, M(8) | M(9), NOTHING
                vpxor           m8, m8, m8
                vpxor           m9, m9, m9
end_fragment

fragment source_product, M(4) | M(5) | M(10) | M(11) | M(15), M(4) | M(5), M(10) | M(11)
                modulate        m4, m10, m10
                modulate        m5, m11, m11
end_fragment

fragment target_product, M(8) | M(9) | M(12) | M(13) | M(15), M(8) | M(9), M(12) | M(13)
                modulate        m8, m12, m12
                modulate        m9, m13, m13
end_fragment

fragment blend_add, M(4) | M(5) | M(8) | M(9) | M(14), M(4) | M(5), NOTHING
                add_saturated   m4, m8
                add_saturated   m5, m9
end_fragment

; Complementary factors: both products are rounded together.
fragment blend_lerp, M(4) | M(5) | M_TO(8, 13) | M(15), M(4) | M(5), M_TO(8, 13)
                vpmullw         m4, m4, m10
                vpmullw         m5, m5, m11
                vpmullw         m8, m8, m12
                vpmullw         m9, m9, m13
                vpaddw          m4, m4, m8
                vpaddw          m5, m5, m9
                divide_255      m4, m8
                divide_255      m5, m9
end_fragment

fragment blend_subtract, M(4) | M(5) | M(8) | M(9), M(4) | M(5), NOTHING
                vpsubusw        m4, m4, m8
                vpsubusw        m5, m5, m9
end_fragment

fragment blend_reverse_subtract, M(4) | M(5) | M(8) | M(9), M(4) | M(5), NOTHING
                vpsubusw        m4, m8, m4
                vpsubusw        m5, m9, m5
end_fragment

fragment blend_minimum, M(4) | M(5) | M(8) | M(9), M(4) | M(5), NOTHING
                vpminuw         m4, m4, m8
                vpminuw         m5, m5, m9
end_fragment

fragment blend_maximum, M(4) | M(5) | M(8) | M(9), M(4) | M(5), NOTHING
                vpmaxuw         m4, m4, m8
                vpmaxuw         m5, m5, m9
end_fragment

; ---- separate alpha: ga of both colours is kept, blended again with the factors of alpha, and joined with
; the blended green

fragment alpha_keep, M(5) | M(6), M(0) | M(1), NOTHING
                vmovdqa         m0, m5
                vpsrlw          m1, m6, 8
end_fragment

fragment alpha_again, M(0) | M(1) | M(4) | M(5), M(3) | M(5) | M(7) | M(8) | M(9), NOTHING
                vmovdqa         m3, m4
                vmovdqa         m7, m5
                vmovdqa         m5, m0
                vmovdqa         m8, m1
                vmovdqa         m9, m1
end_fragment

fragment alpha_merge, M(3) | M(5) | M(7), M(4) | M(5), NOTHING
                vmovdqa         m4, m3
                vpblendw        m5, m7, m5, 0xaa
end_fragment
