/* Subroutines, and calls of them (passes/subroutine.h). Their code follows the routine's, and they have a
 * convention of their own:
 *
 *   arguments, results   in the frame of the routine, as the variables after those of the program
 *   frame                a subroutine has none: its spill slots are in the frame of the routine. It does not
 *                        move rsp, and uses no memory below it. The return address is at rsp, so entries of
 *                        the frame are RETURN_BYTES further from it than for the caller, with the same
 *                        alignment.
 *   vector registers     all may be written. The caller has the set of those that are, and saves the ones
 *                        with a value that it uses after the call; so it does with mask registers.
 *   other registers      as around any operation: rax, r12, r13 and the flags may be written, the bases keep
 *                        their contents. A caller moves the job for a call with another texture.
 *   rbp                  the frame's, from which a debugger finds the caller of the routine */
#include "engines/specialize/emit/emit.h"

#include <string.h>

enum { RETURN_BYTES = 8 };

/* --- Preparation ---------------------------------------------------------------------------------------- */

/* The registers that values of the program can have. */
static uint64_t bit_of(unsigned reg)
{
    return reg < REGISTERS ? 1ull << reg & (WIDE_REGISTERS | MASK_REGISTERS) : 0;
}

static void note_written(struct emitter *m, unsigned subroutine, uint32_t number)
{
    const struct allocation *a = m->allocation;
    if (a->residence[number] != RESIDENCE_REGISTER)
        return;
    m->subroutine_writes[subroutine] |= bit_of(a->reg[number]) | bit_of(a->reg[allocate_web(a, number)]);
}

/* Finds where subroutines begin, and which registers each writes. */
static void find_subroutines(struct emitter *m)
{
    unsigned subroutine = 0;
    memset(m->subroutine_writes, 0, sizeof m->subroutine_writes);
    m->program_end = m->ir->count;
    for (uint32_t number = 1; m->ir->subroutines && number < m->ir->count; number++) {
        const struct ir_instruction *i = &m->ir->instruction[number];
        if (i->op == IR_subroutine) {
            subroutine = (unsigned)i->k;
            m->subroutine_label[subroutine] = encode_add_label(&m->encoder);
            if (m->program_end > number)
                m->program_end = number;
        } else if (m->program_end < number)
            note_written(m, subroutine, number);
    }
}

/* The registers that hold values that are used after a position. */
static uint64_t held_across(const struct emitter *m, uint32_t position)
{
    const struct allocation *a = m->allocation;
    uint64_t held = 0;
    for (uint32_t value = 1; value < position; value++)
        if (a->residence[value] == RESIDENCE_REGISTER && allocate_web(a, value) == value &&
            a->last[value] > position && a->split[value] >= position)
            held |= bit_of(a->reg[value]);
    return held;
}

static uint64_t saved_around(const struct emitter *m, uint32_t call)
{
    return held_across(m, call) & m->subroutine_writes[m->ir->instruction[call].k];
}

uint32_t emit_prepare_calls(struct emitter *m)
{
    uint32_t most = 0;
    m->frame_shift = 0;
    find_subroutines(m);
    for (uint32_t number = 1; m->ir->subroutines && number < m->program_end; number++) {
        if (m->ir->instruction[number].op != IR_call)
            continue;
        uint32_t saved = (uint32_t)__builtin_popcountll(saved_around(m, number));
        if (most < saved)
            most = saved;
    }
    return most;
}

/* --- Code ----------------------------------------------------------------------------------------------- */

static void load_saved(struct emitter *m, unsigned reg, struct address from)
{
    if (reg >= MASKS)
        encode_rm(&m->encoder, X86_kmovw, X86_128, reg - MASKS, from);
    else
        encode_rm(&m->encoder, emit_is_scalar(m) ? X86_vmovss : X86_vmovaps, m->length, reg, from);
}

static void move_job(struct emitter *m, int32_t bytes)
{
    if (bytes)
        encode_gpr_ri(&m->encoder, X86_add, X86_64, emit_base_register[BASE_JOB], bytes);
}

void emit_call(struct emitter *m, const struct ir_instruction *i)
{
    const uint64_t saved = saved_around(m, m->position);
    unsigned slot = 0;
    for (uint64_t left = saved; left; left &= left - 1)
        emit_store_register(m, emit_frame_address(m, m->frame_saved, slot++),
                            (unsigned)__builtin_ctzll(left));
    move_job(m, i->field);
    encode_call(&m->encoder, m->subroutine_label[i->k]);
    move_job(m, -i->field);
    slot = 0;
    for (uint64_t left = saved; left; left &= left - 1)
        load_saved(m, (unsigned)__builtin_ctzll(left), emit_frame_address(m, m->frame_saved, slot++));
}

void emit_begin_subroutine(struct emitter *m, const struct ir_instruction *i)
{
    encode_align(&m->encoder, 16);
    encode_label(&m->encoder, m->subroutine_label[i->k]);
}

void emit_subroutines(struct emitter *m)
{
    m->frame_shift = RETURN_BYTES;
    emit_instructions(m, m->ir->count, true);
    m->frame_shift = 0;
}
