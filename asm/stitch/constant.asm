; The table of constant.inc.

%include "constant.inc"

section .rodata progbits alloc noexec nowrite align=64

%macro constant 2 ; name, bits
    times 8 dd %2
%endmacro

    global stitch_constants:data hidden
stitch_constants:
    each_constant
