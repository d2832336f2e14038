/* The pointers from which gathers start: textures, levels, vertex streams. They are in the job, or, where an
 * engine's name has the option `addresses`, literals in the code (engines/specialize/pointers.c). */
#include "engines/specialize/emit/emit.h"

void emit_load_pointer(struct emitter *m, unsigned base, int32_t field)
{
    if (!m->literal_pointers || base != BASE_JOB) {
        encode_gpr_rm(&m->encoder, X86_mov, X86_64, X86_RAX, address_at(emit_base_register[base], field));
        return;
    }
    if (m->pointers == POINTER_CAPACITY) {
        emit_note_exceeded(m, "pointers", POINTER_CAPACITY);
        return;
    }
    encode_gpr_constant(&m->encoder, X86_RAX, (uint64_t)POINTER_PLACEHOLDER << 32 | (uint32_t)field);
    m->pointer[m->pointers++] =
        (struct code_pointer){(uint32_t)(encode_size(&m->encoder) - sizeof(uint64_t)), field};
}
