/* The body of a routine: code for each IR instruction, in order. Operations that compute, gathers, scatters
 * and windows have files of their own.
 *
 * Lanes are in memory order, so loads and stores are plain moves. */
#include "engines/specialize/emit/emit.h"

static void select_variable(struct emitter *m, const struct ir_instruction *i)
{
    bool exchanged = ir_properties(i) & IR_EXCHANGED; /* the variables after those of the program */
    struct address variable =
        emit_frame_address(m, m->frame_variables, (unsigned)i->k + (exchanged ? m->ir->variables : 0));
    bool mask = emit_is_wide(m) && i->type == TYPE_msk;
    struct location value = emit_locate(m, i->operand[0]);
    bool reads = i->op == IR_get || i->op == IR_take;
    if (reads && mask)
        encode_rm(&m->encoder, X86_kmovw, X86_128, emit_result_register(m) - MASKS, variable);
    else if (reads)
        encode_rm(&m->encoder, emit_is_scalar(m) ? X86_vmovss : X86_vmovaps, m->length,
                  emit_result_register(m), variable);
    else
        emit_store_register(m, variable,
                            mask ? MASKS + emit_need_mask(m, &value, MASK_SCRATCH)
                                 : emit_need_register(m, &value, SCRATCH_FIRST));
}

/* With one lane, all three are moves of a word. */
static void select_memory(struct emitter *m, const struct ir_instruction *i)
{
    enum x86_vector load = i->op == IR_load ? X86_vmovups : X86_vbroadcastss;
    struct address at = emit_base_address(i->base, i->k);
    if (i->op == IR_store) {
        struct location value = emit_locate(m, i->operand[0]);
        encode_mr(&m->encoder, emit_is_scalar(m) ? X86_vmovss_store : X86_vmovups_store, m->length, at,
                  emit_need_register(m, &value, SCRATCH_FIRST));
    } else
        encode_rm(&m->encoder, emit_is_scalar(m) ? X86_vmovss : load, m->length, emit_result_register(m), at);
}

static void select_store_where(struct emitter *m, const struct ir_instruction *i)
{
    struct location value = emit_locate(m, i->operand[0]), mask = emit_locate(m, i->operand[1]);
    struct address at = emit_base_address(i->base, i->k);
    unsigned from = emit_need_register(m, &value, SCRATCH_FIRST);
    at.mask = (uint8_t)emit_need_mask(m, &mask, MASK_SCRATCH);
    encode_mr(&m->encoder, X86_vmovups_store, m->length, at, from);
}

enum { ONE = 0x3f800000 };

/* The address of a literal's single word, for an instruction that broadcasts it. */
static struct address literal_word(struct emitter *m, int32_t bits)
{
    struct address word = emit_literal_address(m, bits, LITERAL_ONCE);
    word.broadcast = 0;
    return word;
}

/* 1 / plane. If the three words of the plane are 1, 0 and 0, the result is 1 at every pixel and the division
 * is skipped. */
static void select_reciprocal(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct location x = emit_locate(m, i->operand[0]), y = emit_locate(m, i->operand[1]);
    struct address value = emit_base_address(i->base, i->k), dx = value, dy = value;
    uint32_t divide = encode_add_label(e), done = encode_add_label(e);
    unsigned to = emit_result_register(m);
    dx.displacement += (int32_t)offsetof(struct plane, dx);
    dy.displacement += (int32_t)offsetof(struct plane, dy);
    encode_rm(e, X86_vbroadcastss, m->length, to, literal_word(m, ONE));
    encode_gpr_mi(e, X86_cmp, X86_64, dx, 0);
    encode_jump_if(e, X86_IF_nz, divide);
    encode_gpr_mi(e, X86_cmp, X86_32, value, ONE);
    encode_jump_if(e, X86_IF_z, done);
    encode_label(e, divide);
    encode_rm(e, X86_vbroadcastss, m->length, SCRATCH_SECOND, value);
    dx.broadcast = dy.broadcast = 1;
    encode_rrm(e, X86_vfmadd231ps, m->length, SCRATCH_SECOND, emit_need_register(m, &y, SCRATCH_FIRST), dy);
    encode_rrm(e, X86_vfmadd231ps, m->length, SCRATCH_SECOND, emit_need_register(m, &x, SCRATCH_FIRST), dx);
    encode_rrr(e, X86_vdivps, m->length, to, to, SCRATCH_SECOND);
    encode_label(e, done);
}

static void select_copy(struct emitter *m, const struct ir_instruction *i)
{
    struct location source = emit_locate(m, i->operand[0]);
    emit_bring(m, emit_result_register(m), &source);
}

/* --- Regions and loops ---------------------------------------------------------------------------------- */

/* A jump over a region if its mask is empty, and a jump back to a loop's head while a lane is left. Moves to
 * joins and phis (move.c) are on the edges of these jumps. */

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
static void select_when(struct emitter *m, const struct ir_instruction *i)
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

static void select_end(struct emitter *m)
{
    if (m->ir->phis) {
        emit_note_join_moves(m, m->position, 1);
        emit_write_moves(m);
    }
    encode_label(&m->encoder, m->region_label[--m->region_depth]);
}

static void select_loop(struct emitter *m, const struct ir_instruction *i)
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

static void select_again(struct emitter *m, const struct ir_instruction *i)
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

/* --- Instructions --------------------------------------------------------------------------------------- */

/* Returns true if only emit_bring() writes SCRATCH_FIRST in the instruction's code, and no jump leads to
 * it. */
static bool keeps_scratch(const struct ir_instruction *i)
{
    return ir_properties(i) & IR_COMPUTES || i->op == IR_copy || i->op == IR_load || i->op == IR_uniform;
}

static void select_instruction(struct emitter *m, const struct ir_instruction *i)
{
    m->keeps_scratch = keeps_scratch(i);
    m->holds_literal &= m->keeps_scratch;
    switch (i->op) {
    case IR_gather: emit_gather(m, i); break;
    case IR_reciprocal: select_reciprocal(m, i); break;
    case IR_store_where: select_store_where(m, i); break;
    case IR_coverage:
        encode_rm(&m->encoder, X86_kmovw, X86_128, emit_result_register(m) - MASKS,
                  emit_base_address(i->base, i->k));
        break;
    case IR_window: emit_window(m, i); break;
    case IR_near: emit_near(m, i); break;
    case IR_near_column: emit_near_column(m, i); break;
    case IR_near_row: emit_near_row(m, i); break;
    case IR_stretch: emit_stretch(m); break;
    case IR_stretched: emit_stretched(m, i); break;
    case IR_scatter: emit_scatter(m, i); break;
    case IR_when: select_when(m, i); break;
    case IR_end: select_end(m); break;
    case IR_loop: select_loop(m, i); break;
    case IR_again: select_again(m, i); break;
    case IR_call: emit_call(m, i); break;
    case IR_subroutine: emit_begin_subroutine(m, i); break;
    case IR_leave: encode_return(&m->encoder); break;
    case IR_put:
    case IR_take:
    case IR_set:
    case IR_get: select_variable(m, i); break;
    case IR_load:
    case IR_uniform:
    case IR_store: select_memory(m, i); break;
    case IR_copy:
    case IR_phi: select_copy(m, i); break;
    case IR_section:
    case IR_repeat: break;
    case IR_rest: emit_rest(m); break;
    case IR_next:
    case IR_join: break; /* moves at the region's end */
    default: emit_computed(m, i); break;
    }
}

/* Returns true if the instruction's code writes its register. Joins are written by moves, and a phi whose
 * first value is of its own web needs no code. */
static bool writes_result(const struct emitter *m, const struct ir_instruction *i)
{
    const struct allocation *a = m->allocation;
    return i->op != IR_join &&
           (i->op != IR_phi || allocate_web(a, m->position) != allocate_web(a, i->operand[0]));
}

void emit_store_spilled(struct emitter *m)
{
    unsigned slot = m->allocation->slot[allocate_web(m->allocation, m->position)];
    if (slot != NO_SLOT)
        emit_store_register(m, emit_slot_address(m, slot), emit_result_register(m));
}

void emit_instructions(struct emitter *m, uint32_t end, bool lines)
{
    m->selected = 0;
    for (; m->position < end && !m->exceeded; m->position++) {
        const struct ir_instruction *i = &m->ir->instruction[m->position];
        bool effect = ir_properties(i) & IR_EFFECT;
        if (!effect && (m->allocation->residence[m->position] != RESIDENCE_REGISTER || !writes_result(m, i)))
            continue;
        if (m->position >= m->selected) {
            if (lines)
                emit_note_line(m, m->position);
            select_instruction(m, i);
        }
        if (!effect)
            emit_store_spilled(m);
    }
    m->keeps_scratch = m->holds_literal = false;
}

void emit_preamble(struct emitter *m)
{
    m->position = 1;
    emit_instructions(m, ir_find_body(m->ir), true);
}

void emit_body(struct emitter *m)
{
    m->position = ir_find_body(m->ir);
    emit_instructions(m, m->program_end, true);
}
