; Operation fragments: one operation of src/def/op.def each, under its name.
;
; A value is eight lanes in a vector register. The numbers of the result's and the operands' registers are
; holes. If an operand can be in memory, a second fragment follows, with `_memory` after the name, that
; reads it from there: from a slot of the stack frame, from a literal after the code, or from consecutive
; words of a base. Arguments: the result's register, then the operands in the order of the table, then the
; immediate. An operand in memory is a displacement; its base register is the last of all arguments. The
; result may be in an operand's register unless the fragment is marked `apart`. m15 is reserved for the
; fragments.
;
; The first literal is always the sign bit.

%include "fragment.inc"

%define RESULT 0
%define A      1
%define B      2
%define C      3
%define IS(n)  (1 << (n))

%macro unary 2 ; name, instruction
fragment %1, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    folds   A
    vector        RESULT, NO_FIELD, A,  %2 m0, m0
end_fragment
fragment %1_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), 0
    vector_memory RESULT, NO_FIELD, A,  %2 m0, [frame]
end_fragment
%endmacro

%macro binary 2 ; name, instruction
fragment %1, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(B)
    folds   B
    vector        RESULT, A, B,  %2 m0, m0, m0
end_fragment
fragment %1_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector_memory RESULT, A, B,  %2 m0, m0, [frame]
end_fragment
%endmacro

; The mask's number follows ModRM or the displacement.
%macro select 1 ; name
fragment %1, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(B) | IS(C)
    folds   B
    vector        RESULT, C, B,  vblendvps m0, m0, m0, m0
.end:           hole            .end - 1, HOLE_MASK, A
end_fragment
fragment %1_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(C)
    vector_memory RESULT, C, B,  vblendvps m0, m0, [frame], m0
.end:           hole            .end - 1, HOLE_MASK, A
end_fragment
%endmacro

%macro shift 2 ; name, instruction
fragment %1, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        NO_REG, RESULT, A,  %2 m0, m0, 0
.end:           hole            .end - 1, HOLE_BYTE, B
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
binary lt_f, vcmpltps
binary le_f, vcmpleps
binary eq_f, vcmpeqps
binary ne_f, vcmpneqps

; Three forms, in this order. The first gives a * b + c in a register of its own. The second gives it in
; the register of a factor that is not read later (arguments: result, the other factor, the summand). The
; third gives it in the register of a summand that is not read later (arguments: result, both factors).
%macro mad 3 ; name, instructions
fragment %1, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(B) | IS(C)
    folds   C
    apart
    in_place
    vector        RESULT, NO_FIELD, A,  vmovaps m0, m0
    vector        RESULT, B, C,  %2 m0, m0, m0
end_fragment
fragment %1_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(B)
    apart
    vector        RESULT, NO_FIELD, A,  vmovaps m0, m0
    vector_memory RESULT, B, C,  %2 m0, m0, [frame]
end_fragment
fragment %1_factor, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(RESULT) | IS(1) | IS(2)
    folds   2
    vector        RESULT, 1, 2,  %2 m0, m0, m0
end_fragment
fragment %1_factor_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(RESULT) | IS(1)
    vector_memory RESULT, 1, 2,  %2 m0, m0, [frame]
end_fragment
fragment %1_sum, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(RESULT) | IS(1) | IS(2)
    folds   2
    vector        RESULT, 1, 2,  %3 m0, m0, m0
end_fragment
fragment %1_sum_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(RESULT) | IS(1)
    vector_memory RESULT, 1, 2,  %3 m0, m0, [frame]
end_fragment
%endmacro

mad mad_f,   vfmadd213ps,  vfmadd231ps
mad nmad_f,  vfnmadd213ps, vfnmadd231ps
mad msub_f,  vfmsub213ps,  vfmsub231ps
mad nmsub_f, vfnmsub213ps, vfnmsub231ps

; Both bounds are literals.
fragment clamp_f, CONSTANTS, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    pools   IS(B) | IS(C)
    vector        RESULT, A, NO_FIELD,  vmaxps m0, m0, [dword constants]
.low:           hole            .low - 4, HOLE_WORD, B
    vector        RESULT, RESULT, NO_FIELD,  vminps m0, m0, [dword constants]
.high:          hole            .high - 4, HOLE_WORD, C
end_fragment

fragment neg_f, CONSTANTS, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        RESULT, A, NO_FIELD,  vxorps m0, m0, [constants]
end_fragment

fragment floor_f, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        RESULT, NO_FIELD, A,  vroundps m0, m0, 1
end_fragment

fragment half_f, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        A, NO_FIELD, RESULT,  vcvtps2ph xm0, m0, 0    ; to nearest even
    vector        RESULT, NO_FIELD, RESULT,  vcvtph2ps m0, xm0
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
fragment upper_i, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        RESULT, NO_FIELD, A,  vpshuflw m0, m0, 0xf5
    vector        RESULT, NO_FIELD, RESULT,  vpshufhw m0, m0, 0xf5
end_fragment
shift shl_i,  vpslld
shift shr_i,  vpsrad
shift ushr_i, vpsrld

; Each word beside itself in 64 bits, shifted: the high half is the rotated word.
fragment rotl_i, NOTHING, NOTHING, M(15)
    vectors IS(RESULT), IS(A)
    vector        NO_REG, A, A,  vpunpckhdq m15, m0, m0
    vector        RESULT, A, A,  vpunpckldq m0, m0, m0
                vpsllq          m15, m15, 0
.high:          hole            .high - 1, HOLE_BYTE, B
    vector        NO_REG, RESULT, RESULT,  vpsllq m0, m0, 0
.low:           hole            .low - 1, HOLE_BYTE, B
    vector        RESULT, RESULT, NO_FIELD,  vshufps m0, m0, m15, 0xdd
end_fragment

; ---- pairs of 16-bit integers

binary add_x, vpaddw
binary sub_x, vpsubw
binary mul_x, vpmullw
binary min_x, vpminuw
binary high_x, vpmulhuw
binary scale_x, vpmulhrsw
shift shl_x,  vpsllw
shift ushr_x, vpsrlw

; ---- masks

binary and_m, vpand
binary or_m,  vpor

fragment andn_m, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A) | IS(B)
    folds   A
    vector        RESULT, B, A,  vandnps m0, m0, m0
end_fragment
fragment andn_m_memory, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), IS(B)
    vector_memory RESULT, B, A,  vandnps m0, m0, [frame]
end_fragment

; ---- literals and memory: not rows of op.def, listed in src/def/engine/fragment.def

; Once, before the loop: the address of the literals.
fragment literals, NOTHING, CONSTANTS, NOTHING
                lea             constants, [rel .end]
.end:           hole            .end - 4, HOLE_LITERALS, 0
end_fragment

fragment permute, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        RESULT, NO_FIELD, A,  vpermilps m0, m0, 0
.end:           hole            .end - 1, HOLE_BYTE, B
end_fragment

fragment copy, NOTHING, NOTHING, NOTHING
    vectors IS(RESULT), IS(A)
    vector        RESULT, NO_FIELD, A,  vmovaps m0, m0
end_fragment

; Addresses outside of the stack frame need not be aligned.
fragment load, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), 0
    vector_memory RESULT, NO_FIELD, 1,  vmovups m0, [frame]
end_fragment

fragment uniform, FRAME, NOTHING, NOTHING
    vectors IS(RESULT), 0
    vector_memory RESULT, NO_FIELD, 1,  vbroadcastss m0, [frame]
end_fragment

fragment store, FRAME, NOTHING, NOTHING
    vectors 0, IS(0)
    vector_memory 0, NO_FIELD, 1,  vmovups [frame], m0
end_fragment

; Lane i is loaded from base + index[i] * scale + displacement. The base is one of r8 to r14, counted from
; r8, and its argument includes the scale. The contract lists r8, which is the base while the hole is
; empty.
fragment gather, JOB, NOTHING, M(15)
    vectors IS(RESULT), IS(A)
    apart
                vpcmpeqd        m15, m15, m15
.at:
    fill_base 2, 3, vpgatherdd m0, [dword r8 + m0 * 1], m15
                hole            .at + 1, HOLE_VECTOR, RESULT | NO_FIELD << 2 | NO_FIELD << 5
                hole            .at + 1, HOLE_INDEX, A
end_fragment

; The same, from the pointer at base + field.
fragment gather_indirect, JOB, NOTHING, R_AX | M(15)
    vectors IS(RESULT), IS(A)
    apart
    fill_base 2, 3, mov           rax, [dword r8]
                vpcmpeqd        m15, m15, m15
.at:
    fill_base 4, 5, vpgatherdd m0, [dword rax + m0 * 1], m15
                hole            .at + 1, HOLE_VECTOR, RESULT | NO_FIELD << 2 | NO_FIELD << 5
                hole            .at + 1, HOLE_INDEX, A
end_fragment

; Lane i is stored to base + offset + i * stride.
fragment scatter, JOB, NOTHING, R_AX | R_CX | R_DX | M(15)
    vectors 0, IS(0)
    vector        NO_REG, NO_FIELD, 0,  vmovdqa m15, m0
    fill_base 1, 2, lea           rax, [dword r8]
    fill 3,       mov             ecx, strict dword 0
                lea             rdx, [rcx + 2 * rcx]
                vmovd           [rax], xm15
                vpextrd         [rax + rcx], xm15, 1
                vpextrd         [rax + 2 * rcx], xm15, 2
                vpextrd         [rax + rdx], xm15, 3
                vextracti128    xm15, m15, 1
                lea             rax, [rax + 4 * rcx]
                vmovd           [rax], xm15
                vpextrd         [rax + rcx], xm15, 1
                vpextrd         [rax + 2 * rcx], xm15, 2
                vpextrd         [rax + rdx], xm15, 3
end_fragment

; ---- control

; Jumps back while a lane of the mask is set.
fragment again, NOTHING, NOTHING, NOTHING
    vectors 0, IS(0)
    vector        0, NO_FIELD, 0,  vtestps m0, m0
    jump 1,     jnz
end_fragment

; Jumps when no lane of the mask is set.
fragment when, NOTHING, NOTHING, NOTHING
    vectors 0, IS(0)
    vector        0, NO_FIELD, 0,  vtestps m0, m0
    jump 1,     jz
end_fragment
