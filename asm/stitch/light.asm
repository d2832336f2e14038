; Lighting (src/spec/vertex/light.h): each light adds its diffuse and ambient terms to the colour.
;
;   m0 - m2     normal               m12 - m15   colour, alpha in m15
;   m4 - m6     position             m3, m7 - m11  scratch
; all in camera space.

%include "fragment.inc"
%include "constant.inc"

; Argument: the job's base colour.
fragment base_color, JOB, M_TO(12, 15), NOTHING
    fill .base_color, vbroadcastss    m12, [at_job]
    fill .base_color, vbroadcastss    m13, [at_job + 4]
    fill .base_color, vbroadcastss    m14, [at_job + 8]
    fill .base_color, vbroadcastss    m15, [at_job + 12]
end_fragment

; m9 = the cosine: normal . (m7, m8, m9), at least 0
%macro facing 0
                vmulps          m9, m9, m2
                vxorps          m3, m3, m3
                vfmadd231ps     m9, m8, m1
                vfmadd231ps     m9, m7, m0
                vmaxps          m9, m9, m3
%endmacro

; Arguments: position (the direction) and diffuse of the light.
fragment light_directional, JOB | M_TO(0, 2) | M_TO(12, 14), M_TO(12, 14), M(3) | M_TO(7, 11)
    fill .direction, vbroadcastss    m7, [at_job]
    fill .direction, vbroadcastss    m8, [at_job + 4]
    fill .direction, vbroadcastss    m9, [at_job + 8]
                facing
    fill .diffuse,   vbroadcastss    m7, [at_job]
    fill .diffuse,   vbroadcastss    m8, [at_job + 4]
    fill .diffuse,   vbroadcastss    m10, [at_job + 8]
                vfmadd231ps     m12, m9, m7
                vfmadd231ps     m13, m9, m8
                vfmadd231ps     m14, m9, m10
end_fragment

; Attenuation (m11) of the distance (m10): 1 / (a0 + d * (a1 + d * a2)), 0 beyond the range.
%macro attenuation 0
    fill .attenuation2, vbroadcastss    m11, [at_job]
    fill .attenuation1, vbroadcastss    m3, [at_job]
                vfmadd213ps     m11, m10, m3
    fill .attenuation0, vbroadcastss    m3, [at_job]
                vfmadd213ps     m11, m10, m3
                vmovaps         m3, [constants + ONE_F]
                vdivps          m11, m3, m11
    fill .range, vbroadcastss    m3, [at_job]
                vcmpleps        m10, m10, m3
                vandps          m11, m11, m10
%endmacro

; One channel: colour += attenuation * (facing * diffuse + ambient)
%macro add_light 2 ; colour, offset
    fill .diffuse, vbroadcastss    m7, [at_job + %2]
    fill .ambient, vbroadcastss    m8, [at_job + %2]
                vfmadd213ps     m7, m9, m8
                vfmadd231ps     %1, m11, m7
%endmacro

; Arguments: position, diffuse, ambient, attenuation0, attenuation1, attenuation2 and range of the light.
fragment light_point, JOB | CONSTANTS | M_TO(0, 2) | M_TO(4, 6) | M_TO(12, 14), \
                      M_TO(12, 14), M(3) | M_TO(7, 11)
    fill .position,  vbroadcastss    m7, [at_job]
    fill .position,  vbroadcastss    m8, [at_job + 4]
    fill .position,  vbroadcastss    m9, [at_job + 8]
                vsubps          m7, m7, m4
                vsubps          m8, m8, m5
                vsubps          m9, m9, m6
                vmulps          m10, m9, m9
                vfmadd231ps     m10, m8, m8
                vfmadd231ps     m10, m7, m7                 ; distance squared
                vmovaps         m3, [constants + ONE_F]
                vsqrtps         m11, m10
                vdivps          m11, m3, m11
                vminps          m11, m11, [constants + MAXIMUM_F]
                vmulps          m10, m10, m11               ; distance
                vmulps          m7, m7, m11
                vmulps          m8, m8, m11
                vmulps          m9, m9, m11
                attenuation
                facing
                add_light       m12, 0
                add_light       m13, 4
                add_light       m14, 8
end_fragment

%macro store_channel 2 ; argument, channel
                vmaxps          %2, %2, m3
                vminps          %2, %2, m7
    fill %1,    vmovaps         [at_output], %2
%endmacro

; Clamped to 0..1. Arguments: slots of red, green, blue and alpha.
fragment store_diffuse, OUTPUT | CONSTANTS | M_TO(12, 15), NOTHING, M(3) | M(7) | M_TO(12, 15)
                vxorps          m3, m3, m3
                vmovaps         m7, [constants + ONE_F]
                store_channel   .red, m12
                store_channel   .green, m13
                store_channel   .blue, m14
                store_channel   .alpha, m15
end_fragment
