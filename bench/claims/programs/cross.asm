; Fragment 12 of the thesis, in the text of SoftWire 1.3.3: det, a macro for the FPU, and cross, which has a
; version for SSE and one without. cross computes the cross product of two vectors of three components.
;
; As printed, xmm0 and xmm1 are never loaded, and the versions have no end. Here [esi] and [edi] are loaded
; first. They are the pointers rsi and rdi of 64 bits: the operands first and second of
;     void cross_sse(float *result, const float *second, const float *first)    (rdi, rsi, rdx)
; with four components, whose fourth is not used. The printed names of registers are comments.
;
;   nasm -f elf64 cross.asm

section .text
section .note.GNU-stack noalloc noexec nowrite progbits
section .text

; det a, b, c, d: the determinant a * d - b * c in st0. Four operands in memory.
%macro det 4
    fld     dword %1
    fmul    dword %4
    fld     dword %2
    fmul    dword %3
    fsubp   st1, st0
%endmacro

%define SSE 1
    global cross_sse
cross_sse:
%if SSE
    movups  xmm0, [rdx]         ; first: not printed
    movups  xmm1, [rsi]         ; second: not printed
    movaps  xmm2, xmm0
    movaps  xmm3, xmm1
    shufps  xmm0, xmm0, 0x09    ; y z x
    shufps  xmm1, xmm1, 0x12    ; z x y
    mulps   xmm0, xmm1
    shufps  xmm2, xmm2, 0x12    ; z x y
    shufps  xmm3, xmm3, 0x09    ; y z x
    mulps   xmm2, xmm3
    subps   xmm0, xmm2
    movups  [rdi], xmm0
    ret
%endif
cross_sse_end:

    global cross_fpu
cross_fpu:
    det     [rdx + 4], [rdx + 8], [rsi + 4], [rsi + 8]
    fstp    dword [rdi]
    det     [rdx + 8], [rdx], [rsi + 8], [rsi]
    fstp    dword [rdi + 4]
    det     [rdx], [rdx + 4], [rsi], [rsi + 4]
    fstp    dword [rdi + 8]
    ret
cross_fpu_end:

section .rodata
    global cross_bytes
cross_bytes:
    dd cross_sse_end - cross_sse, cross_fpu_end - cross_fpu
