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
 * With 8 lanes a block has two chunks. Where their values have room in registers, a pass of the loops of rows
 * and of blocks computes both, so that its own instructions, and what both chunks have of a column, are
 * executed once. The loops of rows and of blocks then have most instructions twice, and those of the second
 * chunk access the memory of the lanes after the first. The instructions up to the gather, if there is one,
 * alternate, so that one hint serves both gathers (near.c); from there on, those of the first chunk are
 * before those of the second, so that each needs only its own registers.
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
    uint8_t word[IR_CAPACITY];    /* in the column's or the row's entry */
    bool wanted[IR_CAPACITY];     /* a value of a row that is stored, or that such values are computed from */
    bool each[IR_CAPACITY];       /* a value that differs from chunk to chunk; known if there are two */
    uint16_t second[IR_CAPACITY]; /* the new number of such a value in the second chunk */
    uint16_t last[IR_CAPACITY];   /* its last use in the loop of blocks */
};

static_assert(sizeof(struct separate_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct separation {
    struct ir *ir;
    struct pass_memory *pass;
    struct separate_memory *memory;
    uint32_t count, words, row_words, chunks;
    uint32_t gather; /* the only gather of the blocks; 0: there is none */
    uint16_t never;  /* a literal mask of no lanes */
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

/* --- Chunks --------------------------------------------------------------------------------------------- */

/* The registers for the values of both chunks; the code of instructions needs three of the 16. */
enum { ROOM = 12 };

static void find_last_uses(struct separation *s)
{
    memset(s->memory->last, 0, s->ir->count * sizeof s->memory->last[0]);
    for (uint32_t number = 1; number < s->ir->count; number++) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        for (unsigned o = 0; s->memory->class[number] == BLOCK && o < ir_operands(i); o++)
            s->memory->last[i->operand[o]] = (uint16_t)number;
    }
}

/* The values of the blocks that an instruction is the last to use. */
static uint32_t count_ended(const struct separation *s, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    uint32_t ended = 0;
    for (unsigned o = 0; o < ir_operands(i); o++)
        ended += (!o || i->operand[o] != i->operand[o - 1]) && s->memory->class[i->operand[o]] == BLOCK &&
                 s->memory->last[i->operand[o]] == number;
    return ended;
}

/* The most values of a chunk in the loop of blocks that are used later, from any position on. */
static uint32_t most_waiting(const struct separation *s)
{
    uint32_t waiting = 0, most = 0;
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (s->memory->class[number] != BLOCK)
            continue;
        waiting = waiting + (s->memory->last[number] != 0) - count_ended(s, number);
        most = waiting > most ? waiting : most;
    }
    return most;
}

/* The values of a row that blocks read, each in a register. */
static uint32_t count_row_values(const struct separation *s)
{
    uint32_t count = 0;
    for (uint32_t number = 1; number < s->ir->count; number++)
        count += s->memory->class[number] == ROW && s->memory->last[number] && s->memory->each[number];
    return count;
}

/* Returns true if an instruction accesses memory of the lanes. */
static bool is_of_chunk(const struct ir_instruction *i)
{
    return ir_properties(i) & (IR_READS | IR_WRITES) &&
           (i->base == BASE_LANES || i->base == BASE_COLOR || i->base == BASE_DEPTH);
}

/* Notes what differs from chunk to chunk. */
static void find_each(struct separation *s)
{
    s->memory->each[0] = false;
    for (uint32_t number = 1; number < s->ir->count; number++) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        bool each = s->memory->class[number] == BLOCK || is_of_chunk(i);
        for (unsigned o = 0; o < ir_operands(i); o++)
            each |= s->memory->each[i->operand[o]];
        s->memory->each[number] = each && s->memory->class[number] & (ROW | BLOCK);
    }
}

/* Returns true if both chunks of a block can be computed together. Two gathers and more have more addresses
 * of rows of texels than registers. */
static bool join_chunks(struct separation *s)
{
    uint32_t gathers = 0;
    s->gather = 0;
    if (s->pass->lanes != 8 || s->ir->count > IR_CAPACITY / 16)
        return false;
    for (uint32_t number = 1; number < s->ir->count; number++) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        if (s->memory->class[number] != BLOCK)
            continue;
        if (ir_properties(i) & (IR_OPENS | IR_CLOSES | IR_PLACED | IR_VARIABLE) ||
            (is_of_chunk(i) && i->op != IR_load && i->op != IR_store))
            return false;
        gathers += i->op == IR_gather;
        s->gather = i->op == IR_gather ? number : s->gather;
    }
    if (gathers > 1)
        return false;
    find_each(s);
    find_last_uses(s);
    return most_waiting(s) + 2 * count_row_values(s) + !!s->gather <= ROOM;
}

/* Returns true if a value is computed for both chunks, one after the other. */
static bool is_double(const struct separation *s, unsigned value)
{
    return s->chunks > 1 && s->memory->each[value];
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
    if (i->type == TYPE_msk || near || s->row_words + s->chunks > ROW_WORDS) {
        s->memory->need[value] = NEED_AGAIN;
        return;
    }
    s->memory->need[value] = NEED_EARLY_LOAD;
    s->memory->word[value] = (uint8_t)s->row_words;
    s->row_words += is_double(s, value) ? s->chunks : 1;
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

static void name(struct separation *s, unsigned value, unsigned chunk, uint32_t number)
{
    if (chunk)
        s->memory->second[value] = (uint16_t)number;
    else
        s->pass->map[value] = (uint16_t)number;
}

static uint16_t new_number(const struct separation *s, unsigned value, unsigned chunk)
{
    return chunk && is_double(s, value) ? s->memory->second[value] : s->pass->map[value];
}

/* Appends an instruction, for the first or the second chunk. */
static void append(struct separation *s, uint32_t number, unsigned chunk)
{
    struct ir_instruction i = s->ir->instruction[number];
    for (int o = 0; o < 3; o++)
        i.operand[o] = new_number(s, i.operand[o], chunk);
    if (is_of_chunk(&i))
        i.k += (int32_t)(chunk * s->pass->lanes * 4);
    name(s, number, chunk, insert(s, i));
}

/* An access to the word of a column's or a row's value. */
static struct ir_instruction table_word(const struct separation *s, enum ir_op op, unsigned value,
                                        unsigned chunk)
{
    struct ir_instruction i = s->ir->instruction[value];
    return (struct ir_instruction){.op = (uint8_t)op,
                                   .type = op == IR_load ? i.type : TYPE_non,
                                   .base = s->memory->class[value] == ROW ? BASE_ROW : BASE_COLUMN,
                                   .line = i.line,
                                   .file = i.file,
                                   .origin = i.origin,
                                   .k = (int32_t)((s->memory->word[value] + chunk) * s->pass->lanes * 4)};
}

static void append_stored(struct separation *s, uint32_t number, unsigned chunk)
{
    append(s, number, chunk);
    if (!is_loaded(s, number))
        return;
    struct ir_instruction store = table_word(s, IR_store, number, chunk);
    store.operand[0] = new_number(s, number, chunk);
    insert(s, store);
}

static void append_class(struct separation *s, unsigned class)
{
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (s->memory->class[number] != class || s->ir->instruction[number].op == IR_nop ||
            (class == ROW && !s->memory->wanted[number]))
            continue;
        append_stored(s, number, 0);
        if (is_double(s, number))
            append_stored(s, number, 1);
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
            name(s, number, 0, insert(s, table_word(s, IR_load, number, 0)));
}

/* Each instruction has loads of its own, so that they can become its operands in memory. */
static void append_in_block(struct separation *s, uint32_t number, unsigned chunk)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (s->memory->need[i->operand[o]] == NEED_LOAD)
            name(s, i->operand[o], 0, insert(s, table_word(s, IR_load, i->operand[o], 0)));
    append(s, number, chunk);
}

static bool is_in_block(const struct separation *s, uint32_t number)
{
    return (s->memory->class[number] == BLOCK && s->ir->instruction[number].op != IR_nop) ||
           (s->memory->class[number] == COLUMN && s->memory->need[number] == NEED_AGAIN);
}

static void append_blocks(struct separation *s)
{
    open_loop(s, IR_LOOP_BLOCKS);
    load_early(s);
    for (uint32_t number = 1; number <= s->gather; number++)
        for (unsigned chunk = 0; chunk < s->chunks && is_in_block(s, number); chunk++)
            if (!chunk || is_double(s, number))
                append_in_block(s, number, chunk);
    for (unsigned chunk = 0; chunk < s->chunks; chunk++)
        for (uint32_t number = s->gather + 1; number < s->ir->count; number++)
            if (is_in_block(s, number) && (!chunk || is_double(s, number)))
                append_in_block(s, number, chunk);
    close_loop(s, IR_LOOP_BLOCKS);
}

static void append_for_chunk(struct separation *s, uint32_t number, unsigned chunk)
{
    if (s->memory->need[number] == NEED_AGAIN)
        append(s, number, chunk);
    else if (is_loaded(s, number))
        name(s, number, chunk, insert(s, table_word(s, IR_load, number, chunk)));
}

static void append_chunks(struct separation *s)
{
    open_loop(s, IR_LOOP_CHUNKS);
    for (uint32_t number = 1; number < s->ir->count; number++) {
        if (s->memory->class[number] != ROW)
            continue;
        append_for_chunk(s, number, 0);
        if (is_double(s, number))
            append_for_chunk(s, number, 1);
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
    s.chunks = join_chunks(&s) ? 2 : 1;
    s.gather = s.chunks > 1 ? s.gather : 0;
    if (!find_needs(&s))
        return 0;
    rebuild(&s);
    ir->separated = true;
    ir->column_words = s.words;
    ir->row_words = s.row_words;
    ir->chunks = s.chunks;
    return ir->count;
}
