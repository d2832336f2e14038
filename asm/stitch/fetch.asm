; Vertex fetch (src/spec/vertex/fetch.h): loads an attribute of eight vertices from the application's
; buffer into registers.
;
; Two or more components are loaded vertex by vertex and transposed. On Zen 4, this takes a quarter to a
; third less time for a whole vertex routine than gathering each component. Single components and packed
; colours are gathered.
;
; Registers of the vertex unit's stages, from here to clip.asm:
;   m0 - m3     position, later the normal in camera space (m0 - m2)
;   m4 - m6     position in camera space
;   m8 - m11    normal, clip-space position or texture coordinates; scratch of the lights
;   m12 - m15   diffuse colour
; m3 and m7 are scratch elsewhere.
;
; Each attribute has six fragments, one for each format. They are the same text with other registers.
; Arguments: stride and data of the job's attribute.

%include "fragment.inc"
%include "constant.inc"

; m7: byte offsets of the vertices from rax
%macro vertex_offsets 0
    fill .stride, vpbroadcastd m7, [at_job]
    fill .data,  mov             rax, [at_job]
                vpmulld         m7, m7, [input]
%endmacro

; Loads one vertex without reading past its components: the buffer may end right after them.
%macro load_vertex 3 ; xmm, components, index
                mov             ecx, [input + 4 * %3]
                imul            ecx, edx
                movsxd          rcx, ecx
  %if %2 == 4
                vmovups         %1, [rax + rcx]
  %elif %2 == 3
                vmovsd          %1, [rax + rcx]
                vinsertps       %1, %1, [rax + rcx + 8], 0x20
  %elif %2 == 2
                vmovsd          %1, [rax + rcx]
  %endif
%endmacro

;   s0  x0 y0 z0 w0 | x4 y4 z4 w4         result 0   x0 x1 x2 x3 | x4 x5 x6 x7
;   s1  x1 y1 z1 w1 | x5 y5 z5 w5    ->          1   y0 y1 ...
;   s2  x2 ..       | x6 ..                      2   z0 ...
;   s3  x3 ..       | x7 ..                      3   w0 ...
%macro fetch_rows 5 ; attribute, first register, components needed, those present, first of four scratch
    fill .stride, mov      edx, [at_job]
    fill .data,  mov             rax, [at_job]
  %if %3 == 2
    %assign read 2
  %else
    %assign read %4
  %endif
  %assign row 0
  %rep 4
    %assign number %5 + row
    %assign later row + 4
                load_vertex     xm%[number], read, row
                load_vertex     xm7, read, later
                vinsertf128     m%[number], m%[number], xm7, 1
    %assign row row + 1
  %endrep
  %assign s0 %5
  %assign s1 %5 + 1
  %assign s2 %5 + 2
  %assign s3 %5 + 3
  %assign r0 %2
  %assign r1 %2 + 1
  %assign r2 %2 + 2
  %assign r3 %2 + 3
                vunpcklps       m7, m%[s0], m%[s1]          ; x0 x1 y0 y1
                vunpcklps       m11, m%[s2], m%[s3]         ; x2 x3 y2 y3
  %if %3 > 2 && %4 > 2
                vunpckhps       m%[s0], m%[s0], m%[s1]      ; z0 z1 w0 w1
                vunpckhps       m%[s2], m%[s2], m%[s3]
                vunpcklpd       m%[r2], m%[s0], m%[s2]
  %endif
  %if %3 > 3 && %4 > 3
                vunpckhpd       m%[r3], m%[s0], m%[s2]
  %endif
                vunpcklpd       m%[r0], m7, m11
                vunpckhpd       m%[r1], m7, m11
%endmacro

; Missing components are 0, the fourth is 1.
%macro fetch_floats 5 ; attribute, first register, components needed, those present, scratch
  %assign last %2 + %3 - 1
  %assign component %4
  %if %4 == 1
fragment %1_float1, JOB | INPUT | CONSTANTS, M_TO(%2, last), R_AX | M(7) | M(11)
                vertex_offsets
                vpcmpeqd        m11, m11, m11
                vgatherdps      m%2, [rax + m7], m11
  %else
fragment %1_float%4, JOB | INPUT | CONSTANTS, M_TO(%2, last), \
                    R_AX | R_CX | R_DX | M(7) | M(11) | M_TO(%5, %5 + 3)
                fetch_rows      %1, %2, %3, %4, %5
  %endif
  %rep %3
    %if component < %3
      %assign number %2 + component
      %if component == 3
                vmovaps         m%[number], [constants + ONE_F]
      %else
                vxorps          m%[number], m%[number], m%[number]
      %endif
    %endif
    %assign component component + 1
  %endrep
end_fragment
%endmacro

; Unpacks a word with the channels A R G B, blue lowest, to the components needed of R G B A.
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

%macro fetch_packed 3 ; attribute, first register, components needed
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

%macro fetch_none 4 ; attribute, first register, components needed, value
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

%macro fetch 5 ; attribute, first register, components needed, value when there is none, scratch
                fetch_none      %1, %2, %3, %4
                fetch_floats    %1, %2, %3, 1, %5
                fetch_floats    %1, %2, %3, 2, %5
                fetch_floats    %1, %2, %3, 3, %5
                fetch_floats    %1, %2, %3, 4, %5
                fetch_packed    %1, %2, %3
%endmacro

; A position without a fourth component has w = 1. position_float4 loads four components.
fetch position, 0, 4, 0, 12
fetch normal, 8, 3, 0, 12
fetch diffuse, 12, 4, 1, 0
fetch texcoord, 8, 2, 0, 12

; Arguments: slots of u and v.
fragment store_texcoord, OUTPUT | M(8) | M(9), NOTHING, NOTHING
    fill .u,         vmovaps         [at_output], m8
    fill .v,         vmovaps         [at_output], m9
end_fragment
