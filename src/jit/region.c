/* Regions and loops as code: jumps around a region when no lane is in it, and back to a loop's head while any stays, with
 * the moves to joins and phis on the way that control takes (move.c). */
#include "jit/emit.h"

/* A label for a region's other end, remembered until that end comes; 0 when there is no room. */
static int open_region(struct emitter *m)
{
    if (m->region_depth == REGION_DEPTH)
        return note_exceeded(m, "nested regions", REGION_DEPTH), 0;
    if (m->regions++ == REGION_CAPACITY)
        return note_exceeded(m, "regions", REGION_CAPACITY), 0;
    m->region_label[m->region_depth++] = encoder_add_label(&m->encoder);
    return 1;
}

static void test_lanes(struct emitter *m, unsigned mask)
{
    struct place place = place_of(m, mask);
    unsigned test = is_wide(m) ? need_mask(m, &place, MASK_SCRATCH) : need_register(m, &place, SCRATCH_FIRST);
    if (is_wide(m))
        vector_rr(&m->encoder, X86_kortestw, X86_128, test, test);
    else
        vector_rr(&m->encoder, X86_vtestps, m->length, test, test);
}

/* When the region does not run, what the joins behind it take from before moves on the way around it. */
void select_when(struct emitter *m, const struct ir_instruction *i)
{
    test_lanes(m, i->operand[0]);
    if (!open_region(m))
        return;
    uint32_t end = m->region_label[m->region_depth - 1];
    m->moves = 0;
    if (m->ir->phis)
        note_join_moves(m, m->allocation->region_at[m->position], 0);
    if (!m->moves) {
        encode_jump_if(&m->encoder, X86_IF_z, end);
        return;
    }
    uint32_t begin = encoder_add_label(&m->encoder);
    encode_jump_if(&m->encoder, X86_IF_nz, begin);
    write_moves(m);
    encode_jump(&m->encoder, end);
    encode_label(&m->encoder, begin);
}

void select_end(struct emitter *m)
{
    if (m->ir->phis) {
        note_join_moves(m, m->position, 1);
        write_moves(m);
    }
    encode_label(&m->encoder, m->region_label[--m->region_depth]);
}

void select_loop(struct emitter *m)
{
    encode_align(&m->encoder, 16);
    if (open_region(m))
        encode_label(&m->encoder, m->region_label[m->region_depth - 1]);
}

void select_again(struct emitter *m, const struct ir_instruction *i)
{
    uint32_t head = m->region_label[--m->region_depth];
    test_lanes(m, i->operand[0]);
    note_next_moves(m);
    if (!m->moves) {
        encode_jump_if(&m->encoder, X86_IF_nz, head);
        return;
    }
    uint32_t done = encoder_add_label(&m->encoder);
    encode_jump_if(&m->encoder, X86_IF_z, done);
    write_moves(m);
    encode_jump(&m->encoder, head);
    encode_label(&m->encoder, done);
}
