/* Gathers, in four ways.
 *
 * The instruction, where one word is wanted and the indices are in a register: it merges by mask, all ones,
 * rebuilt each time since it is cleared; the destination is zeroed first to cut its dependency. On many
 * processors it is microcode, so:
 *
 * Lane by lane, where the indices lie in memory anyway (setup's vertices). Sixteen lanes are two instructions of eight.
 *
 * By pairs, where two neighbouring words of the same places follow one another (texels of a row):
 *
 *   p  a0 b0 a1 b1 | a4 b4 a5 b5          a  a0 a1 a2 a3 | a4 a5 a6 a7
 *   q  a2 b2 a3 b3 | a6 b6 a7 b7    ->    b  b0 b1 b2 b3 | b4 b5 b6 b7
 *
 * By rows, where three or four do (a vertex attribute's components): each place is loaded once, whole, and the
 * rows are transposed within 128-bit halves. Nothing is read past the last word: a buffer may end there.
 *
 *   s0  x0 y0 z0 w0 | x4 y4 z4 w4         x  x0 x1 x2 x3 | x4 x5 x6 x7
 *   s1  x1 y1 z1 w1 | x5 ..               y  y0 y1 ..
 *   s2  x2 ..       | x6 ..         ->    z  z0 ..
 *   s3  x3 ..       | x7 ..               w  w0 ..                                                         */
#include "jit/emit.h"

enum { ROWS = 4 };

/* The start of a gather in a register: a base, or the pointer in one of its fields, in rax. */
static unsigned gather_base(struct emitter *m, const struct ir_instruction *i)
{
    unsigned base = base_register[i->base];
    if (i->field == GATHER_DIRECT)
        return base;
    gpr_rm(&m->encoder, X86_mov, X86_64, X86_RAX, address_at(base, i->field));
    return X86_RAX;
}

static void select_gather_instruction(struct emitter *m, const struct ir_instruction *i)
{
    struct place index = place_of(m, i->operand[0]);
    unsigned to = result_register(m);
    unsigned lanes = need_register(m, &index, SCRATCH_FIRST);
    unsigned base = gather_base(m, i);
    vector_rrr(&m->encoder, X86_vpcmpeqd, m->length, SCRATCH_SECOND, SCRATCH_SECOND, SCRATCH_SECOND);
    vector_rrr(&m->encoder, X86_vxorps, m->length, to, to, to);
    vector_gather(&m->encoder, X86_vgatherdps, m->length, to, address_indexed(base, lanes, i->scale, i->k),
                  SCRATCH_SECOND);
}

/* Eight lanes of `indices`, a register below 16, to SCRATCH_RESULT. */
static void gather_eight(struct emitter *m, const struct ir_instruction *i, unsigned indices, unsigned base)
{
    struct encoder *e = &m->encoder;
    vector_rrr(e, X86_vpcmpeqd, X86_256, SCRATCH_SECOND, SCRATCH_SECOND, SCRATCH_SECOND);
    vector_rrr(e, X86_vxorps, X86_256, SCRATCH_RESULT, SCRATCH_RESULT, SCRATCH_RESULT);
    vector_gather(e, X86_vgatherdps, X86_256, SCRATCH_RESULT, address_indexed(base, indices, i->scale, i->k),
                  SCRATCH_SECOND);
}

/* The instruction twice, for 16 lanes, whose result is not in SCRATCH_RESULT. */
static void select_gather_halves(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct place index = place_of(m, i->operand[0]);
    unsigned to = result_register(m), lanes = need_register(m, &index, SCRATCH_FIRST), low = lanes;
    unsigned base = gather_base(m, i);
    if (lanes > SCRATCH_SECOND) {
        vector_copy(e, X86_512, SCRATCH_FIRST, lanes);
        low = SCRATCH_FIRST;
    }
    gather_eight(m, i, low, base);
    vector_copy(e, X86_512, to, SCRATCH_RESULT);
    vector_rri(e, X86_vextractf64x4, X86_512, SCRATCH_FIRST, lanes, 1);
    gather_eight(m, i, SCRATCH_FIRST, base);
    vector_rrri(e, X86_vinsertf64x4, X86_512, to, to, SCRATCH_RESULT, 1);
}

/* --- From indices in memory --------------------------------------------------------------------------------
 */

static int indices_in_memory(const struct emitter *m, const struct ir_instruction *i)
{
    const struct ir_instruction *index = &m->ir->instruction[i->operand[0]];
    return index->op == IR_load && ir_is_invariant_read(index);
}

/* Where the indices are in memory: stored if they are not there. */
static struct address indices_of(struct emitter *m, const struct ir_instruction *i)
{
    const struct ir_instruction *index = &m->ir->instruction[i->operand[0]];
    struct place place = place_of(m, i->operand[0]);
    struct address lanes = address_at(X86_RSP, FRAME_LANES);
    if (indices_in_memory(m, i))
        return address_at(base_register[index->base], index->k);
    vector_mr(&m->encoder, X86_vmovups_store, m->length, lanes, need_register(m, &place, SCRATCH_FIRST));
    return lanes;
}

/* Four words at [base + index * scale + k] into the low half of `to`, the indices being words at `lanes`. */
static void gather_four(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                        unsigned base)
{
    for (unsigned lane = 0; lane < 4; lane++, lanes.displacement += 4) {
        unsigned index = lane & 1 ? X86_R13 : X86_R12;
        gpr_rm(&m->encoder, X86_movsxd, X86_64, index, lanes);
        struct address word = address_indexed(base, index, i->scale, i->k);
        if (lane == 0)
            vector_rm(&m->encoder, X86_vmovss, X86_128, to, word);
        else
            vector_rrmi(&m->encoder, X86_vinsertps, X86_128, to, to, word, lane << 4);
    }
}

/* Eight words, or four, into the low half of `to`. */
static void gather_half(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                        unsigned base)
{
    gather_four(m, to, lanes, i, base);
    if (m->width == 4)
        return;
    lanes.displacement += 16;
    gather_four(m, SCRATCH_SECOND, lanes, i, base);
    vector_rrri(&m->encoder, X86_vinsertf128, X86_256, to, to, SCRATCH_SECOND, 1);
}

static void select_gather_words(struct emitter *m, const struct ir_instruction *i)
{
    struct address lanes = indices_of(m, i);
    unsigned to = result_register(m), base = gather_base(m, i);
    gather_half(m, to, lanes, i, base);
    if (!is_wide(m))
        return;
    lanes.displacement += 32;
    gather_half(m, SCRATCH_FIRST, lanes, i, base);
    vector_rrri(&m->encoder, X86_vinsertf64x4, X86_512, to, to, SCRATCH_FIRST, 1);
}

/* --- By pairs ----------------------------------------------------------------------------------------------
 */

/* The pairs of two lanes into the low half of `to`. */
static void load_pairs(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                       unsigned base)
{
    struct address second = lanes;
    second.displacement += 4;
    gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R12, lanes);
    gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R13, second);
    vector_rm(&m->encoder, X86_vmovq, X86_128, to, address_indexed(base, X86_R12, i->scale, i->k));
    vector_rrm(&m->encoder, X86_vmovhps, X86_128, to, to, address_indexed(base, X86_R13, i->scale, i->k));
}

static void select_gather_pairs(struct emitter *m, const struct ir_instruction *i)
{
    const uint8_t *result = m->allocation->reg + m->position;
    const unsigned part[2] = {result[0], SCRATCH_SECOND};
    struct address lanes = indices_of(m, i);
    unsigned base = gather_base(m, i);
    for (int p = 0; p < 2; p++, lanes.displacement += 8) {
        struct address later = lanes;
        load_pairs(m, part[p], lanes, i, base);
        for (unsigned four = 1; four < m->width / 4; four++) {
            later.displacement += 16;
            load_pairs(m, SCRATCH_FIRST, later, i, base);
            vector_rrri(&m->encoder, X86_vinsertf128, m->length, part[p], part[p], SCRATCH_FIRST, four);
        }
    }
    vector_rrri(&m->encoder, X86_vshufps, m->length, result[1], part[0], part[1], 0xdd);
    vector_rrri(&m->encoder, X86_vshufps, m->length, part[0], part[0], part[1], 0x88);
    m->selected = m->position + 2;
}

/* --- By rows -----------------------------------------------------------------------------------------------
 */

/* How many gathers from the current one on read consecutive words of the same places, into registers of their
 * own. */
static unsigned row_length(const struct emitter *m, const struct ir_instruction *first)
{
    const struct allocation *a = m->allocation;
    unsigned n = 0, used = 0;
    for (; n < ROWS && m->position + n < m->ir->count; n++) {
        const struct ir_instruction *i = first + n;
        unsigned reg = a->reg[m->position + n];
        if (i->op != IR_gather || i->operand[0] != first->operand[0] || i->base != first->base ||
            i->field != first->field || i->scale != first->scale || i->k != first->k + 4 * (int32_t)n)
            break;
        if (a->residence[m->position + n] != RESIDENCE_REGISTER || reg == SCRATCH_RESULT || used >> reg & 1)
            break;
        used |= 1u << reg;
    }
    return n;
}

/* `words` of one place, whose index is the word at `lane`, into the low half of `to`. */
static void load_row(struct emitter *m, unsigned to, struct address lane, const struct ir_instruction *i,
                     unsigned words, unsigned base)
{
    gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R12, lane);
    struct address row = address_indexed(base, X86_R12, i->scale, i->k);
    if (words == 4) {
        vector_rm(&m->encoder, X86_vmovups, X86_128, to, row);
        return;
    }
    vector_rm(&m->encoder, X86_vmovq, X86_128, to, row);
    row.displacement += 8;
    vector_rrmi(&m->encoder, X86_vinsertps, X86_128, to, to, row, 2 << 4);
}

static void load_rows(struct emitter *m, const unsigned s[ROWS], const struct ir_instruction *i,
                      unsigned words)
{
    struct address lane = indices_of(m, i);
    unsigned base = gather_base(m, i);
    for (unsigned row = 0; row < ROWS; row++, lane.displacement += 4) {
        struct address later = lane;
        load_row(m, s[row], lane, i, words, base);
        for (unsigned four = 1; four < m->width / 4; four++) {
            later.displacement += 16;
            load_row(m, SCRATCH_FIRST, later, i, words, base);
            vector_rrri(&m->encoder, X86_vinsertf128, m->length, s[row], s[row], SCRATCH_FIRST, four);
        }
    }
}

static void interleave(struct emitter *m, enum x86_vector how, unsigned to, unsigned low, unsigned high)
{
    vector_rrr(&m->encoder, how, m->length, to, low, high);
}

/* The results' registers hold the first rows, scratch registers the others. */
static void select_gather_rows(struct emitter *m, const struct ir_instruction *i, unsigned words)
{
    const uint8_t *r = m->allocation->reg + m->position;
    unsigned s[ROWS] = {r[0], r[1], r[2], words > 3 ? r[3] : SCRATCH_RESULT};
    load_rows(m, s, i, words);
    interleave(m, X86_vunpcklps, SCRATCH_FIRST, s[0], s[1]);
    interleave(m, X86_vunpcklps, SCRATCH_SECOND, s[2], s[3]);
    interleave(m, X86_vunpckhps, r[0], s[0], s[1]);
    interleave(m, X86_vunpckhps, SCRATCH_RESULT, s[2], s[3]);
    interleave(m, X86_vpunpcklqdq, r[2], r[0], SCRATCH_RESULT);
    if (words == 4)
        interleave(m, X86_vpunpckhqdq, r[3], r[0], SCRATCH_RESULT);
    interleave(m, X86_vpunpcklqdq, r[0], SCRATCH_FIRST, SCRATCH_SECOND);
    interleave(m, X86_vpunpckhqdq, r[1], SCRATCH_FIRST, SCRATCH_SECOND);
    m->selected = m->position + words;
}

void select_gather(struct emitter *m, const struct ir_instruction *i)
{
    unsigned words = row_length(m, i);
    if (words > 2)
        select_gather_rows(m, i, words);
    else if (words == 2)
        select_gather_pairs(m, i);
    else if (indices_in_memory(m, i) || (is_wide(m) && result_register(m) == SCRATCH_RESULT))
        select_gather_words(m, i);
    else if (is_wide(m))
        select_gather_halves(m, i);
    else
        select_gather_instruction(m, i);
}
