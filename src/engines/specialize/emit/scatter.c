/* Scatters: each lane stores a word to its own record.
 *
 * A single scatter extracts and stores lane by lane. If the following scatters store neighbouring words of
 * the same records, up to four registers are transposed within 128-bit parts first, and one store writes all
 * of a record's words:
 *
 *   a  a0 a1 a2 a3 | a4 ..          a0 b0 c0 d0 | a4 b4 c4 d4
 *   b  b0 b1 ..            ->       a1 b1 c1 d1 | a5 ..
 *   c  c0 c1 ..                     a2 b2 ..
 *   d  d0 d1 ..                     a3 b3 ..
 *
 * Three words are stored as four if the fourth is certainly overwritten later. With one lane, each word is
 * stored by itself. */
#include "engines/specialize/emit/emit.h"

enum { ROW = 4 };

static void scatter_four(struct emitter *m, unsigned from, struct address to, int32_t stride)
{
    encode_mr(&m->encoder, X86_vmovss_store, X86_128, to, from);
    for (unsigned lane = 1; lane < 4; lane++) {
        to.displacement += stride;
        encode_mri(&m->encoder, X86_vextractps, X86_128, to, from, lane);
    }
}

static void scatter_words(struct emitter *m, const struct ir_instruction *i)
{
    struct location value = emit_locate(m, i->operand[0]);
    unsigned from = emit_need_register(m, &value, SCRATCH_FIRST);
    struct address to = address_at(emit_base_register[i->base], i->k);
    if (emit_is_scalar(m)) {
        encode_mr(&m->encoder, X86_vmovss_store, X86_128, to, from);
        return;
    }
    scatter_four(m, from, to, i->field);
    for (unsigned four = 1; four < m->width / 4; four++) {
        to.displacement += 4 * i->field;
        encode_rri(&m->encoder, X86_vextractf128, m->length, SCRATCH_SECOND, from, four);
        scatter_four(m, SCRATCH_SECOND, to, i->field);
    }
}

/* The number of scatters, from the current one on, that store consecutive words of the same records; at most
 * ROW. */
static unsigned row_length(const struct emitter *m, const struct ir_instruction *first)
{
    unsigned n = 1;
    for (; n < ROW && m->position + n < m->ir->count; n++) {
        const struct ir_instruction *i = first + n;
        if (i->op != IR_scatter || i->base != first->base || i->field != first->field ||
            i->k != first->k + 4 * (int32_t)n)
            break;
    }
    return n;
}

/* Returns true if a later instruction of this region stores the word at `k` of the records. */
static bool is_stored_later(const struct emitter *m, const struct ir_instruction *first, int32_t k)
{
    for (uint32_t n = m->position + 1; n < m->ir->count; n++) {
        const struct ir_instruction *i = &m->ir->instruction[n];
        if (ir_properties(i) & (IR_OPENS | IR_CLOSES))
            return false;
        if (i->op == IR_scatter && i->base == first->base && i->field == first->field && i->k == k)
            return true;
    }
    return false;
}

/* Interleaves the values of two scatters with the instruction `how`. Values in memory are loaded to `to` and
 * another scratch register. */
static void interleave(struct emitter *m, enum x86_vector how, unsigned to, const struct ir_instruction *low,
                       const struct ir_instruction *high)
{
    struct location a = emit_locate(m, low->operand[0]), b = emit_locate(m, high->operand[0]);
    unsigned left = emit_need_register(m, &a, SCRATCH_RESULT);
    encode_rrr(&m->encoder, how, m->length, to, left, emit_need_register(m, &b, to));
}

/* Stores the 128-bit parts of a register: the rows of lanes `lane`, `lane` + 4 and so on. */
static void store_rows(struct emitter *m, const struct ir_instruction *i, unsigned rows, unsigned lane)
{
    struct address to = address_at(emit_base_register[i->base], i->k + i->field * (int32_t)lane);
    encode_mr(&m->encoder, X86_vmovups_store, X86_128, to, rows);
    for (unsigned four = 1; four < m->width / 4; four++) {
        to.displacement += 4 * i->field;
        encode_mri(&m->encoder, X86_vextractf128, m->length, to, rows, four);
    }
}

static void scatter_rows(struct emitter *m, const struct ir_instruction *i, unsigned words)
{
    static const enum x86_vector halves[] = {X86_vunpcklps, X86_vunpckhps};
    const struct ir_instruction *fourth = i + (words < ROW ? 2 : 3);
    for (unsigned half = 0; half < 2; half++) {
        interleave(m, halves[half], SCRATCH_FIRST, i, i + 1);
        interleave(m, halves[half], SCRATCH_SECOND, i + 2, fourth);
        encode_rrr(&m->encoder, X86_vpunpcklqdq, m->length, SCRATCH_RESULT, SCRATCH_FIRST, SCRATCH_SECOND);
        store_rows(m, i, SCRATCH_RESULT, 2 * half);
        encode_rrr(&m->encoder, X86_vpunpckhqdq, m->length, SCRATCH_RESULT, SCRATCH_FIRST, SCRATCH_SECOND);
        store_rows(m, i, SCRATCH_RESULT, 2 * half + 1);
    }
}

static void scatter_pairs(struct emitter *m, const struct ir_instruction *i)
{
    static const enum x86_vector halves[] = {X86_vunpcklps, X86_vunpckhps};
    for (unsigned half = 0; half < 2; half++) {
        struct address to = address_at(emit_base_register[i->base], i->k + i->field * 2 * (int32_t)half);
        interleave(m, halves[half], SCRATCH_FIRST, i, i + 1);
        for (unsigned four = 0; four < m->width / 4; four++, to.displacement += 4 * i->field) {
            struct address second = to;
            unsigned pairs = four ? SCRATCH_SECOND : SCRATCH_FIRST;
            second.displacement += i->field;
            if (four)
                encode_rri(&m->encoder, X86_vextractf128, m->length, pairs, SCRATCH_FIRST, four);
            encode_mr(&m->encoder, X86_vmovq_store, X86_128, to, pairs);
            encode_mr(&m->encoder, X86_vmovhps_store, X86_128, second, pairs);
        }
    }
}

/* Records may overlap: if they are closer than a row, words are written in the order of the operations. */
void emit_scatter(struct emitter *m, const struct ir_instruction *i)
{
    unsigned words = row_length(m, i);
    if (words == 3 && !is_stored_later(m, i, i->k + 12))
        words = 2;
    if (i->field < 4 * ROW || emit_is_scalar(m) || (words > 1 && !emit_applies(m, PEEPHOLE_scatter)))
        words = 1;
    m->selected = m->position + words;
    if (words > 2)
        scatter_rows(m, i, words);
    else if (words == 2)
        scatter_pairs(m, i);
    else
        scatter_words(m, i);
}
