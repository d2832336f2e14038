/* The loops of the span reading (passes/separate.c) around the sections of its program.
 *
 * The entries of a call are whole blocks. Those that follow each other in a row of blocks are a run:
 *
 *   for each run of the first row of a triangle
 *       the record's address; then for each of the tile's columns of blocks its entry of the table
 *       for this run and all later ones of the triangle
 *           for each chunk of a block's lanes
 *               for each block of the run
 *
 * While columns are computed, ENTRY is the address of an entry in the stack frame with the column's x. In all
 * other sections it is that of the block. COLUMN is the column's entry in the table. */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"

#include <string.h>

enum {
    COLUMNS = TILE_SIZE / BLOCK_SIZE,
    BLOCK_BYTES = 4 * BLOCK_PIXELS,
    ENTRY_SHIFT = 4,                                  /* the size of an entry */
    ENTRY_COLORS = BLOCK_BYTES / sizeof(struct entry) /* bytes of a block's colours for each of its entry */
};

static_assert(sizeof(struct entry) == 1 << ENTRY_SHIFT, "an entry has 16 bytes");

static struct address frame_at(int32_t offset)
{
    return address_at(X86_RSP, offset);
}

static struct address argument(size_t offset)
{
    return address_at(CALL, (int32_t)offset);
}

static struct address entry_field(size_t offset)
{
    return address_at(ENTRY, (int32_t)offset);
}

static int32_t column_bytes(const struct emitter *m)
{
    return (int32_t)(m->ir->column_words * m->width * 4);
}

int32_t emit_table_bytes(const struct emitter *m)
{
    return COLUMNS * column_bytes(m);
}

/* The block's number, or its column, to eax. */
static void load_block(struct emitter *m, bool column)
{
    encode_gpr_rm(&m->encoder, X86_movzx16, X86_32, X86_RAX, entry_field(offsetof(struct entry, block)));
    if (column)
        encode_gpr_ri(&m->encoder, X86_and, X86_32, X86_RAX, COLUMNS - 1);
}

static void begin_triangle(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_32, TRIANGLE, entry_field(offsetof(struct entry, triangle)));
    encode_gpr_rm(e, X86_add, X86_64, TRIANGLE, argument(offsetof(struct pixel_arguments, triangles)));
}

/* The x of the tile's first column is that of the entry less four pixels for each column before it. */
static void begin_columns(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    load_block(m, true);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, 2);
    encode_rr(e, X86_vmovd, X86_128, SCRATCH_SECOND, X86_RAX);
    encode_rr(e, X86_vcvtdq2ps, X86_128, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_rm(e, X86_vmovss, X86_128, SCRATCH_FIRST, entry_field(offsetof(struct entry, x)));
    encode_rrr(e, X86_vsubps, X86_128, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_mr(e, X86_vmovss_store, X86_128, frame_at(FRAME_ENTRY + (int32_t)offsetof(struct entry, x)),
              SCRATCH_FIRST);
    encode_gpr_mr(e, X86_mov, X86_64, frame_at(FRAME_RUN), ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, ENTRY, frame_at(FRAME_ENTRY));
    encode_gpr_rm(e, X86_mov, X86_64, LANES, argument(offsetof(struct pixel_arguments, lanes)));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, frame_at(m->frame_columns));
}

static void end_column(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    const float step = BLOCK_SIZE;
    int32_t bits;
    memcpy(&bits, &step, sizeof bits);
    struct address four = emit_literal_address(m, bits, LITERAL_ONCE);
    four.broadcast = 0;
    encode_rm(e, X86_vmovss, X86_128, SCRATCH_FIRST, entry_field(offsetof(struct entry, x)));
    encode_rrm(e, X86_vaddss, X86_128, SCRATCH_FIRST, SCRATCH_FIRST, four);
    encode_mr(e, X86_vmovss_store, X86_128, entry_field(offsetof(struct entry, x)), SCRATCH_FIRST);
    encode_gpr_ri(e, X86_add, X86_64, COLUMN, column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, frame_at(m->frame_columns + emit_table_bytes(m)));
    encode_gpr_rr(e, X86_cmp, X86_64, COLUMN, X86_RAX);
    encode_jump_if(e, X86_IF_b, head);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, frame_at(FRAME_RUN));
}

/* Finds the end of the run that begins at ENTRY, at most that of its row of the tile. The next block of the
 * row has the next number; coverage, number and triangle are compared as one word. */
static void find_run(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t bounded = encode_add_label(e), next = encode_add_label(e), done = encode_add_label(e);
    const int32_t size = sizeof(struct entry), number = offsetof(struct entry, coverage);
    load_block(m, true);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, ENTRY_SHIFT);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R13, address_at(ENTRY, COLUMNS * size));
    encode_gpr_rr(e, X86_sub, X86_64, X86_R13, X86_RAX);
    encode_gpr_rr(e, X86_cmp, X86_64, X86_R13, LIMIT);
    encode_jump_if(e, X86_IF_b, bounded);
    encode_gpr_rr(e, X86_mov, X86_64, X86_R13, LIMIT);
    encode_label(e, bounded);
    encode_gpr_rr(e, X86_mov, X86_64, X86_R12, ENTRY);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, entry_field(offsetof(struct entry, coverage)));
    encode_label(e, next);
    encode_gpr_ri(e, X86_add, X86_64, X86_R12, size);
    encode_gpr_ri(e, X86_add, X86_64, X86_RAX, 1 << 16);
    encode_gpr_rr(e, X86_cmp, X86_64, X86_R12, X86_R13);
    encode_jump_if(e, X86_IF_nb, done);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, address_at(X86_R12, number));
    encode_jump_if(e, X86_IF_z, next);
    encode_label(e, done);
    encode_gpr_mr(e, X86_mov, X86_64, frame_at(FRAME_RUN), ENTRY);
    encode_gpr_mr(e, X86_mov, X86_64, frame_at(FRAME_RUN_END), X86_R12);
}

/* Returns true if the program accesses memory at a base in its loop of blocks, which is its last part. */
static bool blocks_access(const struct emitter *m, enum base base)
{
    for (uint32_t n = m->ir->count - 1;
         m->ir->instruction[n].k != IR_LOOP_BLOCKS || m->ir->instruction[n].op != IR_loop; n--)
        if (m->ir->instruction[n].base == base &&
            ir_properties(&m->ir->instruction[n]) & (IR_READS | IR_WRITES))
            return true;
    return false;
}

/* The addresses of the first block of the run, for the chunk that LANES has; and COLOR after its last one. */
static void begin_chunk(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    load_block(m, false);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, 6);
    encode_gpr_rr(e, X86_add, X86_64, X86_RAX, LANES);
    encode_gpr_rm(e, X86_sub, X86_64, X86_RAX, argument(offsetof(struct pixel_arguments, lanes)));
    encode_gpr_rm(e, X86_mov, X86_64, COLOR, argument(offsetof(struct pixel_arguments, color)));
    encode_gpr_rr(e, X86_add, X86_64, COLOR, X86_RAX);
    encode_gpr_rm(e, X86_mov, X86_64, X86_R12, frame_at(FRAME_RUN_END));
    encode_gpr_rr(e, X86_sub, X86_64, X86_R12, ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R12, address_indexed(COLOR, X86_R12, ENTRY_COLORS, 0));
    encode_gpr_mr(e, X86_mov, X86_64, frame_at(FRAME_RUN_COLORS), X86_R12);
    if (blocks_access(m, BASE_DEPTH)) {
        encode_gpr_rm(e, X86_mov, X86_64, DEPTH, argument(offsetof(struct pixel_arguments, depth)));
        encode_gpr_rr(e, X86_add, X86_64, DEPTH, X86_RAX);
    }
    if (!m->ir->column_words)
        return;
    load_block(m, true);
    encode_gpr_rri(e, X86_imul_immediate, X86_32, X86_RAX, X86_RAX, column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, address_indexed(X86_RSP, X86_RAX, 1, m->frame_columns));
}

/* The next chunk of the run; else the next run of the same triangle. */
static void end_chunk(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    uint32_t done = encode_add_label(e);
    encode_gpr_ri(e, X86_add, X86_64, LANES, (int32_t)m->width * 4);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, frame_at(FRAME_RUN));
    encode_gpr_rr(e, X86_mov, X86_64, X86_RAX, LANES);
    encode_gpr_rm(e, X86_sub, X86_64, X86_RAX, argument(offsetof(struct pixel_arguments, lanes)));
    encode_gpr_ri(e, X86_cmp, X86_64, X86_RAX, BLOCK_BYTES);
    encode_jump_if(e, X86_IF_b, head);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, frame_at(FRAME_RUN_END));
    encode_gpr_rr(e, X86_cmp, X86_64, ENTRY, LIMIT);
    encode_jump_if(e, X86_IF_nb, done);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, entry_field(offsetof(struct entry, triangle)));
    encode_gpr_rm(e, X86_add, X86_64, X86_RAX, argument(offsetof(struct pixel_arguments, triangles)));
    encode_gpr_rr(e, X86_cmp, X86_64, X86_RAX, TRIANGLE);
    encode_jump_if(e, X86_IF_z, m->run_label);
    encode_label(e, done);
}

/* Advances the bases that the blocks use. COLOR counts the blocks. */
static void end_block(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    if (blocks_access(m, BASE_ENTRY))
        encode_gpr_ri(e, X86_add, X86_64, ENTRY, sizeof(struct entry));
    if (blocks_access(m, BASE_DEPTH))
        encode_gpr_ri(e, X86_add, X86_64, DEPTH, BLOCK_BYTES);
    if (m->ir->column_words)
        encode_gpr_ri(e, X86_add, X86_64, COLUMN, column_bytes(m));
    encode_gpr_ri(e, X86_add, X86_64, COLOR, BLOCK_BYTES);
    encode_gpr_rm(e, X86_cmp, X86_64, COLOR, frame_at(FRAME_RUN_COLORS));
    encode_jump_if(e, X86_IF_b, head);
}

void emit_open_span(struct emitter *m, enum ir_loop kind, uint32_t head)
{
    struct encoder *e = &m->encoder;
    switch (kind) {
    case IR_LOOP_COLUMNS: begin_columns(m); break;
    case IR_LOOP_ROWS:
        m->run_label = encode_add_label(e);
        encode_label(e, m->run_label);
        find_run(m);
        encode_gpr_rm(e, X86_mov, X86_64, LANES, argument(offsetof(struct pixel_arguments, lanes)));
        break;
    default: break;
    }
    if (kind == IR_LOOP_BLOCKS)
        encode_align(e, 16);
    encode_label(e, head);
    if (kind == IR_LOOP_TRIANGLES)
        begin_triangle(m);
    if (kind == IR_LOOP_ROWS)
        begin_chunk(m);
}

void emit_close_span(struct emitter *m, enum ir_loop kind, uint32_t head)
{
    switch (kind) {
    case IR_LOOP_COLUMNS: end_column(m, head); break;
    case IR_LOOP_ROWS: end_chunk(m, head); break;
    case IR_LOOP_BLOCKS: end_block(m, head); break;
    default:
        encode_gpr_rr(&m->encoder, X86_cmp, X86_64, ENTRY, LIMIT);
        encode_jump_if(&m->encoder, X86_IF_b, head);
    }
}
