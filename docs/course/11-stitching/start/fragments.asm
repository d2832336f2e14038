; The fragments of lab 11. Registers and holes: given/stitch.h.
bits 64
default rel
section .note.GNU-stack noalloc noexec nowrite progbits
section .text

; Begins and ends a fragment: FRAGMENT name ... END name.
%macro FRAGMENT 1
global fragment_%1
fragment_%1:
%endmacro
%macro END 1
global fragment_%1_end
fragment_%1_end:
%endmacro

%define LEFT 0x11111111
%define RIGHT 0x22222222
%define RESULT 0x33333333
%define ELEMENT 0x44444444

; Complete: one number from a to the frame.
FRAGMENT load_a
    movss xmm0, [rdi + ELEMENT]
    movss [rcx + RESULT], xmm0
END load_a

FRAGMENT load_b
END load_b

FRAGMENT multiply
END multiply

FRAGMENT add
END add

FRAGMENT store_c
END store_c
