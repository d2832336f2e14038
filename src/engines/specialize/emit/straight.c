/* The span reading's loop of blocks for copies with one texel a pixel.
 *
 * Where a loop of blocks only loads texels of words and stores them, the loop of columns also finds how the
 * texels of neighbouring columns follow each other. A column is straight if its four texels do, and linked if
 * its first texel is also the one after the column before it. A run of blocks is straight if its first column
 * is, and all others are linked. Its texels then follow each other, so two blocks of it have eight texels in
 * each row, which are loaded together. Nothing is read of the columns, and no lane chooses its texel:
 *
 *   a   a0 a1 a4 a5 | a2 a3 a6 a7      first    a0 a1 b0 b1 | a2 a3 b2 b3
 *   b   b0 b1 b4 b5 | b2 b3 b6 b7      second   a4 a5 b4 b5 | a6 a7 b6 b7
 *
 * Runs that are a rectangle need less (rectangle.c).
 *
 * While columns are computed, BROKEN has the address of the last column's entry that no straight run has
 * after its first block. A frame's word has it from then on. Other runs have the usual loop (gather_near.c).
 */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"
#include "ir/near.h"

#define BROKEN DEPTH /* the loop of columns accesses no depth */

enum { BLOCK_BYTES = 4 * BLOCK_PIXELS, CHUNK_BYTES = BLOCK_BYTES / 2, PAIR = 2 };

/* Returns true if the instruction stores the value to a chunk's colours. */
static bool stores(const struct ir_instruction *i, uint32_t value, int32_t chunk)
{
    return i->op == IR_store && i->base == BASE_COLOR && i->k == chunk * CHUNK_BYTES &&
           i->operand[0] == value;
}

/* Returns true if the instructions from the hint's on are those of a copy of both chunks. */
static bool copies_from(const struct ir *ir, uint32_t position)
{
    const struct ir_instruction *hint = ir->instruction + position;
    uint32_t last = position + hint->scale;
    if (hint->op != IR_near || ir_near_gathers(hint->k) != PAIR || ir_near_pairs(hint->k) ||
        ir_near_bare(hint->k) || last + PAIR + 1 >= ir->count)
        return false;
    const struct ir_instruction *after = ir->instruction + last + 1;
    return ir->instruction[last].scale == 4 && !ir->instruction[last - 1].k && !ir->instruction[last].k &&
           stores(after, last - 1, 0) && stores(after + 1, last, 1) && after[PAIR].op == IR_again &&
           after[PAIR].k == IR_LOOP_BLOCKS;
}

bool emit_is_copy(struct emitter *m)
{
    const struct ir *ir = m->ir;
    uint32_t n;
    if (m->width != 8 || !ir->separated || ir->chunks != PAIR || ir->near_columns != 1)
        return false;
    n = emit_find_loop(ir, IR_LOOP_BLOCKS);
    for (n++; ir->instruction[n].op == IR_load && ir->instruction[n].base == BASE_COLUMN;)
        n++;
    return copies_from(ir, n) && !emit_chunks_access(m, BASE_ENTRY) && !emit_chunks_access(m, BASE_DEPTH) &&
           !emit_chunks_access(m, BASE_LANES) && emit_rows_stay(m, n);
}

/* --- Columns -------------------------------------------------------------------------------------------- */

void emit_begin_links(struct emitter *m)
{
    if (m->copies)
        encode_gpr_rr(&m->encoder, X86_mov, X86_64, BROKEN, COLUMN);
}

static int32_t entry_bytes(const struct emitter *m)
{
    return (int32_t)(m->ir->column_words * m->width * 4);
}

/* The places of a straight column are the lanes' x. The word before the first column's entry is a number,
 * too: whether that column links does not matter. */
void emit_link_column(struct emitter *m, unsigned lanes, struct address first, uint32_t other)
{
    struct encoder *e = &m->encoder;
    uint32_t linked = encode_add_label(e);
    struct address before = first;
    before.displacement -= entry_bytes(m);
    encode_rr(e, X86_vmovd_store, X86_128, X86_RAX, lanes);
    encode_rr(e, X86_vpbroadcastd, X86_256, SCRATCH_SECOND, lanes);
    encode_rrr(e, X86_vpsubd, X86_256, SCRATCH_SECOND, lanes, SCRATCH_SECOND);
    encode_rm(e, X86_vcvttps2dq, X86_256, SCRATCH_RESULT, address_at(LANES, offsetof(struct lane_table, x)));
    encode_rrr(e, X86_vpxor, X86_256, SCRATCH_RESULT, SCRATCH_RESULT, SCRATCH_SECOND);
    encode_rr(e, X86_vptest, X86_256, SCRATCH_RESULT, SCRATCH_RESULT);
    encode_jump_if(e, X86_IF_nz, other);
    encode_gpr_rr(e, X86_test, X86_32, X86_RAX, X86_RAX);
    encode_jump_if(e, X86_IF_s, other);
    encode_gpr_rr(e, X86_mov, X86_32, X86_R12, X86_RAX);
    encode_gpr_rm(e, X86_sub, X86_32, X86_R12, before);
    encode_gpr_ri(e, X86_cmp, X86_32, X86_R12, BLOCK_SIZE);
    encode_jump_if(e, X86_IF_z, linked);
    encode_gpr_rr(e, X86_mov, X86_64, BROKEN, COLUMN);
    encode_label(e, linked);
}

void emit_break_column(struct emitter *m)
{
    encode_gpr_rm(&m->encoder, X86_lea, X86_64, BROKEN, address_at(COLUMN, entry_bytes(m)));
}

void emit_end_links(struct emitter *m)
{
    if (m->copies)
        encode_gpr_mr(&m->encoder, X86_mov, X86_64, address_at(X86_RSP, FRAME_BROKEN), BROKEN);
}

/* --- Blocks --------------------------------------------------------------------------------------------- */

static struct address texels(unsigned row)
{
    return address_indexed(row, X86_RAX, 4, 0);
}

static void store(struct emitter *m, unsigned block, unsigned chunk, unsigned from)
{
    encode_mr(&m->encoder, X86_vmovups_store, X86_256,
              address_at(COLOR, (int32_t)(block * BLOCK_BYTES + chunk * CHUNK_BYTES)), from);
}

static void copy_pair(struct emitter *m, unsigned chunk, const uint8_t rows[2])
{
    struct encoder *e = &m->encoder;
    encode_rm(e, X86_vmovups, X86_256, SCRATCH_FIRST, texels(rows[0]));
    encode_rm(e, X86_vmovups, X86_256, SCRATCH_SECOND, texels(rows[1]));
    encode_rrr(e, X86_vpunpcklqdq, X86_256, SCRATCH_RESULT, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_rrr(e, X86_vpunpckhqdq, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_rrri(e, X86_vperm2i128, X86_256, SCRATCH_SECOND, SCRATCH_RESULT, SCRATCH_FIRST, 0x20);
    store(m, 0, chunk, SCRATCH_SECOND);
    encode_rrri(e, X86_vperm2i128, X86_256, SCRATCH_SECOND, SCRATCH_RESULT, SCRATCH_FIRST, 0x31);
    store(m, 1, chunk, SCRATCH_SECOND);
}

static void copy_one(struct emitter *m, unsigned chunk, const uint8_t rows[2])
{
    struct encoder *e = &m->encoder;
    encode_rm(e, X86_vmovups, X86_128, SCRATCH_FIRST, texels(rows[0]));
    encode_rrmi(e, X86_vinserti128, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, texels(rows[1]), 1);
    encode_rri(e, X86_vpermq, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, 0xd8);
    store(m, 0, chunk, SCRATCH_FIRST);
}

/* The pairs of a run, then the block that may be left. */
void emit_copy_run(struct emitter *m, const uint8_t *const rows[2], enum gpr end, uint32_t done)
{
    struct encoder *e = &m->encoder;
    uint32_t next = encode_add_label(e), last = encode_add_label(e);
    encode_gpr_ri(e, X86_sub, X86_64, end, BLOCK_BYTES);
    encode_gpr_rr(e, X86_cmp, X86_64, COLOR, end);
    encode_jump_if(e, X86_IF_nb, last);
    encode_align(e, 16);
    encode_label(e, next);
    for (unsigned chunk = 0; chunk < PAIR; chunk++)
        copy_pair(m, chunk, rows[chunk]);
    encode_gpr_ri(e, X86_add, X86_64, X86_RAX, PAIR * BLOCK_SIZE);
    encode_gpr_ri(e, X86_add, X86_64, COLOR, PAIR * BLOCK_BYTES);
    encode_gpr_rr(e, X86_cmp, X86_64, COLOR, end);
    encode_jump_if(e, X86_IF_b, next);
    encode_label(e, last);
    encode_jump_if(e, X86_IF_nz, done);
    for (unsigned chunk = 0; chunk < PAIR; chunk++)
        copy_one(m, chunk, rows[chunk]);
}

void emit_straight_run(struct emitter *m, const uint8_t *const rows[2], struct address first)
{
    struct encoder *e = &m->encoder;
    uint32_t usual = encode_add_label(e);
    m->run_done = encode_add_label(e);
    encode_gpr_rm(e, X86_cmp, X86_64, COLUMN, address_at(X86_RSP, FRAME_BROKEN));
    encode_jump_if(e, X86_IF_b, usual);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, first);
    emit_copy_run(m, rows, ENTRY, m->run_done);
    encode_jump(e, m->run_done);
    encode_label(e, usual);
}
