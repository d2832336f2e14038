; Vertex fetch (src/spec/fetch.h): an attribute of eight vertices from the application's buffer into registers.
;
; Registers of the vertex unit's stages, from here to clip.asm:
;   m0 - m3     position, later the normal in camera space (m0 - m2)
;   m4 - m6     position in camera space
;   m8 - m11    normal, clip-space position or texture coordinates; scratch of the lights
;   m12 - m15   diffuse colour
; m3 and m7 are scratch elsewhere.
;
; Each attribute has six fragments, one a format, that are the same text on other registers. Arguments: stride and
; data of the job's attribute.

%include "fragment.inc"
%include "constant.inc"

%define STRIDE_FIELD    0
%define DATA            1

; m7: byte offsets of the vertices, rax: where they count from
%macro vertex_offsets 0
    fill STRIDE_FIELD, vpbroadcastd m7, [at_job]
    fill DATA,  mov             rax, [at_job]
                vpmulld         m7, m7, [input]
%endmacro

; Components beyond the format's are 0, the fourth 1.
%macro fetch_floats 4 ; attribute, first register, components wanted, components there
  %assign last %2 + %3 - 1
fragment %1_float%4, JOB | INPUT | CONSTANTS, M_TO(%2, last), R_AX | M(7) | M(11)
                vertex_offsets
  %assign component 0
  %rep %3
    %assign number %2 + component
    %if component < %4
                vpcmpeqd        m11, m11, m11
                vgatherdps      m%[number], [rax + m7 + 4 * component], m11
    %elif component == 3
                vmovaps         m%[number], [constants + ONE_F]
    %else
                vxorps          m%[number], m%[number], m%[number]
    %endif
    %assign component component + 1
  %endrep
end_fragment
%endmacro

; A R G B in a word, blue lowest, to as many of R G B A as wanted.
%macro fetch_channel 2 ; result, lowest bit
  %if %2 == 0
                vpand           %1, m7, [constants + BYTE_I]
  %elif %2 == 24
                vpsrld          %1, m7, 24
  %else
                vpsrld          %1, m7, %2
                vpand           %1, %1, [constants + BYTE_I]
  %endif
                vcvtdq2ps       %1, %1
                vmulps          %1, %1, [constants + UNBYTE_F]
%endmacro

%macro fetch_packed 3 ; attribute, first register, components wanted
  %assign last %2 + %3 - 1
fragment %1_color, JOB | INPUT | CONSTANTS, M_TO(%2, last), R_AX | M(7) | M(11)
                vertex_offsets
                vpcmpeqd        m11, m11, m11
                vpgatherdd      m%2, [rax + m7], m11
                vmovdqa         m7, m%2
  %assign component 0
  %rep %3
    %assign number %2 + component
    %if component == 3
                fetch_channel   m%[number], 24
    %else
                fetch_channel   m%[number], 16 - 8 * component
    %endif
    %assign component component + 1
  %endrep
end_fragment
%endmacro

%macro fetch_none 4 ; attribute, first register, components wanted, value
  %assign last %2 + %3 - 1
fragment %1_none, CONSTANTS, M_TO(%2, last), NOTHING
  %assign number %2
  %rep %3
    %if %4 == 0
                vxorps          m%[number], m%[number], m%[number]
    %else
                vmovaps         m%[number], [constants + ONE_F]
    %endif
    %assign number number + 1
  %endrep
end_fragment
%endmacro

%macro fetch 4 ; attribute, first register, components wanted, value when there is none
                fetch_none      %1, %2, %3, %4
                fetch_floats    %1, %2, %3, 1
                fetch_floats    %1, %2, %3, 2
                fetch_floats    %1, %2, %3, 3
                fetch_floats    %1, %2, %3, 4
                fetch_packed    %1, %2, %3
%endmacro

; A position's fourth component is 1 unless it has four; then position_float4 gives it.
fetch position, 0, 4, 0
fetch normal, 8, 3, 0
fetch diffuse, 12, 4, 1
fetch texcoord, 8, 2, 0

; Arguments: slots of u and v.
fragment store_texcoord, OUTPUT | M(8) | M(9), NOTHING, NOTHING
    fill 0,     vmovaps         [at_output], m8
    fill 1,     vmovaps         [at_output], m9
end_fragment
