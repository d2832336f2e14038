; The texts that the routines of the external engine begin with, each ended by a zero byte.

section .rodata progbits alloc noexec nowrite

    global external_vector:data hidden
external_vector:
    incbin "src/engines/external/vector.h"
    db 0

    global external_plain:data hidden
external_plain:
    incbin "src/engines/external/plain.h"
    db 0
