; Operation fragments: one operation of src/def/op.def each, under its name.
;
; A value is a 32-byte slot of the routine's frame: eight lanes, [frame + slot]. Every fragment loads its operands,
; computes, stores; nothing stays in a vector register from one fragment to the next. The result's slot may be an
; operand's: operands are read before the result is written. Arguments: the result's slot, then the operands in the
; order of the table, then the staged immediate.

%include "fragment.inc"

%define RESULT 0
%define A      1
%define B      2
%define C      3

%macro unary 2 ; name, instruction
fragment %1, FRAME, NOTHING, M(0)
    fill A,       %2              m0, [frame]
    fill RESULT,  vmovaps         [frame], m0
end_fragment
%endmacro

%macro binary 2 ; name, instruction
fragment %1, FRAME, NOTHING, M(0)
    fill A,       vmovaps         m0, [frame]
    fill B,       %2              m0, m0, [frame]
    fill RESULT,  vmovaps         [frame], m0
end_fragment
%endmacro

; The comparison's predicate lies behind the displacement, so the operand is loaded first.
%macro compare 2 ; name, instruction
fragment %1, FRAME, NOTHING, M(0) | M(1)
    fill A,       vmovaps         m0, [frame]
    fill B,       vmovaps         m1, [frame]
                %2              m0, m0, m1
    fill RESULT,  vmovaps         [frame], m0
end_fragment
%endmacro

%macro select 1 ; name
fragment %1, FRAME, NOTHING, M(0) | M(1) | M(2)
    fill A,       vmovaps         m0, [frame]
    fill B,       vmovaps         m1, [frame]
    fill C,       vmovaps         m2, [frame]
                vblendvps       m0, m2, m1, m0
    fill RESULT,  vmovaps         [frame], m0
end_fragment
%endmacro

%macro shift 2 ; name, instruction
fragment %1, FRAME, NOTHING, M(0)
    fill A,       vmovdqa         m0, [frame]
    fill_byte B,  %2              m0, m0, 0
    fill RESULT,  vmovdqa         [frame], m0
end_fragment
%endmacro

; ---- binary32

binary add_f, vaddps
binary sub_f, vsubps
binary mul_f, vmulps
binary div_f, vdivps
binary min_f, vminps
binary max_f, vmaxps
unary  sqrt_f, vsqrtps
select select_f
compare lt_f, vcmpltps
compare le_f, vcmpleps
compare eq_f, vcmpeqps
compare ne_f, vcmpneqps

fragment mad_f, FRAME, NOTHING, M(0) | M(1)
    fill A,       vmovaps         m0, [frame]
    fill B,       vmovaps         m1, [frame]
    fill C,       vfmadd213ps     m0, m1, [frame]
    fill RESULT,  vmovaps         [frame], m0
end_fragment

fragment neg_f, FRAME, NOTHING, M(0)
                vpcmpeqd        m0, m0, m0
                vpslld          m0, m0, 31
    fill A,       vxorps          m0, m0, [frame]
    fill RESULT,  vmovaps         [frame], m0
end_fragment

fragment floor_f, FRAME, NOTHING, M(0)
    fill A,       vmovaps         m0, [frame]
                vroundps        m0, m0, 1
    fill RESULT,  vmovaps         [frame], m0
end_fragment

fragment half_f, FRAME, NOTHING, M(0)
    fill A,       vmovaps         m0, [frame]
                vcvtps2ph       xm0, m0, 0              ; to nearest even
                vcvtph2ps       m0, xm0
    fill RESULT,  vmovaps         [frame], m0
end_fragment

; ---- conversions

unary round_i, vcvtps2dq
unary trunc_i, vcvttps2dq
unary float_f, vcvtdq2ps

; ---- 32-bit integers

binary add_i, vpaddd
binary sub_i, vpsubd
binary mul_i, vpmulld
binary dot_i, vpmaddwd
binary and_i, vpand
binary or_i,  vpor
binary xor_i, vpxor
binary min_i, vpminsd
binary max_i, vpmaxsd
binary eq_i,  vpcmpeqd
binary gt_i,  vpcmpgtd
select select_i
shift shl_i,  vpslld
shift shr_i,  vpsrad
shift ushr_i, vpsrld

; ---- pairs of 16-bit integers

binary add_x, vpaddw
binary sub_x, vpsubw
binary mul_x, vpmullw
binary min_x, vpminuw
shift shl_x,  vpsllw
shift ushr_x, vpsrlw

; ---- masks

binary and_m, vpand
binary or_m,  vpor

fragment andn_m, FRAME, NOTHING, M(0)
    fill B,       vmovaps         m0, [frame]
    fill A,       vandnps         m0, m0, [frame]
    fill RESULT,  vmovaps         [frame], m0
end_fragment

; ---- literals and memory: not rows of op.def, listed in src/def/fragment.def
;
; Memory operations name their base by a hole, so any of r8 to r14 serves; the contract lists r8, which is what the
; bytes say before the hole is filled.

fragment literal, FRAME, NOTHING, R_AX | M(0)
    fill 1,       mov             eax, strict dword 0
                vmovd           xm0, eax
                vpbroadcastd    m0, xm0
    fill 0,       vmovdqa         [frame], m0
end_fragment

shift permute, vpermilps

fragment load, FRAME | JOB, NOTHING, M(0)
    fill_base 1, 2, vmovups       m0, [dword r8]           ; indices and lane tables need not be aligned
    fill 0,       vmovaps         [frame], m0
end_fragment

fragment uniform, FRAME | JOB, NOTHING, M(0)
    fill_base 1, 2, vbroadcastss  m0, [dword r8]
    fill 0,       vmovaps         [frame], m0
end_fragment

; The same from a pointer at base + field.
fragment uniform_indirect, FRAME | JOB, NOTHING, R_AX | M(0)
    fill_base 1, 2, mov           rax, [dword r8]
    fill 3,       vbroadcastss    m0, [dword rax]
    fill 0,       vmovaps         [frame], m0
end_fragment

fragment store, FRAME | JOB, NOTHING, M(0)
    fill 0,       vmovaps         m0, [frame]
    fill_base 1, 2, vmovups       [dword r8], m0           ; nor need a lane table's counters be
end_fragment

; Lane i from base + index[i] * scale + displacement; the scale comes with the base.
fragment gather, FRAME | JOB, NOTHING, M(0) | M(1) | M(2)
    fill 1,       vmovdqa         m1, [frame]
                vpcmpeqd        m2, m2, m2
    fill_base 2, 3, vpgatherdd    m0, [dword r8 + m1 * 1], m2
    fill 0,       vmovdqa         [frame], m0
end_fragment

; The same from a pointer at base + field.
fragment gather_indirect, FRAME | JOB, NOTHING, R_AX | M(0) | M(1) | M(2)
    fill 1,       vmovdqa         m1, [frame]
    fill_base 2, 3, mov           rax, [dword r8]
                vpcmpeqd        m2, m2, m2
    fill_base 4, 5, vpgatherdd    m0, [dword rax + m1 * 1], m2
    fill 0,       vmovdqa         [frame], m0
end_fragment

; Lane i to base + offset + i * stride.
fragment scatter, FRAME | JOB, NOTHING, R_AX | R_CX | R_DX
    fill_base 1, 2, lea           rax, [dword r8]
    fill 3,       mov             ecx, strict dword 0
    %assign lane 0
    %rep 8
    fill 0,       mov             edx, [frame + 4 * lane]
                mov             [rax], edx
      %if lane < 7
                add             rax, rcx
      %endif
      %assign lane lane + 1
    %endrep
end_fragment

; One slot to another.
unary copy, vmovaps

; Jumps back as long as a lane of the mask is set.
fragment again, FRAME, NOTHING, M(0)
    fill 0,       vmovaps         m0, [frame]
                vtestps         m0, m0
    jump 1,     jnz
end_fragment

; Jumps when no lane of the mask is set.
fragment when, FRAME, NOTHING, M(0)
    fill 0,       vmovaps         m0, [frame]
                vtestps         m0, m0
    jump 1,     jz
end_fragment
