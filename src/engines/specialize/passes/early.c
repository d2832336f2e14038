/* Programs of whole blocks: what leads to the texels is executed for several blocks before the rest of them.
 *
 * From the position of a pixel a dozen operations lead to the address of its texels, and from the texels a
 * few dozen to the colour. Each waits for the one before. A processor looks a few hundred instructions ahead,
 * which is a block of two registers for each value: it cannot begin the next block while it waits. With
 * half of the operations in each of two loops, it works on several blocks at a time.
 *
 *   operations, gathers,                       the first part: for each block of a group
 *   stores to the table at ROW
 *   rest
 *   loads from the table, operations, stores   the second part: for each block of the group
 *
 * The table has an entry for each block of a group (emit/parts.c). For one block the program has the same
 * results as before. A mask cannot be stored. The second part computes the masks that it needs again, and
 * reads again what is only read from memory.
 *
 * The first part ends after the last gather that precedes the first condition. The region of the covered
 * lanes is removed, because each block has some. The pass runs for programs with two registers for each
 * value, which compute a whole block. */
#include "contract/arguments.h"
#include "contract/lane.h"
#include "engines/specialize/passes/pass.h"

#include <stddef.h>
#include <string.h>

enum {
    LEAST = 16, /* operations of each part: with fewer, the two loops cost more than they gain */
    WORDS = 4   /* the most values that go through the table */
};

enum need { NEED_NOTHING, NEED_LOAD, NEED_AGAIN };

struct early_memory {
    uint8_t need[IR_CAPACITY]; /* of the first part's values: how the second gets them */
    uint8_t word[IR_CAPACITY]; /* in the table's entry */
    bool there[IR_CAPACITY];   /* the second part has it already */
};

static_assert(sizeof(struct early_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct parting {
    struct ir *ir;
    struct pass_memory *pass;
    struct early_memory *memory;
    uint32_t body, rest; /* the first instruction of each part */
    uint32_t covered;    /* the region of the covered lanes; 0: there is none */
    uint32_t count, words;
};

/* --- The parts ------------------------------------------------------------------------------------------ */

static const struct ir_instruction *operand(const struct ir *ir, const struct ir_instruction *i, int o)
{
    return &ir->instruction[i->operand[o]];
}

static bool reads(const struct ir_instruction *i, enum ir_op op, enum base base, size_t offset)
{
    return i->op == op && i->base == base && i->k == (int32_t)offset;
}

/* Returns true if the mask is that of the covered lanes: eq (and coverage bits) bits. */
static bool is_coverage(const struct ir *ir, const struct ir_instruction *mask)
{
    for (int o = 0; mask->op == IR_eq_i && o < 2; o++) {
        const struct ir_instruction *both = operand(ir, mask, o);
        for (int p = 0; both->op == IR_and_i && p < 2; p++)
            if (both->operand[1 - p] == mask->operand[1 - o] &&
                reads(operand(ir, mask, 1 - o), IR_load, BASE_LANES, offsetof(struct lane_table, bit)) &&
                reads(operand(ir, both, p), IR_uniform, BASE_ENTRY, offsetof(struct entry, coverage)))
                return true;
    }
    return false;
}

/* Returns true if nothing keeps the instruction from the first part. The words of the target may be those
 * that an earlier block of the group will write. */
static bool may_be_early(const struct ir_instruction *i)
{
    if (i->base == BASE_COLOR || i->base == BASE_DEPTH)
        return !(ir_properties(i) & (IR_READS | IR_WRITES));
    return !(ir_properties(i) & (IR_EFFECT | IR_WRITES | IR_PLACED)) || i->op == IR_window || i->op == IR_nop;
}

static uint32_t count_operations(const struct ir *ir, uint32_t from, uint32_t to)
{
    uint32_t count = 0;
    for (; from < to; from++)
        count += (ir_properties(&ir->instruction[from]) & IR_COMPUTES) != 0;
    return count;
}

/* Finds where the parts begin. Returns false if there are none. */
static bool find_parts(struct parting *p)
{
    const struct ir *ir = p->ir;
    p->body = ir_find_body(ir);
    for (uint32_t n = p->body; n < ir->count; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        if (i->op == IR_when && !p->covered && is_coverage(ir, operand(ir, i, 0)))
            p->covered = n;
        else if (!may_be_early(i))
            break;
        if (i->op == IR_gather && i->base != BASE_CONSTANT)
            p->rest = n + 1;
    }
    if (p->rest < p->covered)
        p->covered = 0;
    return p->rest && count_operations(ir, p->body, p->rest) >= LEAST &&
           count_operations(ir, p->rest, ir->count) >= LEAST;
}

/* --- What goes from one part to the other --------------------------------------------------------------- */

static bool is_read_again(const struct ir_instruction *i)
{
    return i->type == TYPE_msk || i->op == IR_literal || i->op == IR_constant || i->op == IR_uniform ||
           (i->op == IR_load && i->base == BASE_LANES);
}

static bool is_of_first(const struct parting *p, unsigned value)
{
    return value >= p->body && value < p->rest;
}

/* Returns true if the second part reads or computes the value again, for `user`. */
static bool is_made_again(const struct parting *p, const struct ir_instruction *user, unsigned value)
{
    const struct ir_instruction *i = &p->ir->instruction[value];
    bool again = ir_properties(i) & IR_COMPUTES && user->type == TYPE_msk;
    for (unsigned o = 0; o < ir_operands(i); o++)
        again &= is_read_again(operand(p->ir, i, (int)o));
    return again || is_read_again(i);
}

static void need(struct parting *p, const struct ir_instruction *user, unsigned value)
{
    if (!is_of_first(p, value) || p->memory->need[value] != NEED_NOTHING)
        return;
    bool again = is_made_again(p, user, value);
    p->memory->need[value] = again ? NEED_AGAIN : NEED_LOAD;
    p->words += !again;
}

/* From back to front, since what is computed again has operands. Returns false if the table is too small. */
static bool find_needs(struct parting *p)
{
    struct early_memory *m = p->memory;
    memset(m->need, NEED_NOTHING, p->ir->count);
    memset(m->there, 0, p->ir->count * sizeof m->there[0]);
    p->words = 0;
    for (uint32_t n = p->ir->count - 1; n >= p->body; n--)
        for (unsigned o = 0;
             (n >= p->rest || m->need[n] == NEED_AGAIN) && o < ir_operands(&p->ir->instruction[n]); o++)
            need(p, &p->ir->instruction[n], p->ir->instruction[n].operand[o]);
    if (p->words > WORDS)
        return false;
    for (uint32_t n = p->body, word = 0; n < p->rest; n++)
        if (m->need[n] == NEED_LOAD)
            m->word[n] = (uint8_t)word++;
    return true;
}

/* --- The program ---------------------------------------------------------------------------------------- */

static void insert(struct parting *p, struct ir_instruction instruction)
{
    p->pass->rebuilt[p->count++] = instruction;
}

static struct ir_instruction table_word(const struct parting *p, enum ir_op op, uint32_t value)
{
    const struct ir_instruction *i = &p->ir->instruction[value];
    return (struct ir_instruction){
        .op = (uint8_t)op,
        .type = op == IR_load ? i->type : TYPE_non,
        .base = BASE_ROW,
        .line = i->line,
        .file = i->file,
        .origin = i->origin,
        .k = (int32_t)(p->memory->word[value] * p->pass->lanes * p->pass->parts * 4)};
}

static void append_first(struct parting *p)
{
    for (uint32_t n = 1; n < p->rest; n++)
        if (p->ir->instruction[n].op != IR_nop)
            pass_append(p->ir, p->pass, n, &p->count);
    for (uint32_t n = p->body; n < p->rest; n++)
        if (p->memory->need[n] == NEED_LOAD) {
            struct ir_instruction store = table_word(p, IR_store, n);
            store.operand[0] = p->pass->map[n];
            insert(p, store);
        }
    insert(p, (struct ir_instruction){.op = IR_rest});
}

/* Makes a value of the first part one of the second. */
static void fetch(struct parting *p, uint32_t value)
{
    const struct ir_instruction *i = &p->ir->instruction[value];
    if (!is_of_first(p, value) || p->memory->there[value])
        return;
    p->memory->there[value] = true;
    if (p->memory->need[value] == NEED_LOAD) {
        p->pass->map[value] = (uint16_t)p->count;
        insert(p, table_word(p, IR_load, value));
        return;
    }
    for (unsigned o = 0; o < ir_operands(i); o++)
        fetch(p, i->operand[o]);
    pass_append(p->ir, p->pass, value, &p->count);
}

/* The last instruction of those from `first` on that stay together: a region with its joins; a window and its
 * gathers. */
static uint32_t last_of_group(const struct ir *ir, uint32_t first)
{
    const struct ir_instruction *i = &ir->instruction[first];
    if (i->op == IR_window)
        return first + i->scale;
    if (i->op != IR_when)
        return first;
    uint32_t last = ir_other_end(ir, first);
    while (last + 1 < ir->count && ir->instruction[last + 1].op == IR_join)
        last++;
    return last;
}

static void append_second(struct parting *p)
{
    for (uint32_t n = p->rest; n < p->ir->count;) {
        uint32_t last = last_of_group(p->ir, n);
        for (uint32_t g = n; g <= last; g++)
            for (unsigned o = 0; o < ir_operands(&p->ir->instruction[g]); o++)
                fetch(p, p->ir->instruction[g].operand[o]);
        for (; n <= last; n++)
            if (p->ir->instruction[n].op != IR_nop)
                pass_append(p->ir, p->pass, n, &p->count);
    }
}

/* Returns true if the program has neither loops nor variables, and only conditions as regions. */
static bool is_simple(const struct ir *ir)
{
    for (uint32_t n = 1; n < ir->count; n++) {
        const struct ir_instruction *i = &ir->instruction[n];
        if (i->op == IR_loop || ir_properties(i) & (IR_VARIABLE | IR_CALLS | IR_EXCHANGED))
            return false;
    }
    return true;
}

unsigned pass_early(struct ir *ir, struct pass_memory *memory)
{
    struct parting p = {.ir = ir, .pass = memory, .memory = pass_scratch(memory, sizeof *p.memory)};
    if (memory->parts != 2 || memory->lanes != 8 || ir->unit != UNIT_PIXEL || ir->separated ||
        ir->count > IR_CAPACITY / 8 || !is_simple(ir) || !find_parts(&p) || !find_needs(&p))
        return 0;
    if (p.covered)
        pass_open_region(ir, p.covered);
    p.count = pass_rebuild(ir, memory);
    append_first(&p);
    append_second(&p);
    pass_replace(ir, memory, p.count);
    ir->early = true;
    ir->early_words = p.words * memory->parts;
    pass_dead(ir, memory);
    if (memory->judges)
        memory->shapes.two = pass_estimate_parts(ir, memory);
    return ir->count;
}
