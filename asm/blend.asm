; Blending (src/spec/blend.h) of the colour (m4, m5) with the stored one.
;
; m6 is the stored word, which writing needs too; blending unpacks it to m8, m9 and keeps the colour's alpha in both
; halves in m10, 255 - alpha in m11.

%include "fragment.inc"
%include "fixed.inc"

fragment stored_color, COLOR, M(6), NOTHING
                vmovdqa         m6, [color]
end_fragment

; Colour's alpha, the upper half of ga:  A | G  ->  A | A
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
