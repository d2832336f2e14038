/* The loops of stretched rows (passes/span/stretch.c).
 *
 * After the columns of a triangle, its first run has entries for pairs of columns of blocks: the values of
 * both, and the places of their eight texels from the least x on, if all are below 8. A pair whose texels are
 * further apart has their indices instead, and FAR as its least x: they are gathered. The seam of a repeated
 * texture is in one such pair, or in two. With more, the triangle has no stretched rows.
 *
 * Two rows of pixels, p and q, need four rows of texels: `upper` and `lower` of each. For each of them a
 * chunk has the number of a slot with the stretched row. The search for it compares addresses of rows of
 * texels with those that were found just before:
 *
 *   upper p   the rows of the last q
 *   lower p   the same
 *   upper q   the rows of p
 *   lower q   the same, and the upper row of q
 *
 * If none is the same, the row is stretched into a slot that no chunk needs any more, for all pairs of the
 * triangle's first run. There is one slot more than rows. If the rows of texels are further apart than the
 * rows of pixels, the loop of blocks needs less. It is used if p and q have no row in common, or if p has
 * none of the last chunk. */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"
#include "ir/near.h"

enum {
    LANE_BYTES = 32, /* of a value */
    BLOCK_BYTES = 4 * BLOCK_PIXELS,
    ENTRY_COLORS = BLOCK_BYTES / sizeof(struct entry),
    PAIRS = TILE_SIZE / BLOCK_SIZE / 2,
    SLOTS = STRETCH_NEEDS + 1,
    REACH = 8, /* texels that a load gives */
    FAR = -1,
    FAR_PAIRS = 2,         /* the most of a triangle */
    SECOND_COLUMNS = 0xcc, /* the lanes of the second block of a pair */
    PAIR_BYTES = 2 * sizeof(struct entry)
};

/* The rows of texels of a chunk, in the order of their addresses in the row's entry. */
enum need { UPPER_P, UPPER_Q, LOWER_P, LOWER_Q };

/* The part of the frame: the addresses of the last chunk's rows of texels; the offsets in the frame of their
 * slots, and of the slot that was stretched last; of the pairs: the entry of the first one's first column (0:
 * there are none), the bytes of colours that they cover with the block that may follow, and the end of their
 * entries; where a run has no pair left. */
enum {
    TAGS = 0,
    CHOSEN = 32,
    LATEST = 48,
    PAIRS_COLUMN = 56,
    PAIRS_BYTES = 64,
    PAIRS_END = 72,
    PAIRS_LIMIT = 80,
    PAIR_ENTRIES = 96
};

static const uint8_t stretched_row[STRETCH_NEEDS] = {
    [UPPER_P] = X86_R12, [UPPER_Q] = X86_R13, [LOWER_P] = X86_R10, [LOWER_Q] = X86_RCX};

static_assert(PAIR_ENTRIES % LANE_BYTES == 0, "entries are aligned");

static struct address frame(const struct emitter *m, int32_t offset)
{
    return emit_frame_at(m->frame_stretch + offset);
}

static int32_t row_step(const struct emitter *m)
{
    return (int32_t)m->ir->stretch_words * LANE_BYTES;
}

static int32_t slot_bytes(const struct emitter *m)
{
    return PAIRS * row_step(m);
}

static int32_t first_slot(const struct emitter *m)
{
    return m->frame_stretch + PAIR_ENTRIES + PAIRS * emit_column_bytes(m);
}

int32_t emit_stretch_bytes(const struct emitter *m)
{
    return m->ir->stretch_words ? PAIR_ENTRIES + PAIRS * emit_column_bytes(m) + SLOTS * slot_bytes(m) : 0;
}

static const struct ir_instruction *loop_of(const struct emitter *m, enum ir_loop kind)
{
    return &m->ir->instruction[emit_find_loop(m->ir, kind)];
}

static unsigned noted_column(const struct emitter *m)
{
    return ir_near_column(loop_of(m, IR_LOOP_STRETCH)->field);
}

/* --- Pairs of columns ----------------------------------------------------------------------------------- */

/* Loads a word of the columns at r12, the first lanes of both blocks: columns 0 1 4 5 2 3 6 7 of the pair. */
static void load_pair(struct emitter *m, unsigned to, int32_t word)
{
    encode_rm(&m->encoder, X86_vmovups, X86_256, to, address_at(X86_R12, word));
    encode_rrmi(&m->encoder, X86_vpblendd, X86_256, to, to, address_at(X86_R12, emit_column_bytes(m) + word),
                SECOND_COLUMNS);
}

static unsigned texel_bytes(const struct emitter *m)
{
    const struct ir_instruction *i = loop_of(m, IR_LOOP_STRETCH);
    while (i->op != IR_stretch)
        i++;
    return i->scale;
}

/* Jumps to `other` unless all places are among the texels of a load; of bytes their right neighbours, too.
 * The places of bytes become the four bytes that each lane takes. */
static void require_reach(struct emitter *m, unsigned places, uint32_t other)
{
    enum { BYTES = 0x03020100, EACH = 0x01010101 };
    struct encoder *e = &m->encoder;
    const bool bytes = texel_bytes(m) == 1;
    unsigned furthest = places;
    if (bytes) {
        furthest = SCRATCH_RESULT;
        encode_rrm(e, X86_vpaddd, X86_256, furthest, places, emit_literal_address(m, 1, LITERAL_LANES));
    }
    encode_rm(e, X86_vptest, X86_256, furthest, emit_literal_address(m, -REACH, LITERAL_LANES));
    encode_jump_if(e, X86_IF_nz, other);
    if (!bytes)
        return;
    encode_rrm(e, X86_vpmulld, X86_256, places, places, emit_literal_address(m, EACH, LITERAL_LANES));
    encode_rrm(e, X86_vpaddd, X86_256, places, places, emit_literal_address(m, BYTES, LITERAL_LANES));
}

/* Stores the least x of a pair, and the places from there on; or FAR and the indices, which counts down
 * LANES. Jumps to `other` if there are too many of these. */
static void store_places(struct emitter *m, uint32_t other)
{
    struct encoder *e = &m->encoder;
    const unsigned column = noted_column(m);
    uint32_t far = encode_add_label(e), done = encode_add_label(e);
    load_pair(m, SCRATCH_FIRST, loop_of(m, IR_LOOP_PAIRS)->field);
    emit_find_least(m, SCRATCH_SECOND, SCRATCH_FIRST, SCRATCH_RESULT);
    encode_rr(e, X86_vmovd_store, X86_128, X86_RAX, SCRATCH_SECOND);
    encode_rrr(e, X86_vpsubd, X86_256, SCRATCH_SECOND, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_gpr_rr(e, X86_test, X86_32, X86_RAX, X86_RAX);
    encode_jump_if(e, X86_IF_s, far);
    require_reach(m, SCRATCH_SECOND, far);
    encode_copy(e, X86_256, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_jump(e, done);
    encode_label(e, far);
    encode_gpr_ri(e, X86_sub, X86_32, LANES, 1);
    encode_jump_if(e, X86_IF_s, other);
    encode_gpr_ri(e, X86_or, X86_32, X86_RAX, FAR);
    encode_label(e, done);
    encode_mr(e, X86_vmovups_store, X86_256, address_at(STRETCHED, emit_near_places(m, column)),
              SCRATCH_FIRST);
    encode_gpr_mr(e, X86_mov, X86_32, address_at(STRETCHED, emit_near_first(m, column)), X86_RAX);
}

/* Stores the words of a pair that the loop stretch reads. */
static void store_words(struct emitter *m)
{
    const struct ir_instruction *i = loop_of(m, IR_LOOP_STRETCH);
    for (i++; i->op != IR_again; i++) {
        if (i->op != IR_load)
            continue;
        load_pair(m, SCRATCH_FIRST, i->k);
        encode_mr(&m->encoder, X86_vmovups_store, X86_256, address_at(STRETCHED, i->k), SCRATCH_FIRST);
    }
}

/* Finds the first run of the triangle at ENTRY: the address of its first column in r12, and the end of the
 * entries of its pairs. Jumps to `other` if it has none. */
static void find_pairs(struct emitter *m, uint32_t other)
{
    struct encoder *e = &m->encoder;
    emit_find_run(m);
    encode_gpr_rr(e, X86_sub, X86_64, X86_R12, ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_NONE, X86_R12, ENTRY_COLORS, 0));
    encode_gpr_ri(e, X86_or, X86_64, X86_RAX, BLOCK_BYTES);
    encode_gpr_mr(e, X86_mov, X86_64, frame(m, PAIRS_BYTES), X86_RAX);
    encode_gpr_ri(e, X86_shr, X86_32, X86_R12, __builtin_ctz(PAIR_BYTES));
    encode_jump_if(e, X86_IF_z, other);
    encode_gpr_rri(e, X86_imul_immediate, X86_32, X86_RAX, X86_R12, emit_column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, X86_R13,
                  address_indexed(X86_RSP, X86_RAX, 1, m->frame_stretch + PAIR_ENTRIES));
    encode_gpr_mr(e, X86_mov, X86_64, frame(m, PAIRS_END), X86_R13);
    encode_gpr_rm(e, X86_movzx16, X86_32, X86_RAX, address_at(ENTRY, offsetof(struct entry, block)));
    encode_gpr_ri(e, X86_and, X86_32, X86_RAX, TILE_SIZE / BLOCK_SIZE - 1);
    encode_gpr_rri(e, X86_imul_immediate, X86_32, X86_RAX, X86_RAX, emit_column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, X86_R12, address_indexed(X86_RSP, X86_RAX, 1, m->frame_columns));
}

/* No row of texels is stretched. None is at address 0. */
static void forget_rows(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_rrr(e, X86_vpxor, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_FIRST);
    encode_mr(e, X86_vmovups_store, X86_256, frame(m, TAGS), SCRATCH_FIRST);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_at(X86_NONE, first_slot(m)));
    for (int32_t word = CHOSEN; word <= LATEST; word += 4)
        encode_gpr_mr(e, X86_mov, X86_32, frame(m, word), X86_RAX);
}

void emit_pair_columns(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    if (!m->ir->stretch_words)
        return;
    uint32_t next = encode_add_label(e), done = encode_add_label(e);
    encode_gpr_mi(e, X86_mov, X86_64, frame(m, PAIRS_COLUMN), 0);
    find_pairs(m, done);
    encode_gpr_rr(e, X86_mov, X86_64, COLUMN, X86_R12);
    encode_gpr_rm(e, X86_lea, X86_64, STRETCHED, frame(m, PAIR_ENTRIES));
    encode_gpr_rm(e, X86_lea, X86_64, LANES, address_at(X86_NONE, FAR_PAIRS));
    encode_label(e, next);
    store_places(m, done);
    store_words(m);
    encode_gpr_ri(e, X86_add, X86_64, X86_R12, 2 * emit_column_bytes(m));
    encode_gpr_ri(e, X86_add, X86_64, STRETCHED, emit_column_bytes(m));
    encode_gpr_rr(e, X86_cmp, X86_64, STRETCHED, X86_R13);
    encode_jump_if(e, X86_IF_b, next);
    encode_gpr_mr(e, X86_mov, X86_64, frame(m, PAIRS_COLUMN), COLUMN);
    forget_rows(m);
    encode_label(e, done);
}

/* --- The rows of a chunk -------------------------------------------------------------------------------- */

static struct address texels_of(const struct emitter *m, enum need need)
{
    const unsigned row = ir_near_row(loop_of(m, IR_LOOP_STRETCH)->field, 0);
    return address_at(ROW, emit_texel_row(m, row, 0) + 8 * (int32_t)need);
}

static struct address chosen(const struct emitter *m, enum need need)
{
    return frame(m, CHOSEN + 4 * (int32_t)need);
}

/* Jumps to the loop of blocks unless the run has the columns of the pairs, and at least one pair. */
static void require_columns(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_cmp, X86_64, COLUMN, frame(m, PAIRS_COLUMN));
    encode_jump_if(e, X86_IF_nz, m->stretch.usual);
    encode_gpr_rr(e, X86_mov, X86_64, X86_RAX, ENTRY);
    encode_gpr_rr(e, X86_sub, X86_64, X86_RAX, COLOR);
    encode_gpr_ri(e, X86_cmp, X86_64, X86_RAX, 2 * BLOCK_BYTES);
    encode_jump_if(e, X86_IF_b, m->stretch.usual);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, frame(m, PAIRS_BYTES));
    encode_jump_if(e, X86_IF_nbe, m->stretch.usual);
}

/* The same unless q has one of p's rows: its upper one, or if the image is upside down its lower one. */
static void require_rows(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t done = encode_add_label(e);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, texels_of(m, UPPER_P));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, texels_of(m, UPPER_Q));
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, texels_of(m, LOWER_Q));
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, texels_of(m, LOWER_P));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, texels_of(m, UPPER_Q));
    encode_jump_if(e, X86_IF_nz, m->stretch.usual);
    encode_label(e, done);
}

/* The same unless p has a row of the last chunk, or this chunk is the first one of the triangle. */
static void require_last_rows(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t done = encode_add_label(e);
    encode_gpr_mi(e, X86_cmp, X86_64, frame(m, TAGS), 0);
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, texels_of(m, LOWER_P));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, frame(m, TAGS + 8 * UPPER_Q));
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, frame(m, TAGS + 8 * LOWER_Q));
    encode_jump_if(e, X86_IF_nz, m->stretch.usual);
    encode_label(e, done);
}

/* A row that may have been found already; of the last chunk its address is among the tags. */
struct candidate {
    uint8_t need;
    bool last;
};

/* The slot of a row of texels: that of a candidate, or one that is computed with the row's address in r12 and
 * the need's number in r13. */
static void find_row(struct emitter *m, enum need need, const struct candidate *candidates, unsigned count,
                     uint32_t compute)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_64, X86_R12, texels_of(m, need));
    for (unsigned c = 0; c < count; c++) {
        const enum need other = (enum need)candidates[c].need;
        encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, chosen(m, other));
        encode_gpr_rm(e, X86_cmp, X86_64, X86_R12,
                      candidates[c].last ? frame(m, TAGS + 8 * (int32_t)other) : texels_of(m, other));
        encode_jump_if(e, X86_IF_z, m->stretch.found[need]);
    }
    if (need == UPPER_P)
        require_last_rows(m);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R13, address_at(X86_NONE, (int32_t)need));
    encode_jump(e, compute);
    encode_label(e, m->stretch.found[need]);
    encode_gpr_mr(e, X86_mov, X86_32, chosen(m, need), X86_RAX);
}

static void find_rows(struct emitter *m, uint32_t compute)
{
    static const struct candidate upper_p[] = {{UPPER_Q, true}, {LOWER_Q, true}},
                                  lower_p[] = {{LOWER_Q, true}, {UPPER_Q, true}},
                                  upper_q[] = {{UPPER_P, false}, {LOWER_P, false}},
                                  lower_q[] = {{LOWER_P, false}, {UPPER_P, false}, {UPPER_Q, false}};
    find_row(m, UPPER_P, upper_p, 2, compute);
    find_row(m, LOWER_P, lower_p, 2, compute);
    find_row(m, UPPER_Q, upper_q, 2, compute);
    find_row(m, LOWER_Q, lower_q, 3, compute);
    encode_rm(&m->encoder, X86_vmovups, X86_256, SCRATCH_FIRST, texels_of(m, UPPER_P));
    encode_mr(&m->encoder, X86_vmovups_store, X86_256, frame(m, TAGS), SCRATCH_FIRST);
}

/* Takes the next slot that none of a chunk's needs has: its address becomes STRETCHED. */
static void take_slot(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t next = encode_add_label(e), within = encode_add_label(e);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, frame(m, LATEST));
    encode_label(e, next);
    encode_gpr_ri(e, X86_add, X86_32, X86_RAX, slot_bytes(m));
    encode_gpr_ri(e, X86_cmp, X86_32, X86_RAX, first_slot(m) + SLOTS * slot_bytes(m));
    encode_jump_if(e, X86_IF_b, within);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_at(X86_NONE, first_slot(m)));
    encode_label(e, within);
    encode_rr(e, X86_vmovd, X86_128, SCRATCH_FIRST, X86_RAX);
    encode_rr(e, X86_vpbroadcastd, X86_128, SCRATCH_FIRST, SCRATCH_FIRST);
    encode_rrm(e, X86_vpcmpeqd, X86_128, SCRATCH_FIRST, SCRATCH_FIRST, frame(m, CHOSEN));
    encode_rr(e, X86_vptest, X86_128, SCRATCH_FIRST, SCRATCH_FIRST);
    encode_jump_if(e, X86_IF_nz, next);
    encode_gpr_mr(e, X86_mov, X86_32, frame(m, LATEST), X86_RAX);
    encode_gpr_rm(e, X86_lea, X86_64, STRETCHED, address_indexed(X86_RSP, X86_RAX, 1, 0));
}

void emit_open_stretch(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t compute = encode_add_label(e);
    m->stretch.done = encode_add_label(e);
    m->stretch.usual = encode_add_label(e);
    m->stretch.end = encode_add_label(e);
    for (unsigned need = 0; need < STRETCH_NEEDS; need++)
        m->stretch.found[need] = encode_add_label(e);
    require_columns(m);
    require_rows(m);
    find_rows(m, compute);
    encode_jump(e, m->stretch.done);
    encode_label(e, compute);
    take_slot(m);
    encode_gpr_rr(e, X86_mov, X86_64, LANES, COLUMN);
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, frame(m, PAIR_ENTRIES));
    encode_align(e, 16);
}

/* The next pair; then the search goes on. */
void emit_close_stretch(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    encode_gpr_ri(e, X86_add, X86_64, STRETCHED, row_step(m));
    encode_gpr_ri(e, X86_add, X86_64, COLUMN, emit_column_bytes(m));
    encode_gpr_rm(e, X86_cmp, X86_64, COLUMN, frame(m, PAIRS_END));
    encode_jump_if(e, X86_IF_b, head);
    encode_gpr_rr(e, X86_mov, X86_64, COLUMN, LANES);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, frame(m, LATEST));
    for (int32_t need = UPPER_P; need < LOWER_Q; need++) {
        encode_gpr_ri(e, X86_cmp, X86_32, X86_R13, need);
        encode_jump_if(e, X86_IF_z, m->stretch.found[need]);
    }
    encode_jump(e, m->stretch.found[LOWER_Q]);
    encode_label(e, m->stretch.done);
}

/* The texels from the current position on that are loaded together, each to a register of its own: a register
 * may have one value after the other, if the first one is spilled immediately. */
static uint32_t count_texels(const struct emitter *m)
{
    const struct allocation *a = m->allocation;
    uint64_t taken = 1ull << SCRATCH_RESULT;
    uint32_t at = m->position;
    for (; at < m->ir->count && m->ir->instruction[at].op == IR_stretch; at++) {
        if (a->residence[at] != RESIDENCE_REGISTER || taken >> a->reg[at] & 1)
            break;
        taken |= 1ull << a->reg[at];
    }
    return at == m->position ? 1 : at - m->position;
}

/* Loads texels by the places in SCRATCH_FIRST, or gathers them by the indices there. */
static void load_texels(struct emitter *m, const struct ir_instruction *i, unsigned to, bool far)
{
    struct encoder *e = &m->encoder;
    const struct address texels = address_indexed(X86_R12, X86_RAX, i->scale, i->k);
    if (far) {
        encode_rrr(e, X86_vpcmpeqd, X86_256, SCRATCH_SECOND, SCRATCH_SECOND, SCRATCH_SECOND);
        encode_rrr(e, X86_vxorps, X86_256, to, to, to);
        encode_gather(e, X86_vgatherdps, X86_256, to, address_indexed(X86_R12, SCRATCH_FIRST, i->scale, i->k),
                      SCRATCH_SECOND);
    } else if (i->scale == 4)
        encode_rrm(e, X86_vpermd, X86_256, to, SCRATCH_FIRST, texels);
    else {
        encode_rm(e, X86_vpbroadcastq, X86_256, to, texels);
        encode_rrr(e, X86_vpshufb, X86_256, to, to, SCRATCH_FIRST);
    }
}

static void load_group(struct emitter *m, uint32_t count, bool far)
{
    for (uint32_t at = m->position; at < m->position + count; at++)
        load_texels(m, &m->ir->instruction[at], m->allocation->reg[at], far);
}

void emit_stretch(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const unsigned column = noted_column(m);
    const uint32_t count = count_texels(m);
    if (m->other_ways == OTHER_WAYS) {
        emit_note_exceeded(m, "hints", OTHER_WAYS);
        return;
    }
    struct other_way *other = &m->other_way[m->other_ways++];
    *other = (struct other_way){m->position, encode_add_label(e), encode_add_label(e)};
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, address_at(COLUMN, emit_near_first(m, column)));
    encode_rm(e, X86_vmovups, X86_256, SCRATCH_FIRST, address_at(COLUMN, emit_near_places(m, column)));
    encode_gpr_rr(e, X86_test, X86_32, X86_RAX, X86_RAX);
    encode_jump_if(e, X86_IF_s, other->begin);
    load_group(m, count, false);
    encode_label(e, other->after);
    m->selected = m->position + count;
}

void emit_far_texels(struct emitter *m, const struct other_way *other)
{
    m->position = other->position;
    emit_note_line(m, m->position);
    encode_label(&m->encoder, other->begin);
    load_group(m, count_texels(m), true);
    encode_jump(&m->encoder, other->after);
}

/* --- Pairs of blocks ------------------------------------------------------------------------------------ */

/* In the loop of pairs, rax is how far the pair is from the beginning of the stretched rows. */
void emit_open_pairs(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    for (unsigned need = 0; need < STRETCH_NEEDS; need++) {
        encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, chosen(m, (enum need)need));
        encode_gpr_rm(e, X86_lea, X86_64, (enum gpr)stretched_row[need],
                      address_indexed(X86_RSP, X86_RAX, 1, 0));
    }
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_at(ENTRY, -BLOCK_BYTES));
    encode_gpr_mr(e, X86_mov, X86_64, frame(m, PAIRS_LIMIT), X86_RAX);
    encode_gpr_rr(e, X86_xor, X86_32, X86_RAX, X86_RAX);
    encode_align(e, 16);
}

/* The next pair, if the run has one. A last block has the loop of blocks. */
void emit_close_pairs(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    encode_gpr_ri(e, X86_add, X86_64, X86_RAX, row_step(m));
    encode_gpr_ri(e, X86_add, X86_64, COLUMN, 2 * emit_column_bytes(m));
    encode_gpr_ri(e, X86_add, X86_64, COLOR, 2 * BLOCK_BYTES);
    encode_gpr_rm(e, X86_cmp, X86_64, COLOR, frame(m, PAIRS_LIMIT));
    encode_jump_if(e, X86_IF_b, head);
    encode_gpr_rr(e, X86_cmp, X86_64, COLOR, ENTRY);
    encode_jump_if(e, X86_IF_nb, m->stretch.end);
    encode_label(e, m->stretch.usual);
}

/* Returns true if the next instruction is the same for the second block, and both results have registers of
 * their own. */
static bool is_double(const struct emitter *m, const struct ir_instruction *i)
{
    const struct allocation *a = m->allocation;
    const uint32_t next = m->position + 1;
    return !i->scale && next < m->ir->count && i[1].op == IR_stretched && i[1].scale && i[1].k == i->k &&
           i[1].field == i->field && a->residence[next] == RESIDENCE_REGISTER &&
           a->reg[m->position] != SCRATCH_RESULT && a->reg[next] != SCRATCH_RESULT &&
           a->reg[m->position] != a->reg[next];
}

void emit_stretched(struct emitter *m, const struct ir_instruction *i)
{
    struct encoder *e = &m->encoder;
    const uint8_t *rows = &stretched_row[i->field ? LOWER_P : UPPER_P];
    const struct address q = address_indexed(rows[1], X86_RAX, 1, i->k);
    const bool both = is_double(m, i);
    encode_rm(e, X86_vmovups, X86_256, SCRATCH_FIRST, address_indexed(rows[0], X86_RAX, 1, i->k));
    encode_rrm(e, i->scale ? X86_vpunpckhqdq : X86_vpunpcklqdq, X86_256, emit_result_register(m),
               SCRATCH_FIRST, q);
    if (!both)
        return;
    encode_rrm(e, X86_vpunpckhqdq, X86_256, m->allocation->reg[m->position + 1], SCRATCH_FIRST, q);
    m->selected = m->position + 2;
}
