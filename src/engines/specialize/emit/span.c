/* The loops of the span reading (passes/span/separate.c) around the sections of its program.
 *
 * The entries of a call are whole blocks. Those that follow each other in a row of blocks are a run:
 *
 *   for each run of the first row of a triangle
 *       the record's address; then for each of the tile's columns of blocks its entry of the table
 *       for this run and all later ones of the triangle, GROUP together
 *           for each run of the group
 *               for each chunk of a block's lanes its entry of the table of rows
 *           for each entry of the table of rows
 *               for each block of the run
 *
 * While columns are computed, ENTRY is the address of the column's x in the stack frame, as of an entry. In
 * the loop of rows it is that of the run's first block, and in the loop of blocks that of the block, or the
 * end of the colours if no block reads its entry. COLUMN is the column's entry in the table, and ROW the
 * row's: its values, the addresses of rows of texels (gather_near.c), and what the loop of blocks begins and
 * ends with. */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"

#include <string.h>

enum {
    COLUMNS = TILE_SIZE / BLOCK_SIZE,
    GROUP = 8, /* runs whose rows are computed together */
    BLOCK_BYTES = 4 * BLOCK_PIXELS,
    PLACES_BYTES = COLUMNS * (int)sizeof(float),
    ENTRY_SHIFT = 4,                                  /* the size of an entry */
    ENTRY_COLORS = BLOCK_BYTES / sizeof(struct entry) /* bytes of a block's colours for each of its entry */
};

static_assert(sizeof(struct entry) == 1 << ENTRY_SHIFT, "an entry has 16 bytes");
static_assert(!offsetof(struct entry, x), "an x by itself is the beginning of an entry");

static struct address argument(size_t offset)
{
    return address_at(CALL, (int32_t)offset);
}

static struct address entry_field(size_t offset)
{
    return address_at(ENTRY, (int32_t)offset);
}

int32_t emit_table_bytes(const struct emitter *m)
{
    return COLUMNS * emit_column_bytes(m);
}

int32_t emit_places_bytes(const struct emitter *m)
{
    return m->ir->separated ? PLACES_BYTES : 0;
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

/* Stores the x of each column. That of the first one is the entry's x less four pixels for each column before
 * the entry's. All are whole numbers, so the sums are exact. */
static void store_places(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const float next = (float)(BLOCK_SIZE * m->width);
    const int32_t bytes = (int32_t)m->width * 4;
    int32_t bits;
    memcpy(&bits, &next, sizeof bits);
    load_block(m, true);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, 2);
    encode_rr(e, X86_vmovd, X86_128, SCRATCH_SECOND, X86_RAX);
    encode_rr(e, X86_vcvtdq2ps, X86_128, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_rm(e, X86_vmovss, X86_128, SCRATCH_FIRST, entry_field(offsetof(struct entry, x)));
    encode_rrr(e, X86_vsubps, X86_128, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_rr(e, X86_vpbroadcastd, m->length, SCRATCH_FIRST, SCRATCH_FIRST);
    encode_rm(e, X86_vcvtdq2ps, m->length, SCRATCH_SECOND,
              emit_literal_address(m, BLOCK_SIZE, LITERAL_MULTIPLES));
    encode_rrr(e, X86_vaddps, m->length, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_mr(e, X86_vmovups_store, m->length, emit_frame_at(m->frame_places), SCRATCH_FIRST);
    for (int32_t at = bytes; at < PLACES_BYTES; at += bytes) {
        encode_rrm(e, X86_vaddps, m->length, SCRATCH_FIRST, SCRATCH_FIRST,
                   emit_literal_address(m, bits, LITERAL_LANES));
        encode_mr(e, X86_vmovups_store, m->length, emit_frame_at(m->frame_places + at), SCRATCH_FIRST);
    }
}

static void begin_columns(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    store_places(m);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN), ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, ENTRY, emit_frame_at(m->frame_places));
    encode_gpr_rm(e, X86_mov, X86_64, LANES, argument(offsetof(struct pixel_arguments, lanes)));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, emit_frame_at(m->frame_columns));
    emit_begin_links(m);
}

static void end_column(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    encode_gpr_ri(e, X86_add, X86_64, ENTRY, sizeof(float));
    encode_gpr_ri(e, X86_add, X86_64, COLUMN, emit_column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, emit_frame_at(m->frame_columns + emit_table_bytes(m)));
    encode_gpr_rr(e, X86_cmp, X86_64, COLUMN, X86_RAX);
    encode_jump_if(e, X86_IF_b, head);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    emit_end_links(m);
    emit_pair_columns(m);
}

/* Finds the end of the run that begins at ENTRY, at most that of its row of the tile: r12. The next block of
 * the row has the next number; coverage, number and triangle are compared as one word. The blocks of a
 * triangle follow each other in increasing order, so if the last one that the row can have is in its place,
 * all are. */
void emit_find_run(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t bounded = encode_add_label(e), next = encode_add_label(e), done = encode_add_label(e);
    const int32_t size = sizeof(struct entry), number = offsetof(struct entry, coverage), one = 1 << 16;
    load_block(m, true);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, ENTRY_SHIFT);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R13, address_at(ENTRY, COLUMNS * size));
    encode_gpr_rr(e, X86_sub, X86_64, X86_R13, X86_RAX);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_R13, emit_frame_at(FRAME_LIMIT));
    encode_jump_if(e, X86_IF_b, bounded);
    encode_gpr_rm(e, X86_mov, X86_64, X86_R13, emit_frame_at(FRAME_LIMIT));
    encode_label(e, bounded);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, entry_field(offsetof(struct entry, coverage)));
    encode_gpr_rr(e, X86_mov, X86_64, X86_R12, X86_R13);
    encode_gpr_rr(e, X86_sub, X86_64, X86_R12, ENTRY);
    encode_gpr_ri(e, X86_shl, X86_64, X86_R12, 16 - ENTRY_SHIFT);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R12, address_indexed(X86_RAX, X86_R12, 1, -one));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_R12, address_at(X86_R13, number - size));
    encode_gpr_rr(e, X86_mov, X86_64, X86_R12, X86_R13);
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_rr(e, X86_mov, X86_64, X86_R12, ENTRY);
    encode_label(e, next);
    encode_gpr_ri(e, X86_add, X86_64, X86_R12, size);
    encode_gpr_ri(e, X86_add, X86_64, X86_RAX, one);
    encode_gpr_rr(e, X86_cmp, X86_64, X86_R12, X86_R13);
    encode_jump_if(e, X86_IF_nb, done);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, address_at(X86_R12, number));
    encode_jump_if(e, X86_IF_z, next);
    encode_label(e, done);
}

/* --- The table of rows ---------------------------------------------------------------------------------- */

/* The bounds of the loop of blocks, after the values and the texels of an entry. */
enum row_field { ROW_COLOR, ROW_COLOR_END, ROW_COLUMN, ROW_ENTRY, ROW_LANES, ROW_FIELDS };

static int32_t row_values(const struct emitter *m)
{
    return (int32_t)(m->ir->row_words * m->width * 4);
}

int32_t emit_texel_row(const struct emitter *m, unsigned row, unsigned second)
{
    return row_values(m) + (int32_t)(16 * row + 8 * second);
}

static struct address row_field(const struct emitter *m, enum row_field field)
{
    return address_at(ROW, emit_texel_row(m, m->ir->near_rows, 0) + 8 * (int32_t)field);
}

/* Bytes of an entry, so that the values of all entries are aligned. */
static int32_t row_bytes(const struct emitter *m)
{
    int32_t lanes = (int32_t)m->width * 4;
    return (emit_texel_row(m, m->ir->near_rows, 0) + 8 * ROW_FIELDS + lanes - 1) & -lanes;
}

/* Bytes of a word of the lanes that a pass of the loops of rows and of blocks computes. */
static int32_t step_bytes(const struct emitter *m)
{
    return (int32_t)(m->ir->chunks * m->width * 4);
}

int32_t emit_row_table_bytes(const struct emitter *m)
{
    return m->ir->separated ? GROUP * BLOCK_BYTES / step_bytes(m) * row_bytes(m) : 0;
}

uint32_t emit_find_loop(const struct ir *ir, enum ir_loop kind)
{
    uint32_t n = ir->count - 1;
    while (ir->instruction[n].op != IR_loop || ir->instruction[n].k != (int32_t)kind)
        n--;
    return n;
}

bool emit_chunks_access(const struct emitter *m, enum base base)
{
    for (uint32_t n = emit_find_loop(m->ir, IR_LOOP_CHUNKS); n < m->ir->count; n++)
        if (m->ir->instruction[n].base == base &&
            ir_properties(&m->ir->instruction[n]) & (IR_READS | IR_WRITES))
            return true;
    return false;
}

/* The addresses of the first block of the run for the first chunk, and of the colours after its last one. In
 * the loop of rows, which does not read depth, DEPTH is the latter. */
static void begin_run(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_label(e, m->run_label);
    emit_find_run(m);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN_END), X86_R12);
    load_block(m, false);
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, 6);
    encode_gpr_rm(e, X86_mov, X86_64, COLOR, argument(offsetof(struct pixel_arguments, color)));
    encode_gpr_rr(e, X86_add, X86_64, COLOR, X86_RAX);
    encode_gpr_rr(e, X86_sub, X86_64, X86_R12, ENTRY);
    encode_gpr_rm(e, X86_lea, X86_64, DEPTH, address_indexed(COLOR, X86_R12, ENTRY_COLORS, 0));
    encode_gpr_rm(e, X86_mov, X86_64, LANES, argument(offsetof(struct pixel_arguments, lanes)));
    if (!m->ir->column_words)
        return;
    load_block(m, true);
    encode_gpr_rri(e, X86_imul_immediate, X86_32, X86_RAX, X86_RAX, emit_column_bytes(m));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, address_indexed(X86_RSP, X86_RAX, 1, m->frame_columns));
}

static void begin_rows(struct emitter *m)
{
    m->run_label = encode_add_label(&m->encoder);
    encode_gpr_rm(&m->encoder, X86_lea, X86_64, ROW, emit_frame_at(m->frame_rows));
    begin_run(m);
}

/* Jumps if the entry at ENTRY is one of the same triangle, past which LIMIT is not. */
static void jump_if_same_triangle(struct emitter *m, uint32_t same, uint32_t other)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_cmp, X86_64, ENTRY, emit_frame_at(FRAME_LIMIT));
    encode_jump_if(e, X86_IF_nb, other);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, entry_field(offsetof(struct entry, triangle)));
    encode_gpr_rm(e, X86_add, X86_64, X86_RAX, argument(offsetof(struct pixel_arguments, triangles)));
    encode_gpr_rr(e, X86_cmp, X86_64, X86_RAX, TRIANGLE);
    encode_jump_if(e, X86_IF_z, same);
}

static void store_fields(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_gpr_mr(e, X86_mov, X86_64, row_field(m, ROW_COLOR), COLOR);
    encode_gpr_mr(e, X86_mov, X86_64, row_field(m, ROW_COLOR_END), DEPTH);
    if (m->ir->column_words)
        encode_gpr_mr(e, X86_mov, X86_64, row_field(m, ROW_COLUMN), COLUMN);
    if (emit_chunks_access(m, BASE_ENTRY))
        encode_gpr_mr(e, X86_mov, X86_64, row_field(m, ROW_ENTRY), ENTRY);
    if (emit_chunks_access(m, BASE_LANES))
        encode_gpr_mr(e, X86_mov, X86_64, row_field(m, ROW_LANES), LANES);
    encode_gpr_ri(e, X86_add, X86_64, ROW, row_bytes(m));
}

/* The next chunk of the run, else the next run of the group. */
static void end_rows(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    const int32_t step = step_bytes(m);
    uint32_t done = encode_add_label(e);
    store_fields(m);
    if (step < BLOCK_BYTES) {
        encode_gpr_ri(e, X86_add, X86_64, COLOR, step);
        encode_gpr_ri(e, X86_add, X86_64, DEPTH, step);
        encode_gpr_ri(e, X86_add, X86_64, LANES, step);
        encode_gpr_rr(e, X86_mov, X86_64, X86_RAX, LANES);
        encode_gpr_rm(e, X86_sub, X86_64, X86_RAX, argument(offsetof(struct pixel_arguments, lanes)));
        encode_gpr_ri(e, X86_cmp, X86_64, X86_RAX, BLOCK_BYTES);
        encode_jump_if(e, X86_IF_b, head);
    }
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN_END));
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, emit_frame_at(m->frame_rows + emit_row_table_bytes(m)));
    encode_gpr_rr(e, X86_cmp, X86_64, ROW, X86_RAX);
    encode_jump_if(e, X86_IF_nb, done);
    jump_if_same_triangle(m, m->run_label, done);
    encode_label(e, done);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN), ENTRY);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_ROWS_END), ROW);
}

/* --- Chunks and blocks ---------------------------------------------------------------------------------- */

static void begin_chunk(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_64, COLOR, row_field(m, ROW_COLOR));
    if (m->ir->column_words)
        encode_gpr_rm(e, X86_mov, X86_64, COLUMN, row_field(m, ROW_COLUMN));
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY,
                  row_field(m, emit_chunks_access(m, BASE_ENTRY) ? ROW_ENTRY : ROW_COLOR_END));
    if (emit_chunks_access(m, BASE_LANES))
        encode_gpr_rm(e, X86_mov, X86_64, LANES, row_field(m, ROW_LANES));
    if (!emit_chunks_access(m, BASE_DEPTH))
        return;
    encode_gpr_rr(e, X86_mov, X86_64, DEPTH, COLOR);
    encode_gpr_rm(e, X86_sub, X86_64, DEPTH, argument(offsetof(struct pixel_arguments, color)));
    encode_gpr_rm(e, X86_add, X86_64, DEPTH, argument(offsetof(struct pixel_arguments, depth)));
}

static void end_chunk(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    encode_gpr_ri(e, X86_add, X86_64, ROW, row_bytes(m));
    encode_gpr_rm(e, X86_cmp, X86_64, ROW, emit_frame_at(FRAME_ROWS_END));
    encode_jump_if(e, X86_IF_b, head);
}

/* The next runs of the same triangle. */
static void end_runs(struct emitter *m, uint32_t head)
{
    uint32_t done = encode_add_label(&m->encoder);
    encode_gpr_rm(&m->encoder, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    jump_if_same_triangle(m, head, done);
    encode_label(&m->encoder, done);
}

/* Advances the bases that the blocks use. COLOR counts the blocks. */
static void end_block(struct emitter *m, uint32_t head)
{
    struct encoder *e = &m->encoder;
    const bool has_entry = emit_chunks_access(m, BASE_ENTRY);
    if (has_entry)
        encode_gpr_ri(e, X86_add, X86_64, ENTRY, sizeof(struct entry));
    if (emit_chunks_access(m, BASE_DEPTH))
        encode_gpr_ri(e, X86_add, X86_64, DEPTH, BLOCK_BYTES);
    if (m->ir->column_words)
        encode_gpr_ri(e, X86_add, X86_64, COLUMN, emit_column_bytes(m));
    encode_gpr_ri(e, X86_add, X86_64, COLOR, BLOCK_BYTES);
    if (has_entry)
        encode_gpr_rm(e, X86_cmp, X86_64, COLOR, row_field(m, ROW_COLOR_END));
    else
        encode_gpr_rr(e, X86_cmp, X86_64, COLOR, ENTRY);
    encode_jump_if(e, X86_IF_b, head);
    if (m->copies)
        encode_label(e, m->run_done);
    if (m->ir->stretch_words)
        encode_label(e, m->stretch.end);
}

void emit_open_span(struct emitter *m, enum ir_loop kind, uint32_t head)
{
    switch (kind) {
    case IR_LOOP_COLUMNS:
        if (m->rectangles)
            emit_copy_rectangle(m);
        begin_columns(m);
        break;
    case IR_LOOP_ROWS: begin_rows(m); break;
    case IR_LOOP_CHUNKS:
        encode_gpr_rm(&m->encoder, X86_lea, X86_64, ROW, emit_frame_at(m->frame_rows));
        break;
    case IR_LOOP_STRETCH: emit_open_stretch(m); break;
    case IR_LOOP_PAIRS: emit_open_pairs(m); break;
    case IR_LOOP_BLOCKS:
        emit_open_rows(m);
        encode_align(&m->encoder, 16);
        break;
    default: break;
    }
    encode_label(&m->encoder, head);
    if (kind == IR_LOOP_TRIANGLES)
        begin_triangle(m);
    if (kind == IR_LOOP_CHUNKS)
        begin_chunk(m);
}

void emit_close_span(struct emitter *m, enum ir_loop kind, uint32_t head)
{
    switch (kind) {
    case IR_LOOP_COLUMNS: end_column(m, head); break;
    case IR_LOOP_RUNS: end_runs(m, head); break;
    case IR_LOOP_ROWS: end_rows(m, head); break;
    case IR_LOOP_CHUNKS: end_chunk(m, head); break;
    case IR_LOOP_STRETCH: emit_close_stretch(m, head); break;
    case IR_LOOP_PAIRS: emit_close_pairs(m, head); break;
    case IR_LOOP_BLOCKS: end_block(m, head); break;
    default:
        if (m->rectangles)
            encode_label(&m->encoder, m->rectangle_done);
        encode_gpr_rm(&m->encoder, X86_cmp, X86_64, ENTRY, emit_frame_at(FRAME_LIMIT));
        encode_jump_if(&m->encoder, X86_IF_b, head);
    }
}
