; Texture stage 0 (src/spec/stage.h): combines colour (m4, m5) and texture (m6, m7) into the colour.

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
