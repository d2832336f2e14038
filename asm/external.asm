; The text at the head of every routine that the external engine compiles, ended by a zero.

section .rodata progbits alloc noexec nowrite

    global external_vector:data hidden
external_vector:
    incbin "src/external/vector.h"
    db 0
