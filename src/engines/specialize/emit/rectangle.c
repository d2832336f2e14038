/* The span reading's copies of rectangles whose texels follow each other.
 *
 * In the sections of columns and rows, the eight lanes of a copy's values are those of a block, in which a
 * row or a column of pixels has two lanes. The sections use the lanes' places in the block only to compute
 * distances from the triangle's origin, which are exact (spec/pixel/interpolate.h). So with other places they
 * compute eight columns of pixels, and two times eight rows:
 *
 *   places x    0 1 0 1 2 3 2 3   0 1 0 1 2 3 2 3  ->  0 1 2 3 4 5 6 7
 *   places y    0 0 1 1 0 0 1 1   2 2 3 3 2 2 3 3  ->  0 1 2 3 4 5 6 7   8 9 10 11 12 13 14 15
 *
 * The first blocks of a triangle are a rectangle if at least its first two runs have the same columns. If the
 * texels of these columns follow each other, the rectangle is copied. Of a row of pixels, only the index of
 * its row of texels is stored. The rest of the triangle is begun as a triangle of its own.
 *
 * A tile is a rectangle by itself, and needs only the entries of its first row (takes_tiles). */
#include "engines/specialize/emit/emit.h"
#include "engines/specialize/emit/frame.h"
#include "ir/near.h"

enum {
    LANE_BYTES = 32, /* of a value */
    ENTRY_BYTES = sizeof(struct entry),
    COLORS_SHIFT = 6,                          /* the size of a block's colours */
    ENTRY_COLORS = 64 / ENTRY_BYTES,           /* bytes of a block's colours for each of its entry */
    NUMBER = offsetof(struct entry, coverage), /* coverage, number and triangle are compared as one word: */
    NUMBER_SHIFT = 16,
    ENTRY_SHIFT = 4,
    NEXT_WORDS = 1 << NUMBER_SHIFT,
    NEXT_RUN = TILE_SIZE / BLOCK_SIZE * NEXT_WORDS,
    RUN_ROWS = BLOCK_SIZE * 4, /* bytes of the indices of rows of texels of a run */
    GROUP_ROWS = 2 * LANE_BYTES,
    TILE_RUNS = TILE_SIZE / BLOCK_SIZE
};

/* Words of the frame, which other blocks use otherwise: the entry after the rectangle's; the runs that are
 * left; and how far the colours of a run are from those of the last block of the run above. */
enum { FRAME_END = FRAME_RUN_END, FRAME_RUNS = FRAME_ROWS_END, FRAME_STEP = FRAME_BROKEN };

static_assert(ENTRY_BYTES == BLOCK_SIZE * 4, "an entry has as many bytes as the indices of its columns");

/* --- Programs ------------------------------------------------------------------------------------------- */

/* A section: its instructions, and the fields of an entry, of the lanes' places and of the triangle's record
 * for its distances. */
struct section {
    int32_t corner, place, origin;
    uint32_t begin, end;
};

enum { SECTION_MOST = 64, FIRST_PLACES = 1, SECOND_PLACES = 2, OTHER = 4 };

static bool is_word(const struct ir_instruction *i, enum ir_op op, unsigned base, int32_t field)
{
    return i->op == op && i->base == base && i->k == field;
}

/* Returns which places the section loads there. */
static unsigned loaded_places(const struct ir_instruction *i, const struct section *s)
{
    return is_word(i, IR_load, BASE_LANES, s->place)                ? FIRST_PLACES
           : is_word(i, IR_load, BASE_LANES, s->place + LANE_BYTES) ? SECOND_PLACES
                                                                    : OTHER;
}

/* Returns the places of a distance: place + (corner - origin); OTHER if the value is something else. */
static unsigned distance_places(const struct ir *ir, const struct ir_instruction *i, const struct section *s)
{
    if (i->op != IR_add_f)
        return OTHER;
    for (unsigned k = 0; k < 2; k++) {
        const struct ir_instruction *from = ir->instruction + i->operand[k];
        if (from->op == IR_sub_f &&
            is_word(ir->instruction + from->operand[0], IR_uniform, BASE_ENTRY, s->corner) &&
            is_word(ir->instruction + from->operand[1], IR_uniform, BASE_TRIANGLE, s->origin))
            return loaded_places(ir->instruction + i->operand[!k], s);
    }
    return OTHER;
}

/* Returns true if an instruction of a section may run for a rectangle. */
static bool may_run(const struct ir_instruction *i, const struct section *s)
{
    return ir_properties(i) & IR_COMPUTES || i->op == IR_literal || i->op == IR_constant ||
           is_word(i, IR_uniform, BASE_ENTRY, s->corner) || loaded_places(i, s) != OTHER;
}

/* Returns which places a value of a section depends on, as those before it. */
static unsigned find_places(const struct ir *ir, const struct section *s, uint32_t n,
                            const uint8_t places[SECTION_MOST])
{
    const struct ir_instruction *i = ir->instruction + n;
    unsigned of = distance_places(ir, i, s);
    if (of != OTHER || ir_properties(i) & IR_READS)
        return of;
    of = 0;
    for (unsigned k = 0; k < ir_operands(i); k++)
        if (i->operand[k] >= s->begin)
            of |= places[i->operand[k] - s->begin];
    return of;
}

/* Returns true if the section may run for a rectangle: it stores `count` values, lanes after lanes.
 * Each depends only on its own places, and is noted after the section. */
static bool computes_rectangles(const struct ir *ir, const struct section *s, unsigned base, unsigned count)
{
    uint8_t places[SECTION_MOST];
    unsigned stored = 0;
    if (s->end - s->begin > SECTION_MOST)
        return false;
    for (uint32_t n = s->begin; n < s->end; n++) {
        const struct ir_instruction *i = ir->instruction + n;
        if (i->op != IR_store) {
            if (!may_run(i, s))
                return false;
            places[n - s->begin] = (uint8_t)find_places(ir, s, n, places);
            continue;
        }
        if (stored == count || i->base != base || i->k != (int32_t)stored * LANE_BYTES ||
            i->operand[0] < s->begin || places[i->operand[0] - s->begin] != 1u << stored ||
            ir->instruction[s->end + stored].operand[0] != i->operand[0])
            return false;
        stored++;
    }
    return stored == count;
}

/* The section in a loop up to its first note; without any, up to the program's end. */
static struct section section_of(const struct ir *ir, enum ir_loop kind)
{
    struct section s = {.begin = emit_find_loop(ir, kind) + 1};
    const enum ir_op note = kind == IR_LOOP_COLUMNS ? IR_near_column : IR_near_row;
    s.end = s.begin;
    while (s.end < ir->count && ir->instruction[s.end].op != note)
        s.end++;
    const bool columns = kind == IR_LOOP_COLUMNS;
    s.corner = (int32_t)(columns ? offsetof(struct entry, x) : offsetof(struct entry, y));
    s.place = (int32_t)(columns ? offsetof(struct lane_table, x) : offsetof(struct lane_table, y));
    s.origin = (int32_t)(columns ? offsetof(struct triangle_head, origin_x)
                                 : offsetof(struct triangle_head, origin_y));
    return s;
}

/* Returns true if an instruction notes a row of texels of words, of the same texture as the first. */
static bool is_note(const struct ir_instruction *i, const struct ir_instruction *first, int32_t row)
{
    return i->op == IR_near_row && i->k == row && i->base == first->base && i->field == first->field &&
           i->scale == 4;
}

bool emit_copies_rectangles(const struct ir *ir)
{
    const struct section columns = section_of(ir, IR_LOOP_COLUMNS), rows = section_of(ir, IR_LOOP_ROWS);
    const struct ir_instruction *note = ir->instruction + rows.end;
    return ir->near_rows == 2 && rows.end + 1 < ir->count && is_note(note, note, 0) &&
           is_note(note + 1, note, 1) && computes_rectangles(ir, &columns, BASE_COLUMN, 1) &&
           computes_rectangles(ir, &rows, BASE_ROW, 2);
}

/* --- Code ----------------------------------------------------------------------------------------------- */

static struct address argument(size_t offset)
{
    return address_at(CALL, (int32_t)offset);
}

/* Writes the code of a section. Its lines belong to its first instruction. */
static void write_section(struct emitter *m, const struct section *s)
{
    const uint32_t position = m->position, selected = m->selected;
    m->position = s->begin;
    emit_note_line(m, m->position);
    emit_instructions(m, s->end, false);
    m->position = position;
    m->selected = selected;
}

/* Jumps to `other` unless the run after the one at ENTRY, whose entries have r13 bytes, has the same
 * columns of the same triangle. Blocks are in increasing order, so its first and last are enough. */
static void require_next_run(struct emitter *m, uint32_t other)
{
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_lea, X86_64, X86_R12, address_indexed(ENTRY, X86_R13, 2, 0));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_R12, emit_frame_at(FRAME_LIMIT));
    encode_jump_if(e, X86_IF_nbe, other);
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, address_at(ENTRY, NUMBER));
    encode_gpr_ri(e, X86_add, X86_64, X86_RAX, NEXT_RUN);
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, address_indexed(ENTRY, X86_R13, 1, NUMBER));
    encode_jump_if(e, X86_IF_nz, other);
    encode_gpr_rr(e, X86_mov, X86_64, LANES, X86_R13);
    encode_gpr_ri(e, X86_shl, X86_64, LANES, NUMBER_SHIFT - ENTRY_SHIFT);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, LANES, 1, -NEXT_WORDS));
    encode_gpr_rm(e, X86_cmp, X86_64, X86_RAX, address_at(X86_R12, NUMBER - ENTRY_BYTES));
    encode_jump_if(e, X86_IF_nz, other);
}

/* Finds the width of the rectangle that begins at ENTRY, whose first two runs must have the same columns. */
static void find_part(struct emitter *m, uint32_t usual)
{
    struct encoder *e = &m->encoder;
    emit_find_run(m);
    encode_gpr_rr(e, X86_mov, X86_64, X86_R13, X86_R12);
    encode_gpr_rr(e, X86_sub, X86_64, X86_R13, ENTRY);
    encode_gpr_ri(e, X86_cmp, X86_64, X86_R13, 2 * ENTRY_BYTES);
    encode_jump_if(e, X86_IF_b, usual);
    require_next_run(m, usual);
}

/* Jumps to `other` if the routine was called for a tile. */
static void jump_if_tile(struct emitter *m, uint32_t other)
{
    encode_gpr_mi(&m->encoder, X86_cmp, X86_32, argument(offsetof(struct pixel_arguments, tile)), 0);
    encode_jump_if(&m->encoder, X86_IF_nz, other);
}

/* Finds the width of the rectangle that begins at ENTRY: the bytes of the entries of a run, in r13 and in the
 * frame. All entries of a tile's call are a run. */
static void find_width(struct emitter *m, uint32_t usual)
{
    struct encoder *e = &m->encoder;
    uint32_t tile = encode_add_label(e);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUN), ENTRY);
    encode_gpr_rm(e, X86_mov, X86_64, X86_R13, emit_frame_at(FRAME_LIMIT));
    encode_gpr_rr(e, X86_sub, X86_64, X86_R13, ENTRY);
    jump_if_tile(m, tile);
    find_part(m, usual);
    encode_label(e, tile);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_WIDTH), X86_R13);
}

/* Counts the runs of the rectangle, and finds its end. */
static void find_height(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    uint32_t next = encode_add_label(e), last = encode_add_label(e);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    encode_gpr_rm(e, X86_mov, X86_64, X86_R13, emit_frame_at(FRAME_WIDTH));
    encode_gpr_rm(e, X86_lea, X86_64, COLOR, address_at(X86_NONE, TILE_RUNS));
    jump_if_tile(m, last);
    encode_gpr_rr(e, X86_xor, X86_32, COLOR, COLOR);
    encode_label(e, next);
    encode_gpr_ri(e, X86_add, X86_32, COLOR, 1);
    require_next_run(m, last);
    encode_gpr_rr(e, X86_add, X86_64, ENTRY, X86_R13);
    encode_jump(e, next);
    encode_label(e, last);
    encode_gpr_rr(e, X86_add, X86_64, ENTRY, X86_R13);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_END), ENTRY);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_RUNS), COLOR);
}

/* Stores places that follow each other: eight from the first lane's x, and sixteen from its y. */
static void store_places(struct emitter *m)
{
    enum { EIGHT = 0x41000000 /* 8.0 */ };
    struct encoder *e = &m->encoder;
    encode_gpr_rm(e, X86_mov, X86_64, LANES, argument(offsetof(struct pixel_arguments, lanes)));
    encode_rm(e, X86_vcvtdq2ps, X86_256, SCRATCH_SECOND, emit_literal_address(m, 1, LITERAL_MULTIPLES));
    encode_rm(e, X86_vbroadcastss, X86_256, SCRATCH_FIRST, address_at(LANES, offsetof(struct lane_table, x)));
    encode_rrr(e, X86_vaddps, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_mr(e, X86_vmovups_store, X86_256, emit_frame_at(m->frame_places), SCRATCH_FIRST);
    encode_rm(e, X86_vbroadcastss, X86_256, SCRATCH_FIRST, address_at(LANES, offsetof(struct lane_table, y)));
    encode_rrr(e, X86_vaddps, X86_256, SCRATCH_FIRST, SCRATCH_FIRST, SCRATCH_SECOND);
    encode_mr(e, X86_vmovups_store, X86_256, emit_frame_at(FRAME_LANES), SCRATCH_FIRST);
    encode_rrm(e, X86_vaddps, X86_256, SCRATCH_FIRST, SCRATCH_FIRST,
               emit_literal_address(m, EIGHT, LITERAL_LANES));
    encode_mr(e, X86_vmovups_store, X86_256, emit_frame_at(FRAME_LANES + LANE_BYTES), SCRATCH_FIRST);
}

/* Stores the texels of the rectangle's columns of pixels, from the frame's table of columns on: those of two
 * blocks of the first run at a time, and of the last two also if their number is odd. COLUMN becomes the
 * address of those of the last block. Jumps to `other` if the first and the last of eight show that they do
 * not follow each other. */
static void store_columns(struct emitter *m, uint32_t other)
{
    struct encoder *e = &m->encoder;
    const struct section s = section_of(m->ir, IR_LOOP_COLUMNS);
    uint32_t next = encode_add_label(e);
    encode_gpr_rm(e, X86_lea, X86_64, X86_R12, address_indexed(ENTRY, X86_R13, 1, -2 * ENTRY_BYTES));
    encode_gpr_rm(e, X86_lea, X86_64, LANES, emit_frame_at(m->frame_places - s.place));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, emit_frame_at(m->frame_columns));
    encode_label(e, next);
    write_section(m, &s);
    encode_gpr_rm(e, X86_mov, X86_32, X86_RAX, address_at(COLUMN, LANE_BYTES - 4));
    encode_gpr_rm(e, X86_sub, X86_32, X86_RAX, address_at(COLUMN, 0));
    encode_gpr_ri(e, X86_cmp, X86_32, X86_RAX, LANE_BYTES / 4 - 1);
    encode_jump_if(e, X86_IF_nz, other);
    encode_gpr_ri(e, X86_add, X86_64, ENTRY, 2 * ENTRY_BYTES);
    encode_gpr_ri(e, X86_add, X86_64, COLUMN, 2 * ENTRY_BYTES);
    encode_gpr_rr(e, X86_cmp, X86_64, ENTRY, X86_R12);
    encode_jump_if(e, X86_IF_be, next);
    encode_gpr_ri(e, X86_sub, X86_64, ENTRY, ENTRY_BYTES);
    encode_gpr_ri(e, X86_sub, X86_64, COLUMN, ENTRY_BYTES);
    encode_gpr_rr(e, X86_cmp, X86_64, ENTRY, X86_R12);
    encode_jump_if(e, X86_IF_z, next);
}

/* Jumps to `other` unless the texels follow each other, from one that is not negative on. Those of one more
 * block are made to do so, since those of two are compared at a time. */
static void require_straight(struct emitter *m, uint32_t other)
{
    struct encoder *e = &m->encoder;
    uint32_t next = encode_add_label(e);
    encode_rm(e, X86_vmovups, X86_128, SCRATCH_FIRST, address_at(COLUMN, 0));
    encode_rrm(e, X86_vpaddd, X86_128, SCRATCH_FIRST, SCRATCH_FIRST,
               emit_literal_address(m, BLOCK_SIZE, LITERAL_LANES));
    encode_mr(e, X86_vmovups_store, X86_128, address_at(COLUMN, ENTRY_BYTES), SCRATCH_FIRST);
    encode_rm(e, X86_vpbroadcastd, X86_256, SCRATCH_FIRST, emit_frame_at(m->frame_columns));
    encode_rrm(e, X86_vpaddd, X86_256, SCRATCH_FIRST, SCRATCH_FIRST,
               emit_literal_address(m, 1, LITERAL_MULTIPLES));
    encode_gpr_rm(e, X86_lea, X86_64, LANES, emit_frame_at(m->frame_columns));
    encode_label(e, next);
    encode_rrm(e, X86_vpxor, X86_256, SCRATCH_SECOND, SCRATCH_FIRST, address_at(LANES, 0));
    encode_rr(e, X86_vptest, X86_256, SCRATCH_SECOND, SCRATCH_SECOND);
    encode_jump_if(e, X86_IF_nz, other);
    encode_rrm(e, X86_vpaddd, X86_256, SCRATCH_FIRST, SCRATCH_FIRST,
               emit_literal_address(m, 2 * BLOCK_SIZE, LITERAL_LANES));
    encode_gpr_ri(e, X86_add, X86_64, LANES, LANE_BYTES);
    encode_gpr_rr(e, X86_cmp, X86_64, LANES, COLUMN);
    encode_jump_if(e, X86_IF_be, next);
    encode_gpr_rm(e, X86_mov, X86_32, X86_R12, emit_frame_at(m->frame_columns));
    encode_gpr_rr(e, X86_test, X86_32, X86_R12, X86_R12);
    encode_jump_if(e, X86_IF_s, other);
}

/* The address of the first column's texel in the first row of texels. Its number is in r12. */
static void store_texels(struct emitter *m, const struct ir_instruction *note)
{
    struct encoder *e = &m->encoder;
    emit_load_pointer(m, note->base, note->field);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_indexed(X86_RAX, X86_R12, 4, 0));
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_TEXELS), X86_RAX);
}

/* Begins with the first run: its colours, and a copy of its entry, whose y will be that of the next runs. */
static void begin_runs(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const int32_t entry = m->frame_places + LANE_BYTES, below = TILE_RUNS * 4 * BLOCK_PIXELS;
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    encode_gpr_rm(e, X86_movzx16, X86_32, X86_RAX, address_at(ENTRY, offsetof(struct entry, block)));
    encode_gpr_ri(e, X86_shl, X86_32, X86_RAX, COLORS_SHIFT);
    encode_gpr_rm(e, X86_mov, X86_64, COLOR, argument(offsetof(struct pixel_arguments, color)));
    encode_gpr_rr(e, X86_add, X86_64, COLOR, X86_RAX);
    encode_rm(e, X86_vmovups, X86_128, SCRATCH_FIRST, address_at(ENTRY, 0));
    encode_mr(e, X86_vmovups_store, X86_128, emit_frame_at(entry), SCRATCH_FIRST);
    encode_gpr_rm(e, X86_lea, X86_64, ENTRY, emit_frame_at(entry));
    encode_gpr_rm(e, X86_mov, X86_64, X86_R13, emit_frame_at(FRAME_WIDTH));
    encode_gpr_ri(e, X86_shl, X86_64, X86_R13, COLORS_SHIFT - ENTRY_SHIFT);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, address_at(X86_NONE, below + 4 * BLOCK_PIXELS));
    encode_gpr_rr(e, X86_sub, X86_64, X86_RAX, X86_R13);
    encode_gpr_mr(e, X86_mov, X86_64, emit_frame_at(FRAME_STEP), X86_RAX);
}

/* Computes the indices of the next runs' rows of texels. ENTRY gets the y of the runs after them. */
static void write_rows(struct emitter *m, const struct section *s)
{
    enum { SIXTEEN = 0x41800000 /* 16.0 */ };
    struct encoder *e = &m->encoder;
    const struct address y = address_at(ENTRY, offsetof(struct entry, y));
    encode_gpr_rm(e, X86_lea, X86_64, LANES, emit_frame_at(FRAME_LANES - s->place));
    encode_gpr_rm(e, X86_lea, X86_64, ROW, emit_frame_at(m->frame_rows));
    write_section(m, s);
    encode_rm(e, X86_vmovss, X86_128, SCRATCH_FIRST, y);
    encode_rrm(e, X86_vaddps, X86_128, SCRATCH_FIRST, SCRATCH_FIRST,
               emit_literal_address(m, SIXTEEN, LITERAL_LANES));
    encode_mr(e, X86_vmovss_store, X86_128, y, SCRATCH_FIRST);
}

/* Copies the run whose colours are at COLOR, and whose indices of rows are at ROW. COLOR becomes that of the
 * next run. */
static void write_run(struct emitter *m)
{
    static const uint8_t first[2] = {X86_R12, X86_R13}, second[2] = {DEPTH, LANES};
    static const uint8_t *const rows[2] = {first, second};
    struct encoder *e = &m->encoder;
    uint32_t done = encode_add_label(e);
    encode_gpr_rm(e, X86_mov, X86_64, COLUMN, emit_frame_at(FRAME_WIDTH));
    encode_gpr_rm(e, X86_lea, X86_64, COLUMN, address_indexed(COLOR, COLUMN, ENTRY_COLORS, 0));
    encode_gpr_rm(e, X86_mov, X86_64, X86_RAX, emit_frame_at(FRAME_TEXELS));
    for (int row = 0; row < BLOCK_SIZE; row++) {
        enum gpr to = (enum gpr)rows[row / 2][row % 2];
        encode_gpr_rm(e, X86_movsxd, X86_64, to, address_at(ROW, 4 * row));
        encode_gpr_rm(e, X86_lea, X86_64, to, address_indexed(X86_RAX, to, 4, 0));
    }
    encode_gpr_rr(e, X86_xor, X86_32, X86_RAX, X86_RAX);
    emit_copy_run(m, rows, COLUMN, done);
    encode_label(e, done);
    encode_gpr_rr(e, X86_mov, X86_64, COLOR, COLUMN);
    encode_gpr_rm(e, X86_add, X86_64, COLOR, emit_frame_at(FRAME_STEP));
}

static void write_runs(struct emitter *m, const struct section *s)
{
    struct encoder *e = &m->encoder;
    uint32_t group = encode_add_label(e), run = encode_add_label(e), done = encode_add_label(e);
    begin_runs(m);
    encode_label(e, group);
    write_rows(m, s);
    encode_label(e, run);
    write_run(m);
    encode_gpr_mi(e, X86_sub, X86_64, emit_frame_at(FRAME_RUNS), 1);
    encode_jump_if(e, X86_IF_z, done);
    encode_gpr_ri(e, X86_add, X86_64, ROW, RUN_ROWS);
    encode_gpr_rm(e, X86_lea, X86_64, X86_RAX, emit_frame_at(m->frame_rows + GROUP_ROWS));
    encode_gpr_rr(e, X86_cmp, X86_64, ROW, X86_RAX);
    encode_jump_if(e, X86_IF_b, run);
    encode_jump(e, group);
    encode_label(e, done);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_END));
}

/* Other columns are computed as usual, if there are the entries for it. */
static void write_usual(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const struct address tile = argument(offsetof(struct pixel_arguments, tile));
    uint32_t part = encode_add_label(e);
    encode_gpr_rm(e, X86_mov, X86_64, ENTRY, emit_frame_at(FRAME_RUN));
    encode_gpr_mi(e, X86_cmp, X86_32, tile, 0);
    encode_jump_if(e, X86_IF_z, part);
    encode_gpr_mi(e, X86_mov, X86_32, tile, 0);
    encode_jump(e, LABEL_DONE);
    encode_label(e, part);
}

void emit_copy_rectangle(struct emitter *m)
{
    struct encoder *e = &m->encoder;
    const struct section rows = section_of(m->ir, IR_LOOP_ROWS);
    uint32_t usual = encode_add_label(e);
    m->rectangle_done = encode_add_label(e);
    find_width(m, usual);
    store_places(m);
    store_columns(m, usual);
    require_straight(m, usual);
    store_texels(m, m->ir->instruction + rows.end);
    find_height(m);
    write_runs(m, &rows);
    encode_jump(e, m->rectangle_done);
    encode_label(e, usual);
    write_usual(m);
}
