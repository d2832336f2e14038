; Colour write (src/spec/pixel/write.h): packs the colour (m4, m5) and merges it with the stored word (m6).
; A selection by bytes is a selection by the combined mask of lanes and channels.

%include "fragment.inc"

%define live            m2

;   0 B | 0 R   and   0 A | 0 G   ->   A B G R
%macro pack_word 0
                vpsllw          m5, m5, 8
                vpor            m4, m4, m5
%endmacro

fragment write_all, COLOR | M(2) | M_TO(4, 6), NOTHING, M(4) | M(5)
                pack_word
                vpblendvb       m4, m6, m4, live
                vmovdqa         [color], m4
end_fragment

; Argument: the word of the write mask, 255 in each channel that is written.
fragment write_masked, COLOR | M(2) | M_TO(4, 6), NOTHING, R_AX | M(4) | M(5) | M(8)
    fill .value,     mov             eax, strict dword 0
                vmovd           xm8, eax
                vpbroadcastd    m8, xm8
                vpand           m8, m8, live
                pack_word
                vpblendvb       m4, m6, m4, m8
                vmovdqa         [color], m4
end_fragment
