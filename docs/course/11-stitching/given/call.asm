; Calls code between two states of the registers, to find out which it changes.
;
;   void call_between(const void *code, struct registers *registers)
;
; struct registers: sixteen general registers in the order of their numbers, then xmm0 to xmm15. rsp is left
; alone.
bits 64
default rel
section .note.GNU-stack noalloc noexec nowrite progbits
section .text
global call_between

%macro MOVE_GENERAL 2 ; load or store, base
%assign %%i 0
%rep 16
%if %%i != 4
%if %1
    mov [%2 + 8 * %%i], GENERAL(%%i)
%else
%if %%i != 10
    mov GENERAL(%%i), [%2 + 8 * %%i]
%endif
%endif
%endif
%assign %%i %%i + 1
%endrep
%endmacro

%define GENERAL(i) GENERAL_ %+ i
%define GENERAL_0 rax
%define GENERAL_1 rcx
%define GENERAL_2 rdx
%define GENERAL_3 rbx
%define GENERAL_5 rbp
%define GENERAL_6 rsi
%define GENERAL_7 rdi
%define GENERAL_8 r8
%define GENERAL_9 r9
%define GENERAL_10 r10
%define GENERAL_11 r11
%define GENERAL_12 r12
%define GENERAL_13 r13
%define GENERAL_14 r14
%define GENERAL_15 r15

%macro MOVE_VECTORS 2
%assign %%i 0
%rep 16
%if %1
    movups [%2 + 128 + 16 * %%i], xmm %+ %%i
%else
    movups xmm %+ %%i, [%2 + 128 + 16 * %%i]
%endif
%assign %%i %%i + 1
%endrep
%endmacro

call_between:
    push rbx
    push rbp
    push r12
    push r13
    push r14
    push r15
    push rsi
    push rdi
    mov r10, rsi
    MOVE_VECTORS 0, r10
    MOVE_GENERAL 0, r10
    mov r10, [r10 + 80]
    call [rsp]
    push r10
    mov r10, [rsp + 16]
    MOVE_VECTORS 1, r10
    MOVE_GENERAL 1, r10
    pop rax
    mov [r10 + 80], rax
    pop rdi
    pop rsi
    pop r15
    pop r14
    pop r13
    pop r12
    pop rbp
    pop rbx
    ret
