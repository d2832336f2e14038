/* The span reading: separates what is computed for a triangle, for a column of pixels, for a row, and for a
 * block. docs/spans.md has an example.
 *
 * In blocks of the span reading (the key's field `span`) the specification evaluates most planes along one
 * axis. Each value of the recording then belongs to one of these classes, by what it reads:
 *
 *   triangle  the job, the record, literals
 *   column    also the block's x, and the lanes' x, which are the same in each chunk of a block
 *   row       also the block's y, and the lanes' y and other constants of the chunk
 *   block     also both, or the target; and everything whose position matters
 *
 * The pass makes six loops of the program, which the frame's code repeats (emit/span.c). A value that a
 * column computes and a block reads goes through a table at COLUMN, which has an entry for each of the tile's
 * columns of blocks. So does a value of a row, through a table at ROW, which has an entry for each chunk of
 * the next runs of blocks: a row's values depend on each other one by one, so the processor computes those of
 * several rows together, and not each row's while its first block waits for them:
 *
 *   loop triangles
 *     values of triangles
 *     loop columns   values of columns, stores to the table   again
 *     loop runs
 *       loop rows    values of rows, stores to their table    again
 *       loop chunks
 *         loads from the table of rows
 *         loop blocks   loads from the table of columns, values of blocks    again
 *       again
 *     again
 *   again
 *
 * For one chunk of a block, with each loop run once, the program has the same results as before.
 *
 * A mask cannot be stored. One that a block needs of a column is computed again for the block, and of a row
 * for the chunk; so are a row's constants of the lanes, and its values for which the table has no room. A
 * gather moves only from where it certainly runs. The pass runs after the repeated ones, before those that
 * load operands of loops in advance. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { COLUMN = 1, ROW = 2, BLOCK = 4 };

/* The form in which a block gets a value of its column or row. Those of rows are loaded before the blocks. */
enum need { NEED_NOTHING, NEED_LOAD, NEED_EARLY_LOAD, NEED_AGAIN };

/* The most words of a column's entry: 16 entries with 8 lanes have 32 KiB then. And of a row's. */
enum { WORDS = 64, ROW_WORDS = 32 };

struct separate_memory {
    uint8_t class[IR_CAPACITY];
    uint8_t need[IR_CAPACITY];
    uint8_t word[IR_CAPACITY]; /* in the column's or the row's entry */
    bool wanted[IR_CAPACITY];  /* a value of a row that is stored, or that such values are computed from */
};

static_assert(sizeof(struct separate_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct separation {
    struct ir *ir;
    struct pass_memory *pass;
    struct separate_memory *memory;
    uint32_t count, words, row_words;
    uint16_t never; /* a literal mask of no lanes */
};

/* --- Classes -------------------------------------------------------------------------------------------- */

static unsigned class_of_entry(int32_t offset)
{
    switch (offset) {
    case offsetof(struct entry, x): return COLUMN;
    case offsetof(struct entry, y): return ROW;
    default: return BLOCK;
    }
}

static unsigned class_of_lanes(int32_t offset)
{
    switch (offset) {
    case offsetof(struct lane_table, x): return COLUMN;
    case offsetof(struct lane_table, y):
    case offsetof(struct lane_table, bit):
    case offsetof(struct lane_table, dither): return ROW;
    default: return BLOCK;
    }
}

/* The class of what an instruction reads, apart from its operands. */
static unsigned class_of_memory(const struct ir_instruction *i, bool certain)
{
    switch (i->base) {
    case BASE_JOB:
    case BASE_CONSTANT: return i->op == IR_uniform || certain ? 0 : BLOCK;
    case BASE_TRIANGLE: return i->op == IR_uniform ? 0 : BLOCK;
    case BASE_ENTRY: return i->op == IR_uniform ? class_of_entry(i->k) : BLOCK;
    case BASE_LANES: return i->op == IR_load ? class_of_lanes(i->k) : BLOCK;
    default: return BLOCK;
    }
}

static unsigned class_of(const struct separation *s, const struct ir_instruction *i, bool certain)
{
    unsigned properties = ir_properties(i), class = 0;
    if (properties & (IR_EFFECT | IR_PLACED | IR_WRITES))
        return BLOCK;
    if (properties & IR_READS)
        class = class_of_memory(i, certain);
    for (unsigned o = 0; o < ir_operands(i); o++)
        class |= s->memory->class[i->operand[o]];
    return class & BLOCK || class == (COLUMN | ROW) ? BLOCK : class;
}

static void classify(struct separation *s)
{
    unsigned depth = 0;
    s->memory->class[0] = 0;
    for (uint32_t number = 1; number < s->ir->count; number++) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        depth += i->op == IR_when;
        depth -= i->op == IR_end;
        s->memory->class[number] = (uint8_t)class_of(s, i, !depth);
    }
}

/* --- The table ------------------------------------------------------------------------------------------ */

/* Nothing may be between a region's end and its joins, or before a loop and its end and their phis. */
static bool has_fixed_place(const struct ir_instruction *i)
{
    return i->op == IR_join || i->op == IR_phi || i->op == IR_next;
}

/* The use of a value of a row by a chunk, in which words of the lanes and of the entry can still be read. */
static void need_of_row(struct separation *s, unsigned value)
{
    const struct ir_instruction *i = &s->ir->instruction[value];
    bool near = ir_properties(i) & IR_READS && (i->base == BASE_ENTRY || i->base == BASE_LANES);
    if (s->memory->need[value] != NEED_NOTHING)
        return;
    if (i->type == TYPE_msk || near || s->row_words == ROW_WORDS) {
        s->memory->need[value] = NEED_AGAIN;
        return;
    }
    s->memory->need[value] = NEED_EARLY_LOAD;
    s->memory->word[value] = (uint8_t)s->row_words++;
    s->memory->wanted[value] = true;
}

static void need(struct separation *s, const struct ir_instruction *user, unsigned value)
{
    uint8_t *needed = &s->memory->need[value];
    if (s->memory->class[value] == ROW)
        need_of_row(s, value);
    if (s->memory->class[value] != COLUMN)
        return;
    if (s->ir->instruction[value].type == TYPE_msk)
        *needed = NEED_AGAIN;
    else if (has_fixed_place(user))
        *needed = NEED_EARLY_LOAD;
    else if (*needed == NEED_NOTHING)
        *needed = NEED_LOAD;
}

static bool is_loaded(const struct separation *s, unsigned value)
{
    unsigned needed = s->memory->need[value];
    return needed == NEED_LOAD || needed == NEED_EARLY_LOAD;
}

/* Walks from back to front, since a mask that is computed again has operands. Returns false if the table
 * would be too large. */
static bool find_needs(struct separation *s)
{
    memset(s->memory->need, NEED_NOTHING, s->ir->count);
    memset(s->memory->wanted, 0, s->ir->count * sizeof s->memory->wanted[0]);
    for (uint32_t number = s->ir->count - 1; number > 0; number--) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        bool again = s->memory->class[number] == BLOCK || s->memory->need[number] == NEED_AGAIN;
        for (unsigned o = 0; o < ir_operands(i); o++) {
            if (again)
                need(s, i, i->operand[o]);
            s->memory->wanted[i->operand[o]] |= s->memory->wanted[number];
        }
    }
    for (uint32_t number = 1; number < s->ir->count && s->words <= WORDS; number++)
        if (s->memory->class[number] == COLUMN && is_loaded(s, number))
            s->memory->word[number] = (uint8_t)s->words++;
    return s->words <= WORDS;
}

/* --- The program ---------------------------------------------------------------------------------------- */

static uint16_t insert(struct separation *s, struct ir_instruction instruction)
{
    s->pass->rebuilt[s->count] = instruction;
    return (uint16_t)s->count++;
}

static void open_loop(struct separation *s, enum ir_loop kind)
{
    insert(s, (struct ir_instruction){.op = IR_loop, .k = kind});
    s->ir->loops++;
}

static void close_loop(struct separation *s, enum ir_loop kind)
{
    insert(s, (struct ir_instruction){.op = IR_again, .operand = {s->never}, .k = kind});
}

/* An access to the word of a column's or a row's value. */
static struct ir_instruction table_word(const struct separation *s, enum ir_op op, unsigned value)
{
    struct ir_instruction i = s->ir->instruction[value];
    return (struct ir_instruction){.op = (uint8_t)op,
                                   .type = op == IR_load ? i.type : TYPE_non,
                                   .base = s->memory->class[value] == ROW ? BASE_ROW : BASE_COLUMN,
                                   .line = i.line,
                                   .file = i.file,
                                   .origin = i.origin,
                                   .k = (int32_t)(s->memory->word[value] * s->pass->lanes * 4)};
}

static void append_class(struct separation *s, unsigned class)
{
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (s->memory->class[number] != class || s->ir->instruction[number].op == IR_nop ||
            (class == ROW && !s->memory->wanted[number]))
            continue;
        pass_append(s->ir, s->pass, number, &s->count);
        if (!is_loaded(s, number))
            continue;
        struct ir_instruction store = table_word(s, IR_store, number);
        store.operand[0] = s->pass->map[number];
        insert(s, store);
    }
}

static void append_columns(struct separation *s)
{
    if (!s->words)
        return;
    open_loop(s, IR_LOOP_COLUMNS);
    append_class(s, COLUMN);
    close_loop(s, IR_LOOP_COLUMNS);
}

static void load_early(struct separation *s)
{
    for (uint32_t number = 1; number < s->ir->count; number++)
        if (s->memory->class[number] == COLUMN && s->memory->need[number] == NEED_EARLY_LOAD)
            s->pass->map[number] = insert(s, table_word(s, IR_load, number));
}

/* Each instruction has loads of its own, so that they can become its operands in memory. */
static void append_in_block(struct separation *s, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (s->memory->need[i->operand[o]] == NEED_LOAD)
            s->pass->map[i->operand[o]] = insert(s, table_word(s, IR_load, i->operand[o]));
    pass_append(s->ir, s->pass, number, &s->count);
}

static void append_blocks(struct separation *s)
{
    open_loop(s, IR_LOOP_BLOCKS);
    load_early(s);
    for (uint32_t number = 1; number < s->ir->count; number++)
        if ((s->memory->class[number] == BLOCK && s->ir->instruction[number].op != IR_nop) ||
            (s->memory->class[number] == COLUMN && s->memory->need[number] == NEED_AGAIN))
            append_in_block(s, number);
    close_loop(s, IR_LOOP_BLOCKS);
}

static void append_chunks(struct separation *s)
{
    open_loop(s, IR_LOOP_CHUNKS);
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (s->memory->class[number] != ROW)
            continue;
        if (s->memory->need[number] == NEED_AGAIN)
            pass_append(s->ir, s->pass, number, &s->count);
        else if (is_loaded(s, number))
            s->pass->map[number] = insert(s, table_word(s, IR_load, number));
    }
    append_blocks(s);
    close_loop(s, IR_LOOP_CHUNKS);
}

static void rebuild(struct separation *s)
{
    s->count = pass_rebuild(s->ir, s->pass);
    s->never = insert(s, (struct ir_instruction){.op = IR_literal, .type = TYPE_msk});
    open_loop(s, IR_LOOP_TRIANGLES);
    append_class(s, 0);
    append_columns(s);
    open_loop(s, IR_LOOP_RUNS);
    open_loop(s, IR_LOOP_ROWS);
    append_class(s, ROW);
    close_loop(s, IR_LOOP_ROWS);
    append_chunks(s);
    close_loop(s, IR_LOOP_RUNS);
    close_loop(s, IR_LOOP_TRIANGLES);
    pass_replace(s->ir, s->pass, s->count);
}

unsigned pass_separate(struct ir *ir, struct pass_memory *memory)
{
    enum { MOST = IR_CAPACITY / 8 }; /* each instruction may get three loads, a store and a copy */
    struct separation s = {.ir = ir, .pass = memory, .memory = pass_scratch(memory, sizeof *s.memory)};
    bool whole = memory->lanes == 8 || memory->lanes == 16;
    if (!ir->span || ir->separated || ir->subroutines || memory->parts > 1 || !whole || ir->count > MOST)
        return 0;
    classify(&s);
    if (!find_needs(&s))
        return 0;
    rebuild(&s);
    ir->separated = true;
    ir->column_words = s.words;
    ir->row_words = s.row_words;
    return ir->count;
}
