; The text that every routine of the external engine begins with, ended by a zero byte.

section .rodata progbits alloc noexec nowrite

    global external_vector:data hidden
external_vector:
    incbin "src/engines/external/vector.h"
    db 0
