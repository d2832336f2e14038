/* Regions and loops: a jump over a region if its mask is empty, and a jump back to a loop's head while a lane
 * is left. Moves to joins and phis (move.c) are on the edges of these jumps. */
#include "engines/specialize/emit/emit.h"

/* Adds a label for a region's other end. Returns false if there are too many regions. */
static bool open_region(struct emitter *m)
{
    if (m->region_depth == REGION_DEPTH)
        return emit_note_exceeded(m, "nested regions", REGION_DEPTH), false;
    if (m->regions++ == REGION_CAPACITY)
        return emit_note_exceeded(m, "regions", REGION_CAPACITY), false;
    m->region_label[m->region_depth++] = encode_add_label(&m->encoder);
    return true;
}

/* One lane by its sign, as vtestps tests several. */
static void test_lane(struct emitter *m, const struct location *mask)
{
    if (mask->reg == NO_REGISTER)
        encode_gpr_rm(&m->encoder, X86_mov, X86_32, X86_RAX, mask->address);
    else
        encode_rr(&m->encoder, X86_vmovd_store, X86_128, X86_RAX, mask->reg);
    encode_gpr_ri(&m->encoder, X86_test, X86_32, X86_RAX, INT32_MIN);
}

/* A value of the preamble is the same in all lanes, so that one lane in memory decides. */
static bool is_word_of_preamble(const struct emitter *m, unsigned mask, const struct location *location)
{
    return mask < m->allocation->section && location->reg == NO_REGISTER && !location->mask;
}

static void test_lanes(struct emitter *m, unsigned mask)
{
    struct location location = emit_locate(m, mask);
    if (is_word_of_preamble(m, mask, &location)) {
        encode_gpr_mi(&m->encoder, X86_cmp, X86_32, location.address, 0);
        return;
    }
    if (emit_is_scalar(m)) {
        test_lane(m, &location);
        return;
    }
    unsigned test = emit_is_wide(m) ? emit_need_mask(m, &location, MASK_SCRATCH)
                                    : emit_need_register(m, &location, SCRATCH_FIRST);
    if (emit_is_wide(m))
        encode_rr(&m->encoder, X86_kortestw, X86_128, test, test);
    else
        encode_rr(&m->encoder, X86_vtestps, m->length, test, test);
}

/* If the region is skipped, the joins after it take their first operands, which are moved on that edge. */
void emit_when(struct emitter *m, const struct ir_instruction *i)
{
    test_lanes(m, i->operand[0]);
    if (!open_region(m))
        return;
    uint32_t end = m->region_label[m->region_depth - 1];
    m->moves = 0;
    if (m->ir->phis)
        emit_note_join_moves(m, m->allocation->region_at[m->position], 0);
    if (!m->moves) {
        encode_jump_if(&m->encoder, X86_IF_z, end);
        return;
    }
    uint32_t begin = encode_add_label(&m->encoder);
    encode_jump_if(&m->encoder, X86_IF_nz, begin);
    emit_write_moves(m);
    encode_jump(&m->encoder, end);
    encode_label(&m->encoder, begin);
}

void emit_end(struct emitter *m)
{
    if (m->ir->phis) {
        emit_note_join_moves(m, m->position, 1);
        emit_write_moves(m);
    }
    encode_label(&m->encoder, m->region_label[--m->region_depth]);
}

void emit_loop(struct emitter *m, const struct ir_instruction *i)
{
    if (!i->k)
        encode_align(&m->encoder, 16);
    if (!open_region(m))
        return;
    uint32_t head = m->region_label[m->region_depth - 1];
    if (i->k)
        emit_open_span(m, (enum ir_loop)i->k, head);
    else
        encode_label(&m->encoder, head);
}

void emit_again(struct emitter *m, const struct ir_instruction *i)
{
    uint32_t head = m->region_label[--m->region_depth];
    if (i->k) {
        emit_close_span(m, (enum ir_loop)i->k, head);
        return;
    }
    test_lanes(m, i->operand[0]);
    emit_note_next_moves(m);
    if (!m->moves) {
        encode_jump_if(&m->encoder, X86_IF_nz, head);
        return;
    }
    uint32_t done = encode_add_label(&m->encoder);
    encode_jump_if(&m->encoder, X86_IF_z, done);
    emit_write_moves(m);
    encode_jump(&m->encoder, head);
    encode_label(&m->encoder, done);
}
