/* The span reading: marks gathers of texels that may be close together in a row, for 8 lanes.
 *
 * After the pass separate, the index of a texel is the sum of a column's value and a row's. Where the texels
 * of a column's pixels are is therefore known before any row is drawn, and where a row of texels begins is
 * known before any block of it is drawn:
 *
 *   columns   near_column x     the least x; whether the texels are next to each other, within eight, or not
 *   rows      near_row y        the address of each row of pixels' texels, in the row's entry
 *   blocks    near              a hint for the sums and the gathers after it
 *
 * The hint's code (emit/gather_near.c) loads eight texels of each of the block's two rows at the row's
 * address plus the least x, and chooses each lane's texel in registers. If the column's texels are further
 * apart, it executes the instructions after the hint.
 *
 * A near_row needs a y that is the same in all pixels of a row: it depends on no constant of the lanes but
 * their y. Compact texels have one or two bytes, and a gather reads a word: the pass proves that nothing
 * reads more of it than the texel, or than the texel and its right neighbour. The pass runs last, because the
 * other passes do not preserve the hint's place. */
#include "contract/job.h"
#include "engines/specialize/passes/pass.h"
#include "ir/near.h"

#include <string.h>

enum { MOST_COLUMNS = 16, MOST_ROWS = 16, MOST_GATHERS = 8, MOST_WORDS = 64 };

struct near_memory {
    uint16_t uses[IR_CAPACITY];
    uint8_t length[IR_CAPACITY]; /* of the first gather of a hint: its gathers, else 0 */
    uint8_t sums[IR_CAPACITY];   /* the same: the sums that move after the hint */
    int32_t hint[IR_CAPACITY];   /* the same: columns and rows (ir/near.h) */
    bool even[IR_CAPACITY];      /* the same in all pixels of a row */
    bool moves[IR_CAPACITY];     /* a sum that moves */
};

static_assert(sizeof(struct near_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* Where a row of texels is noted: its y, and the pointer and the size of its texels. */
struct near_row {
    uint16_t y;
    uint8_t scale;
    int32_t field;
};

/* A column of texels: the offset of x in the column's entry, the bytes of a texel, and whether at most four
 * are read of a row. */
struct near_column {
    int32_t x;
    uint8_t scale;
    bool narrow;
};

struct near {
    struct ir *ir;
    struct pass_memory *pass;
    struct near_memory *memory;
    uint32_t blocks, end;        /* the loop of blocks */
    uint32_t rows_end;           /* the end of the loop of rows */
    uint16_t stored[MOST_WORDS]; /* the value that is stored as each word of a row's entry */
    uint32_t count, hints, columns, rows;
    struct near_column column[MOST_COLUMNS];
    struct near_row row[MOST_ROWS];
};

/* The index of a gather: a column's value, which is loaded from offset `x` of its entry, plus a row's `y`,
 * which is a triangle's value or one that the loop of rows computes. */
struct near_index {
    int32_t x;
    uint16_t y;
};

static void find_loops(struct near *n)
{
    for (uint32_t number = 1; number < n->ir->count && !n->blocks; number++) {
        const struct ir_instruction *i = &n->ir->instruction[number];
        if (i->op == IR_loop && i->k == IR_LOOP_BLOCKS)
            n->blocks = number;
        if (i->op == IR_again && i->k == IR_LOOP_ROWS)
            n->rows_end = number;
        if (i->op == IR_store && i->base == BASE_ROW)
            n->stored[i->k / (int32_t)(n->pass->lanes * 4)] = i->operand[0];
    }
    if (n->blocks)
        n->end = ir_other_end(n->ir, n->blocks);
}

static bool is_even(const struct near *n, const struct ir_instruction *i)
{
    bool even = !(ir_properties(i) & (IR_EFFECT | IR_PLACED));
    if (i->base == BASE_LANES && ir_properties(i) & IR_READS)
        even &= i->k >= (int32_t)offsetof(struct lane_table, y) &&
                i->k < (int32_t)offsetof(struct lane_table, bit);
    else if (i->op == IR_load)
        even = false;
    for (unsigned o = 0; o < ir_operands(i); o++)
        even &= n->memory->even[i->operand[o]];
    return even;
}

static void count_uses(struct near *n)
{
    memset(n->memory->uses, 0, n->ir->count * sizeof n->memory->uses[0]);
    memset(n->memory->length, 0, n->ir->count);
    memset(n->memory->moves, 0, n->ir->count);
    n->memory->even[0] = true;
    for (uint32_t number = 1; number < n->ir->count; number++) {
        const struct ir_instruction *i = &n->ir->instruction[number];
        n->memory->even[number] = is_even(n, i);
        for (unsigned o = 0; o < ir_operands(i); o++)
            n->memory->uses[i->operand[o]]++;
    }
}

/* --- Gathers -------------------------------------------------------------------------------------------- */

/* Returns true if nothing reads more than the low `bits` of a value. */
static bool reads_low(const struct near *n, uint32_t value, unsigned bits)
{
    for (uint32_t number = value + 1; number < n->end && bits < 32; number++) {
        const struct ir_instruction *i = &n->ir->instruction[number];
        for (unsigned o = 0; o < ir_operands(i); o++) {
            const struct ir_instruction *other = &n->ir->instruction[i->operand[!o]];
            bool masked = i->op == IR_and_i && other->op == IR_literal && !((uint32_t)other->k >> bits);
            bool shifted =
                i->op == IR_ushr_i && (uint32_t)i->k < bits && reads_low(n, number, bits - (unsigned)i->k);
            if (i->operand[o] == value && !masked && !shifted)
                return false;
        }
    }
    return true;
}

/* The texels that are read of the word at each: 1; 2 of compact texels, whose word has the right neighbour
 * too; or 0, if it has more. */
static unsigned texels_of_word(const struct near *n, uint32_t gather)
{
    const unsigned bits = 8u * n->ir->instruction[gather].scale;
    if (reads_low(n, gather, bits))
        return 1;
    return reads_low(n, gather, 2 * bits) ? 2 : 0;
}

/* Returns true for gathers of texels, or of their right neighbours: a texture's margin is after both. */
static bool reads_texture(const struct ir_instruction *i)
{
    size_t texture = (size_t)i->field - offsetof(struct job, texture);
    return i->op == IR_gather && i->field != GATHER_DIRECT && i->base == BASE_JOB &&
           texture < sizeof((struct job *)0)->texture &&
           texture % sizeof(struct texture_job) == offsetof(struct texture_job, texels) &&
           (i->scale == 4 ? i->k == 0 || i->k == 4 : !i->k && (i->scale == 2 || i->scale == 1));
}

/* The same of a clip mask's bytes, which have no margin. */
static bool reads_clip_mask(const struct ir_instruction *i)
{
    const int32_t texels = offsetof(struct job, clip_mask) + offsetof(struct clip_mask_job, texels);
    return i->op == IR_gather && i->field == texels && i->base == BASE_JOB && i->scale == 1 && !i->k;
}

/* The value of a row that a chunk loads; others are themselves. */
static uint16_t row_value(const struct near *n, uint16_t value)
{
    const struct ir_instruction *i = &n->ir->instruction[value];
    bool loads = i->op == IR_load && i->base == BASE_ROW;
    return loads ? n->stored[i->k / (int32_t)(n->pass->lanes * 4)] : value;
}

static bool find_index(const struct near *n, uint32_t gather, struct near_index *index)
{
    const struct ir_instruction *sum = &n->ir->instruction[n->ir->instruction[gather].operand[0]];
    for (int o = 0; sum->op == IR_add_i && o < 2; o++) {
        const struct ir_instruction *x = &n->ir->instruction[sum->operand[o]];
        index->x = x->k;
        index->y = row_value(n, sum->operand[1 - o]);
        if (x->op == IR_load && x->base == BASE_COLUMN && index->y < n->rows_end && n->memory->even[index->y])
            return true;
    }
    return false;
}

/* The number of a column of texels, which is added if it is new; MOST_COLUMNS: there are too many. */
static unsigned find_column(struct near *n, struct near_column column)
{
    unsigned c = 0;
    while (c < n->columns && (n->column[c].x != column.x || n->column[c].scale != column.scale ||
                              n->column[c].narrow != column.narrow))
        c++;
    if (c == n->columns && c < MOST_COLUMNS)
        n->column[n->columns++] = column;
    return c;
}

static unsigned find_row(struct near *n, const struct ir_instruction *gather, unsigned y)
{
    unsigned r = 0;
    while (r < n->rows && (n->row[r].y != y || n->row[r].field != gather->field))
        r++;
    if (r == n->rows && r < MOST_ROWS)
        n->row[n->rows++] = (struct near_row){(uint16_t)y, gather->scale, gather->field};
    return r;
}

/* The number of gathers, from `first` on, that have the same column and texture, one of two indices, and
 * equal words. */
static unsigned group_length(const struct near *n, uint32_t first, struct near_index index[2], bool *pairs)
{
    const struct ir_instruction *i = &n->ir->instruction[first];
    unsigned length = 0;
    uint16_t other = 0;
    for (; length < MOST_GATHERS && first + length < n->end; length++) {
        struct near_index at;
        const struct ir_instruction *next = i + length;
        if (!(reads_texture(next) || reads_clip_mask(next)) || next->field != i->field ||
            next->scale != i->scale || !find_index(n, first + length, &at))
            break;
        unsigned texels = texels_of_word(n, first + length);
        if (!length)
            index[0] = index[1] = at, *pairs = texels == 2;
        if (texels != 1u + *pairs || (*pairs && reads_clip_mask(next)))
            break;
        if (at.x != index[0].x || (next->operand[0] != i->operand[0] && other && next->operand[0] != other))
            break;
        if (next->operand[0] != i->operand[0]) {
            other = next->operand[0];
            index[1] = at;
        }
    }
    return length;
}

/* Marks the sums that only these gathers use. Returns their number. */
static unsigned move_sums(struct near *n, uint32_t first, unsigned length)
{
    unsigned moved = 0;
    for (unsigned g = 0; g < length; g++) {
        unsigned sum = n->ir->instruction[first + g].operand[0], uses = 0;
        for (unsigned other = 0; other < length; other++)
            uses += n->ir->instruction[first + other].operand[0] == sum;
        if (n->memory->moves[sum] || uses != n->memory->uses[sum] || sum < n->blocks)
            continue;
        n->memory->moves[sum] = true;
        moved++;
    }
    return moved;
}

static void find_hints(struct near *n)
{
    for (uint32_t number = n->blocks; number < n->end; number++) {
        struct near_index index[2] = {{0, 0}, {0, 0}};
        const struct ir_instruction *i = &n->ir->instruction[number];
        bool pairs = false;
        unsigned length = i->op == IR_gather ? group_length(n, number, index, &pairs) : 0;
        if (!length)
            continue;
        bool bare = reads_clip_mask(i);
        unsigned column = find_column(n, (struct near_column){index[0].x, i->scale, pairs || bare}),
                 upper = find_row(n, i, index[0].y), lower = find_row(n, i, index[1].y);
        if (column == MOST_COLUMNS || upper == MOST_ROWS || lower == MOST_ROWS)
            continue;
        n->memory->hint[number] = ir_near_pack(column, upper, lower, length, pairs, bare);
        n->memory->sums[number] = (uint8_t)move_sums(n, number, length);
        n->memory->length[number] = (uint8_t)length;
        n->hints++;
        number += length - 1;
    }
}

/* --- The program ---------------------------------------------------------------------------------------- */

static struct ir_instruction note_like(const struct ir_instruction *i, enum ir_op op, unsigned operand,
                                       int32_t k)
{
    return (struct ir_instruction){.op = (uint8_t)op,
                                   .base = BASE_JOB,
                                   .scale = i->scale,
                                   .operand = {(uint16_t)operand},
                                   .line = i->line,
                                   .file = i->file,
                                   .origin = i->origin,
                                   .k = k,
                                   .field = i->field};
}

static void append_hint(struct near *n, uint32_t number)
{
    const struct ir_instruction *i = &n->ir->instruction[number];
    struct ir_instruction hint = note_like(i, IR_near, 0, n->memory->hint[number]);
    hint.scale = (uint8_t)(n->memory->length[number] + n->memory->sums[number]);
    n->pass->rebuilt[n->count++] = hint;
    for (unsigned g = 0; g < n->memory->length[number]; g++) {
        unsigned sum = i[g].operand[0];
        if (!n->memory->moves[sum])
            continue;
        n->memory->moves[sum] = false;
        pass_append(n->ir, n->pass, sum, &n->count);
    }
}

/* After a column's store. */
static void append_columns(struct near *n, const struct ir_instruction *store)
{
    for (unsigned c = 0; c < n->columns; c++) {
        if (n->column[c].x != store->k)
            continue;
        struct ir_instruction note =
            note_like(store, IR_near_column, n->pass->map[store->operand[0]], (int32_t)c);
        note.scale = n->column[c].scale;
        note.field = n->column[c].narrow;
        n->pass->rebuilt[n->count++] = note;
    }
}

static void append_rows(struct near *n)
{
    for (unsigned r = 0; r < n->rows; r++) {
        const struct near_row *row = &n->row[r];
        struct ir_instruction note =
            note_like(&n->ir->instruction[row->y], IR_near_row, n->pass->map[row->y], (int32_t)r);
        note.scale = row->scale;
        note.field = row->field;
        n->pass->rebuilt[n->count++] = note;
    }
}

static void rebuild(struct near *n)
{
    n->count = pass_rebuild(n->ir, n->pass);
    for (uint32_t number = 1; number < n->ir->count; number++) {
        const struct ir_instruction *i = &n->ir->instruction[number];
        if (number == n->rows_end)
            append_rows(n);
        if (n->memory->length[number])
            append_hint(n, number);
        if (n->memory->moves[number])
            continue;
        pass_append(n->ir, n->pass, number, &n->count);
        if (i->op == IR_store && i->base == BASE_COLUMN)
            append_columns(n, i);
    }
    pass_replace(n->ir, n->pass, n->count);
}

unsigned pass_near(struct ir *ir, struct pass_memory *memory)
{
    struct near n = {.ir = ir, .pass = memory, .memory = pass_scratch(memory, sizeof *n.memory)};
    if (!ir->separated || ir->near_columns || memory->lanes != 8 || ir->count > IR_CAPACITY / 2)
        return 0;
    ir_compact(ir, memory->map);
    find_loops(&n);
    count_uses(&n);
    find_hints(&n);
    uint32_t words = ir->column_words + ir_near_words(n.columns, memory->lanes);
    if (!n.hints || words > MOST_WORDS)
        return 0;
    rebuild(&n);
    ir->near_words = ir->column_words;
    ir->near_columns = n.columns;
    ir->near_rows = n.rows;
    ir->column_words = words;
    return n.hints;
}
