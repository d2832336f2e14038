/* Gathers, in five ways, and one by one with one lane.
 *
 * By the gather instruction, if one word is read and the indices are in a register. It merges by a mask,
 * which it clears, so the mask is set to all ones each time. The destination is zeroed first to remove its
 * dependency. Sixteen lanes take two instructions of eight. The instruction is microcode on many processors,
 * therefore the other ways:
 *
 * Lane by lane, if the indices are in memory anyway (the vertices of setup).
 *
 * By pairs, if two gathers read neighbouring words with the same indices (texels of a row):
 *
 *   p  a0 b0 a1 b1 | a4 b4 a5 b5          a  a0 a1 a2 a3 | a4 a5 a6 a7
 *   q  a2 b2 a3 b3 | a6 b6 a7 b7    ->    b  b0 b1 b2 b3 | b4 b5 b6 b7
 *
 * By rows, if three or four gathers do (the components of a vertex attribute): one load reads the words of an
 * index, and the rows are transposed within 128-bit parts. No load reads past the last word, because the
 * buffer may end there.
 *
 *   s0  x0 y0 z0 w0 | x4 y4 z4 w4         x  x0 x1 x2 x3 | x4 x5 x6 x7
 *   s1  x1 y1 z1 w1 | x5 ..               y  y0 y1 ..
 *   s2  x2 ..       | x6 ..         ->    z  z0 ..
 *   s3  x3 ..       | x7 ..               w  w0 ..
 *
 * By level, if eight lanes read the words of a texture's level. Most blocks have the same level in all lanes.
 * The code tests this, and reads rows otherwise. */
#include "contract/job.h"
#include "engines/specialize/emit/emit.h"

#include <stddef.h>

enum { ROWS = 4 };

/* A pointer is in the job, or, where an engine's name has the option `addresses`, a literal in the code
 * (engines/specialize/pointers.c). */
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

/* The register with the start of a gather: a base, or rax with the pointer in a field of it. */
static unsigned gather_base(struct emitter *m, const struct ir_instruction *i)
{
    if (i->field == GATHER_DIRECT)
        return emit_base_register[i->base];
    emit_load_pointer(m, i->base, i->field);
    return X86_RAX;
}

static void select_gather_instruction(struct emitter *m, const struct ir_instruction *i)
{
    struct location index = emit_locate(m, i->operand[0]);
    unsigned to = emit_result_register(m);
    unsigned lanes = emit_need_register(m, &index, SCRATCH_FIRST);
    unsigned base = gather_base(m, i);
    encode_rrr(&m->encoder, X86_vpcmpeqd, m->length, SCRATCH_SECOND, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_rrr(&m->encoder, X86_vxorps, m->length, to, to, to);
    encode_gather(&m->encoder, X86_vgatherdps, m->length, to, address_indexed(base, lanes, i->scale, i->k),
                  SCRATCH_SECOND);
}

/* Gathers eight lanes to SCRATCH_RESULT. `indices` is a register below 16. */
static void gather_eight(struct emitter *m, const struct ir_instruction *i, unsigned indices, unsigned base)
{
    struct encoder *e = &m->encoder;
    encode_rrr(e, X86_vpcmpeqd, X86_256, SCRATCH_SECOND, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_rrr(e, X86_vxorps, X86_256, SCRATCH_RESULT, SCRATCH_RESULT, SCRATCH_RESULT);
    encode_gather(e, X86_vgatherdps, X86_256, SCRATCH_RESULT, address_indexed(base, indices, i->scale, i->k),
                  SCRATCH_SECOND);
}

/* Gathers 16 lanes with two instructions. The result must not be in SCRATCH_RESULT. */
static void select_gather_halves(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    struct location index = emit_locate(m, i->operand[0]);
    unsigned to = emit_result_register(m), lanes = emit_need_register(m, &index, SCRATCH_FIRST), low = lanes;
    unsigned base = gather_base(m, i);
    if (lanes > SCRATCH_SECOND) {
        encode_copy(e, X86_512, SCRATCH_FIRST, lanes);
        low = SCRATCH_FIRST;
    }
    gather_eight(m, i, low, base);
    encode_copy(e, X86_512, to, SCRATCH_RESULT);
    encode_rri(e, X86_vextractf64x4, X86_512, SCRATCH_FIRST, lanes, 1);
    gather_eight(m, i, SCRATCH_FIRST, base);
    encode_rrri(e, X86_vinsertf64x4, X86_512, to, to, SCRATCH_RESULT, 1);
}

/* --- From indices in memory ---------------------------------------------------------------------------- */

static bool indices_in_memory(const struct emitter *m, const struct ir_instruction *i)
{
    const struct ir_instruction *index = &m->ir->instruction[i->operand[0]];
    return index->op == IR_load && ir_is_invariant_read(index);
}

/* The address of the indices in memory; they are stored first if they are in a register. */
static struct address indices_of(struct emitter *m, const struct ir_instruction *i)
{
    const struct ir_instruction *index = &m->ir->instruction[i->operand[0]];
    struct location location = emit_locate(m, i->operand[0]);
    struct address lanes = address_at(X86_RSP, m->frame_shift + FRAME_LANES);
    if (indices_in_memory(m, i))
        return address_at(emit_base_register[index->base], index->k);
    encode_mr(&m->encoder, X86_vmovups_store, m->length, lanes,
              emit_need_register(m, &location, SCRATCH_FIRST));
    return lanes;
}

/* Loads four words at [base + index * scale + k] to the low 128 bits of `to`; the indices are words at
 * `lanes`. */
static void gather_four(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                        unsigned base)
{
    for (unsigned lane = 0; lane < 4; lane++, lanes.displacement += 4) {
        unsigned index = lane & 1 ? X86_R13 : X86_R12;
        encode_gpr_rm(&m->encoder, X86_movsxd, X86_64, index, lanes);
        struct address word = address_indexed(base, index, i->scale, i->k);
        if (lane == 0)
            encode_rm(&m->encoder, X86_vmovss, X86_128, to, word);
        else
            encode_rrmi(&m->encoder, X86_vinsertps, X86_128, to, to, word, lane << 4);
    }
}

/* Loads eight words, or four with 4 lanes, to the low bits of `to`. */
static void gather_half(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                        unsigned base)
{
    gather_four(m, to, lanes, i, base);
    if (m->width == 4)
        return;
    lanes.displacement += 16;
    gather_four(m, SCRATCH_SECOND, lanes, i, base);
    encode_rrri(&m->encoder, X86_vinsertf128, X86_256, to, to, SCRATCH_SECOND, 1);
}

static void select_gather_words(struct emitter *m, const struct ir_instruction *i)
{
    struct address lanes = indices_of(m, i);
    unsigned to = emit_result_register(m), base = gather_base(m, i);
    gather_half(m, to, lanes, i, base);
    if (!emit_is_wide(m))
        return;
    lanes.displacement += 32;
    gather_half(m, SCRATCH_FIRST, lanes, i, base);
    encode_rrri(&m->encoder, X86_vinsertf64x4, X86_512, to, to, SCRATCH_FIRST, 1);
}

/* --- By pairs ------------------------------------------------------------------------------------------ */

/* Loads the pairs of two lanes to the low 128 bits of `to`. */
static void load_pairs(struct emitter *m, unsigned to, struct address lanes, const struct ir_instruction *i,
                       unsigned base)
{
    struct address second = lanes;
    second.displacement += 4;
    encode_gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R12, lanes);
    encode_gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R13, second);
    encode_rm(&m->encoder, X86_vmovq, X86_128, to, address_indexed(base, X86_R12, i->scale, i->k));
    encode_rrm(&m->encoder, X86_vmovhps, X86_128, to, to, address_indexed(base, X86_R13, i->scale, i->k));
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
            encode_rrri(&m->encoder, X86_vinsertf128, m->length, part[p], part[p], SCRATCH_FIRST, four);
        }
    }
    encode_rrri(&m->encoder, X86_vshufps, m->length, result[1], part[0], part[1], 0xdd);
    encode_rrri(&m->encoder, X86_vshufps, m->length, part[0], part[0], part[1], 0x88);
    m->selected = m->position + 2;
}

/* --- By rows ------------------------------------------------------------------------------------------- */

/* The number of gathers, from the current one on, that read consecutive words with the same indices into
 * registers of their own; at most ROWS. */
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

/* The first word of a row. Its index is the word at `lane`. */
static struct address row_at(struct emitter *m, struct address lane, const struct ir_instruction *i,
                             unsigned base)
{
    encode_gpr_rm(&m->encoder, X86_movsxd, X86_64, X86_R12, lane);
    return address_indexed(base, X86_R12, i->scale, i->k);
}

/* Loads three or four words to the low 128 bits of `to`. */
static void load_row(struct emitter *m, unsigned to, struct address row, unsigned words)
{
    if (words == 4) {
        encode_rm(&m->encoder, X86_vmovups, X86_128, to, row);
        return;
    }
    encode_rm(&m->encoder, X86_vmovq, X86_128, to, row);
    row.displacement += 8;
    encode_rrmi(&m->encoder, X86_vinsertps, X86_128, to, to, row, 2 << 4);
}

/* Inserts three or four words to 128 bits of `to` above the lowest. */
static void insert_row(struct emitter *m, unsigned to, struct address row, unsigned words, unsigned four)
{
    if (words == 4) {
        encode_rrmi(&m->encoder, X86_vinsertf128, m->length, to, to, row, four);
        return;
    }
    load_row(m, SCRATCH_FIRST, row, words);
    encode_rrri(&m->encoder, X86_vinsertf128, m->length, to, to, SCRATCH_FIRST, four);
}

static void load_rows(struct emitter *m, const unsigned s[ROWS], const struct ir_instruction *i,
                      unsigned words)
{
    struct address lane = indices_of(m, i);
    unsigned base = gather_base(m, i);
    for (unsigned row = 0; row < ROWS; row++, lane.displacement += 4) {
        struct address later = lane;
        load_row(m, s[row], row_at(m, lane, i, base), words);
        for (unsigned four = 1; four < m->width / 4; four++) {
            later.displacement += 16;
            insert_row(m, s[row], row_at(m, later, i, base), words, four);
        }
    }
}

static void interleave(struct emitter *m, enum x86_vector how, unsigned to, unsigned low, unsigned high)
{
    encode_rrr(&m->encoder, how, m->length, to, low, high);
}

/* The registers of the results hold the first rows, and a scratch register the fourth if there are three
 * words. */
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

/* --- Levels -------------------------------------------------------------------------------------------- */

/* Returns true if the words are those of a texture's level (contract/job.h). */
static bool reads_level(const struct ir_instruction *i)
{
    const int32_t first = offsetof(struct job, texture), end = first + sizeof(((struct job *)0)->texture);
    return i->base == BASE_JOB && i->field >= first && i->field < end &&
           (size_t)(i->field - first) % sizeof(struct texture_job) == offsetof(struct texture_job, levels);
}

/* If all lanes have the same level, each word is read once. Otherwise the words are read by rows. */
static void select_gather_level(struct emitter *m, const struct ir_instruction *i, unsigned words)
{
    struct encoder *e = &m->encoder;
    const uint8_t *result = m->allocation->reg + m->position;
    struct location index = emit_locate(m, i->operand[0]);
    unsigned lanes = emit_need_register(m, &index, SCRATCH_FIRST);
    uint32_t differ = encode_add_label(e), done = encode_add_label(e);
    encode_rr(e, X86_vpbroadcastd, X86_256, SCRATCH_SECOND, lanes);
    encode_rrr(e, X86_vpxor, X86_256, SCRATCH_SECOND, SCRATCH_SECOND, lanes);
    encode_rr(e, X86_vptest, X86_256, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_jump_if(e, X86_IF_nz, differ);
    encode_rr(e, X86_vmovd_store, X86_128, X86_R12, lanes);
    encode_gpr_rr(e, X86_movsxd, X86_64, X86_R12, X86_R12);
    unsigned base = gather_base(m, i);
    for (unsigned n = 0; n < words; n++)
        encode_rm(e, X86_vbroadcastss, X86_256, result[n], address_indexed(base, X86_R12, i->scale, i[n].k));
    encode_jump(e, done);
    encode_label(e, differ);
    select_gather_rows(m, i, words);
    encode_label(e, done);
}

/* --- One lane ------------------------------------------------------------------------------------------ */

/* The index is loaded once for all words of a row. */
static void select_gather_lane(struct emitter *m, const struct ir_instruction *i, unsigned words)
{
    struct encoder *e = &m->encoder;
    struct location index = emit_locate(m, i->operand[0]);
    unsigned base = gather_base(m, i);
    if (index.reg == NO_REGISTER)
        encode_gpr_rm(e, X86_movsxd, X86_64, X86_R12, index.address);
    else {
        encode_rr(e, X86_vmovd_store, X86_128, X86_R12, index.reg);
        encode_gpr_rr(e, X86_movsxd, X86_64, X86_R12, X86_R12);
    }
    for (unsigned n = 0; n < words; n++)
        encode_rm(e, X86_vmovss, X86_128, m->allocation->reg[m->position + n],
                  address_indexed(base, X86_R12, i->scale, i[n].k));
    m->selected = m->position + words;
}

/* The number of words that are gathered together, and not by rules that are left out. */
static unsigned words_together(struct emitter *m, const struct ir_instruction *i)
{
    unsigned words = row_length(m, i);
    if (words > 2 && !emit_applies(m, PEEPHOLE_rows))
        words = 2;
    return words == 2 && !emit_applies(m, PEEPHOLE_pairs) ? 1 : words;
}

void emit_gather(struct emitter *m, const struct ir_instruction *i)
{
    unsigned words = words_together(m, i);
    if (emit_is_scalar(m))
        select_gather_lane(m, i, words ? words : 1);
    else if (words > 2 && m->width == 8 && reads_level(i) && emit_applies(m, PEEPHOLE_level))
        select_gather_level(m, i, words);
    else if (words > 2)
        select_gather_rows(m, i, words);
    else if (words == 2)
        select_gather_pairs(m, i);
    else if ((indices_in_memory(m, i) && emit_applies(m, PEEPHOLE_indices)) ||
             (emit_is_wide(m) && emit_result_register(m) == SCRATCH_RESULT))
        select_gather_words(m, i);
    else if (emit_is_wide(m))
        select_gather_halves(m, i);
    else
        select_gather_instruction(m, i);
}
