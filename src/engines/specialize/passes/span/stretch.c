/* The span reading: rows of texels that are filtered linearly are blended along u once, for 8 lanes.
 *
 * Bilinear filtering blends the texels of two rows along u, and the two results along v. Where an image is
 * magnified, neighbouring rows of pixels have rows of texels in common. A row of texels that is blended along
 * u, for all columns of pixels, is a stretched row. The pass finds the values of blocks that depend only on a
 * column and on a row of texels, and adds two loops before the loop of blocks:
 *
 *   loop chunks
 *     loop stretch   the values of a row of texels for two blocks' columns, stores to the stretched row
 *     loop pairs     loads from four stretched rows, all other values of two blocks
 *     loop blocks    as before
 *
 * The first one is executed for each row of texels that a chunk of pixels needs and the chunks before it did
 * not. Its eight lanes are the columns of pixels of two blocks, so that each value is computed once:
 *
 *   a stretched row        s0 s1 s4 s5 | s2 s3 s6 s7
 *   two, the first block   s0 s1 t0 t1 | s2 s3 t2 t3
 *   the second block       s4 s5 t4 t5 | s6 s7 t6 t7
 *
 * Runs whose columns or rows are further apart have the loop of blocks, and so has the last block of an odd
 * number (emit/stretch.c). For one chunk of a block, the new loops run zero times.
 *
 * The pass runs after `near`, because it needs the addresses of rows of texels that this pass notes. */
#include "contract/job.h"
#include "engines/specialize/passes/pass.h"
#include "ir/near.h"

#include <string.h>

/* LONGEST: the instructions of a loop of blocks. A longer one saves little by stretched rows, and its loop of
 * pairs, with twice as many, would be more code than a processor keeps decoded. */
enum { LONGEST = 224, MOST_WORDS = 4, BLOCK_BYTES = 4 * BLOCK_PIXELS, BLOCKS = 2, HINTS = 2 };

/* The sources of a value of the loop of blocks. The first two are a row of texels. */
enum side { UPPER = 1, LOWER = 2, COLUMN = 4, REST = 8 };

struct stretch_memory {
    uint8_t side[LONGEST];  /* of an instruction of the loop of blocks */
    uint16_t mate[LONGEST]; /* the same value of the other row of texels, a position in the loop; 0: none */
    uint16_t word[LONGEST]; /* of an upper value: 1 + its word in a stretched row; 0: it has none */
    uint16_t made[LONGEST]; /* the number of its copy in the loop stretch */
    uint16_t copy[BLOCKS][LONGEST];         /* the same in the loop pairs, for each block */
    uint16_t loaded[BLOCKS][2][MOST_WORDS]; /* the same: the words of a stretched row; 0: not yet loaded */
};

static_assert(sizeof(struct stretch_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct stretch {
    struct ir *ir;
    struct pass_memory *pass;
    struct stretch_memory *memory;
    uint32_t chunks, blocks, end; /* the loop of chunks; the loop of blocks */
    uint32_t hint[HINTS];         /* 0: there is none */
    uint32_t upper;               /* the index of the upper row's texels */
    uint32_t count, words;
    uint16_t value[MOST_WORDS]; /* of a word of a stretched row: the upper value */
    int32_t x;                  /* where a column's entry has the first texels' indices */
};

static const struct ir_instruction *at(const struct stretch *s, uint32_t number)
{
    return &s->ir->instruction[number];
}

static bool is_inside(const struct stretch *s, uint32_t number)
{
    return number > s->blocks && number < s->end;
}

/* --- Loops ---------------------------------------------------------------------------------------------- */

/* Returns true if an instruction reads an entry or constants of the lanes. */
static bool reads_places(const struct ir_instruction *i)
{
    return ir_properties(i) & IR_READS && (i->base == BASE_ENTRY || i->base == BASE_LANES);
}

/* Finds the loops. Returns false if the chunks read entries or constants of the lanes: the registers of their
 * addresses have other uses in the new loops, and these reads may become operands there. */
static bool find_loops(struct stretch *s)
{
    bool free = true;
    for (uint32_t number = 1; number < s->ir->count; number++) {
        const struct ir_instruction *i = at(s, number);
        if (i->op == IR_loop && i->k == IR_LOOP_CHUNKS)
            s->chunks = number;
        if (i->op == IR_loop && i->k == IR_LOOP_BLOCKS)
            s->blocks = number;
        if (i->op == IR_again && i->k == IR_LOOP_BLOCKS)
            s->end = number;
        free &= !s->chunks || s->end || !reads_places(i);
    }
    return free && s->blocks && s->end - s->blocks < LONGEST;
}

/* The gathers of a hint are its last instructions. */
static uint32_t first_gather(const struct stretch *s, uint32_t hint)
{
    return hint + at(s, hint)->scale + 1 - ir_near_gathers(at(s, hint)->k);
}

static uint32_t next_hint(const struct stretch *s, uint32_t number)
{
    while (number < s->end && at(s, number)->op != IR_near)
        number++;
    return number < s->end ? number : 0;
}

/* Returns true if a hint is for `gathers` gathers of texels of `scale` bytes, in the first hint's column and
 * texture. */
static bool is_hint(const struct stretch *s, uint32_t hint, unsigned gathers, unsigned scale)
{
    const struct ir_instruction *i = at(s, hint), *first = at(s, s->hint[0]);
    return ir_near_gathers(i->k) == gathers && at(s, first_gather(s, hint))->scale == scale &&
           ir_near_pairs(i->k) == (scale == 1) && !ir_near_bare(i->k) && i->field == first->field &&
           ir_near_column(i->k) == ir_near_column(first->k);
}

/* Finds the hints of four texels, in two rows that follow each other: one for four gathers of words, or two,
 * each for a gather of a byte and its right neighbour. */
static bool find_hints(struct stretch *s)
{
    s->hint[0] = next_hint(s, s->blocks);
    s->hint[1] = s->hint[0] ? next_hint(s, s->hint[0] + 1) : 0;
    if (!s->hint[0] || (s->hint[1] && next_hint(s, s->hint[1] + 1)))
        return false;
    const bool two = s->hint[1], square = two ? is_hint(s, s->hint[0], 1, 1) && is_hint(s, s->hint[1], 1, 1)
                                              : is_hint(s, s->hint[0], 4, 4);
    const int32_t k = at(s, s->hint[0])->k;
    const unsigned lower = two ? ir_near_row(at(s, s->hint[1])->k, 0) : ir_near_row(k, 1);
    s->upper = at(s, first_gather(s, s->hint[0]))->operand[0];
    return square && lower == ir_near_row(k, 0) + 1;
}

/* Returns true if an instruction is a gather of a hint. */
static bool is_hinted(const struct stretch *s, uint32_t number)
{
    bool hinted = false;
    for (unsigned h = 0; h < HINTS && s->hint[h]; h++)
        hinted |= number >= first_gather(s, s->hint[h]) && number <= s->hint[h] + at(s, s->hint[h])->scale;
    return hinted;
}

/* Returns true if an instruction is a hint, or the sum of an index for its gathers. */
static bool is_sum(const struct stretch *s, uint32_t number)
{
    bool sum = false;
    for (unsigned h = 0; h < HINTS && s->hint[h]; h++)
        sum |= number >= s->hint[h] && number < first_gather(s, s->hint[h]);
    return sum;
}

/* Finds where a column's entry has the indices that the hint's column notes. */
static bool find_x(struct stretch *s)
{
    uint16_t noted = 0;
    const int32_t column = (int32_t)ir_near_column(at(s, s->hint[0])->k);
    for (uint32_t number = 1; number < s->chunks; number++)
        if (at(s, number)->op == IR_near_column && at(s, number)->k == column)
            noted = at(s, number)->operand[0];
    for (uint32_t number = 1; number < s->chunks; number++)
        if (at(s, number)->op == IR_store && at(s, number)->base == BASE_COLUMN &&
            at(s, number)->operand[0] == noted) {
            s->x = at(s, number)->k;
            return noted;
        }
    return false;
}

/* --- Sides ---------------------------------------------------------------------------------------------- */

static unsigned side_of_operand(const struct stretch *s, unsigned value)
{
    const struct ir_instruction *i = at(s, value);
    if (!value || i->op == IR_literal || i->op == IR_constant || value < s->chunks)
        return 0;
    return is_inside(s, value) ? s->memory->side[value - s->blocks] : REST;
}

static unsigned side_of(const struct stretch *s, uint32_t number)
{
    const struct ir_instruction *i = at(s, number);
    unsigned operands = 0;
    if (i->op == IR_gather)
        return i->operand[0] == s->upper ? UPPER : LOWER;
    if (i->op == IR_load && i->base == BASE_COLUMN)
        return COLUMN;
    for (unsigned o = 0; o < ir_operands(i); o++)
        operands |= side_of_operand(s, i->operand[o]);
    const unsigned rows = operands & (UPPER | LOWER);
    const bool one = rows == UPPER || rows == LOWER, computes = ir_properties(i) & IR_COMPUTES;
    return one && computes && !(operands & REST) && i->type != TYPE_msk ? rows : REST;
}

/* Returns true if an instruction of the rest can be in the loop pairs: it computes or accesses a colour. */
static bool may_pair(const struct ir_instruction *i)
{
    const bool colors = (i->op == IR_load || i->op == IR_store) && i->base == BASE_COLOR;
    return colors || i->op == IR_literal || i->op == IR_constant || ir_properties(i) & IR_COMPUTES;
}

/* Notes the side of each instruction. The sums of a hint have none. */
static bool find_sides(struct stretch *s)
{
    for (uint32_t number = s->blocks + 1; number < s->end; number++) {
        const struct ir_instruction *i = at(s, number);
        const unsigned side = is_sum(s, number) ? 0 : side_of(s, number);
        if ((i->op == IR_gather && !is_hinted(s, number)) || (side == REST && !may_pair(i)))
            return false;
        s->memory->side[number - s->blocks] = (uint8_t)side;
    }
    return true;
}

/* --- Words ---------------------------------------------------------------------------------------------- */

static bool same_operand(const struct stretch *s, unsigned upper, unsigned lower)
{
    const struct ir_instruction *a = at(s, upper), *b = at(s, lower);
    const unsigned side = side_of_operand(s, lower);
    if (side == LOWER)
        return is_inside(s, upper) && s->memory->mate[lower - s->blocks] == upper - s->blocks;
    const bool column = side == COLUMN && side_of_operand(s, upper) == COLUMN && a->k == b->k;
    const bool literal = a->op == b->op && (a->op == IR_literal || a->op == IR_constant) && a->k == b->k;
    return upper == lower || column || literal;
}

static bool same_value(const struct stretch *s, uint32_t upper, uint32_t lower)
{
    const struct ir_instruction *a = at(s, upper), *b = at(s, lower);
    if (a->op != b->op || a->type != b->type || a->k != b->k || a->field != b->field || a->scale != b->scale)
        return false;
    for (unsigned o = 0; o < ir_operands(a) && a->op != IR_gather; o++)
        if (!same_operand(s, a->operand[o], b->operand[o]))
            return false;
    return true;
}

/* Finds the upper value of each lower one, which the specification computes in the same way. */
static void find_mates(struct stretch *s)
{
    memset(s->memory->mate, 0, sizeof s->memory->mate);
    for (uint32_t lower = s->blocks + 1; lower < s->end; lower++)
        for (uint32_t upper = s->blocks + 1; upper < s->end; upper++) {
            uint16_t *mate = s->memory->mate;
            if (s->memory->side[lower - s->blocks] != LOWER || s->memory->side[upper - s->blocks] != UPPER ||
                mate[upper - s->blocks] || !same_value(s, upper, lower))
                continue;
            mate[lower - s->blocks] = (uint16_t)(upper - s->blocks);
            mate[upper - s->blocks] = (uint16_t)(lower - s->blocks);
            break;
        }
}

/* The upper value of a stretched row's value: itself or its mate; 0: it has none. */
static uint32_t upper_of(const struct stretch *s, uint32_t value)
{
    const uint32_t place = value - s->blocks;
    return s->memory->side[place] == UPPER ? value
           : s->memory->mate[place]        ? s->blocks + s->memory->mate[place]
                                           : 0;
}

/* Gives a word to what the rest reads of stretched rows. */
static bool find_words(struct stretch *s)
{
    memset(s->memory->word, 0, sizeof s->memory->word);
    for (uint32_t number = s->blocks + 1; number < s->end; number++) {
        const struct ir_instruction *i = at(s, number);
        for (unsigned o = 0; s->memory->side[number - s->blocks] == REST && o < ir_operands(i); o++) {
            if (!(side_of_operand(s, i->operand[o]) & (UPPER | LOWER)))
                continue;
            const uint32_t upper = upper_of(s, i->operand[o]);
            if (!upper || (s->words == MOST_WORDS && !s->memory->word[upper - s->blocks]))
                return false;
            if (s->memory->word[upper - s->blocks])
                continue;
            s->value[s->words++] = (uint16_t)upper;
            s->memory->word[upper - s->blocks] = (uint16_t)s->words;
        }
    }
    return s->words;
}

/* --- The program ---------------------------------------------------------------------------------------- */

static uint16_t insert(struct stretch *s, struct ir_instruction instruction)
{
    s->pass->rebuilt[s->count] = instruction;
    return (uint16_t)s->count++;
}

static void open_loop(struct stretch *s, enum ir_loop kind, int32_t field)
{
    insert(s, (struct ir_instruction){.op = IR_loop, .k = kind, .field = field});
    s->ir->loops++;
}

static void close_loop(struct stretch *s, enum ir_loop kind)
{
    const uint16_t never = s->pass->map[at(s, s->end)->operand[0]];
    insert(s, (struct ir_instruction){.op = IR_again, .operand = {never}, .k = kind});
}

static struct ir_instruction like(const struct ir_instruction *from, enum ir_op op, int32_t k)
{
    return (struct ir_instruction){.op = (uint8_t)op,
                                   .type = op == IR_store ? TYPE_non : from->type,
                                   .line = from->line,
                                   .file = from->file,
                                   .origin = from->origin,
                                   .k = k};
}

/* The operand of an instruction of the loop stretch. Loads and literals of the loop of blocks are copied. */
static uint16_t stretch_operand(struct stretch *s, unsigned value)
{
    if (!is_inside(s, value))
        return s->pass->map[value];
    return s->memory->side[value - s->blocks] == UPPER ? s->memory->made[value - s->blocks]
                                                       : insert(s, *at(s, value));
}

static void append_stretched_value(struct stretch *s, uint32_t number)
{
    struct ir_instruction i = *at(s, number);
    for (unsigned o = 0; i.op != IR_gather && o < ir_operands(&i); o++)
        i.operand[o] = stretch_operand(s, i.operand[o]);
    if (i.op == IR_gather) {
        i = like(at(s, number), IR_stretch, i.k);
        i.scale = at(s, number)->scale;
    }
    s->memory->made[number - s->blocks] = insert(s, i);
}

static void append_stretch(struct stretch *s)
{
    open_loop(s, IR_LOOP_STRETCH, at(s, s->hint[0])->k);
    for (uint32_t number = s->blocks + 1; number < s->end; number++)
        if (s->memory->side[number - s->blocks] == UPPER)
            append_stretched_value(s, number);
    for (uint32_t word = 0; word < s->words; word++) {
        struct ir_instruction store =
            like(at(s, s->value[word]), IR_store, (int32_t)(word * s->pass->lanes * 4));
        store.base = BASE_STRETCHED;
        store.operand[0] = s->memory->made[s->value[word] - s->blocks];
        insert(s, store);
    }
    close_loop(s, IR_LOOP_STRETCH);
}

/* Loads a word of both blocks from the stretched rows, directly before its first use. */
static uint16_t load_stretched(struct stretch *s, unsigned value, unsigned block)
{
    const unsigned lower = s->memory->side[value - s->blocks] == LOWER;
    const uint32_t word = s->memory->word[upper_of(s, value) - s->blocks] - 1u;
    const bool loaded = s->memory->loaded[block][lower][word];
    for (unsigned b = 0; b < BLOCKS && !loaded; b++) {
        struct ir_instruction load = like(at(s, value), IR_stretched, (int32_t)(word * s->pass->lanes * 4));
        load.scale = (uint8_t)b;
        load.field = (int32_t)lower;
        s->memory->loaded[b][lower][word] = insert(s, load);
    }
    return s->memory->loaded[block][lower][word];
}

/* Loads a value of the block's column. The columns of both blocks follow each other. */
static uint16_t load_column(struct stretch *s, unsigned value, unsigned block)
{
    struct ir_instruction load = *at(s, value);
    load.k += (int32_t)(block * s->ir->column_words * s->pass->lanes * 4);
    return insert(s, load);
}

static uint16_t pair_operand(struct stretch *s, unsigned value, unsigned block)
{
    if (!is_inside(s, value))
        return s->pass->map[value];
    switch (s->memory->side[value - s->blocks]) {
    case REST: return s->memory->copy[block][value - s->blocks];
    case COLUMN: return load_column(s, value, block);
    default: return load_stretched(s, value, block);
    }
}

static void append_pairs(struct stretch *s)
{
    memset(s->memory->loaded, 0, sizeof s->memory->loaded);
    open_loop(s, IR_LOOP_PAIRS, s->x);
    for (uint32_t number = s->blocks + 1; number < s->end; number++)
        for (unsigned block = 0; block < BLOCKS && s->memory->side[number - s->blocks] == REST; block++) {
            struct ir_instruction i = *at(s, number);
            for (unsigned o = 0; o < ir_operands(&i); o++)
                i.operand[o] = pair_operand(s, i.operand[o], block);
            if (i.op == IR_load || i.op == IR_store)
                i.k += (int32_t)(block * BLOCK_BYTES);
            s->memory->copy[block][number - s->blocks] = insert(s, i);
        }
    close_loop(s, IR_LOOP_PAIRS);
}

static void rebuild(struct stretch *s)
{
    s->count = pass_rebuild(s->ir, s->pass);
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (number == s->blocks) {
            append_stretch(s);
            append_pairs(s);
        }
        pass_append(s->ir, s->pass, number, &s->count);
    }
    pass_replace(s->ir, s->pass, s->count);
}

unsigned pass_stretch(struct ir *ir, struct pass_memory *memory)
{
    struct stretch s = {.ir = ir, .pass = memory, .memory = pass_scratch(memory, sizeof *s.memory)};
    const bool possible = ir->near_columns && !ir->stretch_words && ir->chunks == 1 && memory->lanes == 8;
    if (!possible || ir->count > IR_CAPACITY / 2 || !find_loops(&s) || !find_hints(&s) || !find_x(&s) ||
        !find_sides(&s))
        return 0;
    find_mates(&s);
    if (!find_words(&s))
        return 0;
    rebuild(&s);
    ir->stretch_words = s.words;
    return s.words;
}
