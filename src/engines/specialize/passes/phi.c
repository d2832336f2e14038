/* Variables become values: the construction of SSA form (Cytron et al. 1991), which structured control flow
 * makes simple (Braun et al. 2013).
 *
 * One walk from front to back tracks the value that each variable holds, and replaces each get by that value.
 * A loop begins with a phi for each variable that it sets and that holds a value before it. A `when` ends
 * with a join for each variable that it sets. Phis are made whether or not they are needed: dead-code
 * elimination removes those that no store needs, including cycles of phis. Later runs remove phis and joins
 * that have one value only.
 *
 * Afterwards no variables are left, unless the new program would exceed IR_CAPACITY: then nothing is changed.
 */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { PHI_CHANGES = 2 * IR_CAPACITY };

/* A change of a variable in an open region: the value before it, and the phi if a loop's phi was the change.
 */
struct phi_change {
    uint16_t variable, value, phi;
};

/* Loops are numbered from 1 in program order. */
struct phi_memory {
    uint64_t sets[PASS_LOOPS][VARIABLES / 64]; /* a bit for each variable that the loop sets */
    uint16_t outer[PASS_LOOPS];                /* the loop around a loop, 0: none */
    uint16_t held[VARIABLES];                  /* the current value of each variable, 0: none */
    uint8_t type[VARIABLES];
    uint8_t seen[VARIABLES];
    uint32_t region[IR_CAPACITY];          /* of each open region: the length of `change` when it began */
    struct phi_change change[PHI_CHANGES]; /* in program order; of an ended region, one for each variable */
    uint16_t replacement[IR_CAPACITY];     /* of each value, itself if there is none */
};

static_assert(sizeof(struct phi_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct construction {
    const struct ir *ir;
    struct phi_memory *memory;
    struct ir_instruction *to;
    uint16_t *map; /* from old numbers to new ones */
    uint32_t count, changes, loops, regions, phis;
    bool full;
};

static uint16_t append(struct construction *c, struct ir_instruction instruction)
{
    if (c->count == IR_CAPACITY) {
        c->full = true;
        return 0;
    }
    c->to[c->count] = instruction;
    return (uint16_t)c->count++;
}

static uint16_t append_phi(struct construction *c, const struct ir_instruction *at, enum ir_op op,
                           unsigned type, uint16_t a, uint16_t b)
{
    c->phis += op != IR_next;
    return append(c, (struct ir_instruction){.op = (uint8_t)op,
                                             .type = (uint8_t)type,
                                             .operand = {a, b},
                                             .line = at->line,
                                             .file = at->file,
                                             .origin = at->origin});
}

/* --- Variables that loops set -------------------------------------------------------------------------- */

/* A variable that is set in a loop is set in the loops around it. */
static void note_set(struct phi_memory *memory, uint32_t loop, unsigned variable)
{
    for (; loop; loop = memory->outer[loop]) {
        uint64_t *word = &memory->sets[loop][variable / 64], bit = 1ull << variable % 64;
        if (*word & bit)
            return;
        *word |= bit;
    }
}

static void find_sets(const struct ir *ir, struct phi_memory *memory)
{
    uint32_t loops = 0, loop = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        switch (i->op) {
        case IR_loop:
            memory->outer[++loops] = (uint16_t)loop;
            memset(memory->sets[loops], 0, sizeof memory->sets[loops]);
            loop = loops;
            break;
        case IR_again: loop = memory->outer[loop]; break;
        case IR_set: note_set(memory, loop, (unsigned)i->k); /* fall through */
        case IR_get: memory->type[i->k] = i->type; break;
        }
    }
}

/* --- Construction -------------------------------------------------------------------------------------- */

static void change(struct construction *c, unsigned variable, uint16_t value)
{
    struct phi_memory *m = c->memory;
    if (c->regions) {
        if (c->changes == PHI_CHANGES) {
            c->full = true;
            return;
        }
        m->change[c->changes++] = (struct phi_change){(uint16_t)variable, m->held[variable], 0};
    }
    m->held[variable] = value;
}

static void begin_region(struct construction *c)
{
    if (!c->regions)
        c->changes = 0;
    c->memory->region[c->regions++] = c->changes;
}

/* Phis precede the loop, but their changes belong to it. */
static void begin_loop(struct construction *c, const struct ir_instruction *i)
{
    struct phi_memory *m = c->memory;
    const uint64_t *sets = m->sets[++c->loops];
    begin_region(c);
    for (unsigned word = 0; word < VARIABLES / 64; word++)
        for (uint64_t left = sets[word]; left; left &= left - 1) {
            unsigned variable = word * 64 + (unsigned)__builtin_ctzll(left);
            if (!m->held[variable])
                continue;
            uint16_t phi = append_phi(c, i, IR_phi, m->type[variable], m->held[variable], 0);
            change(c, variable, phi);
            m->change[c->changes - 1].phi = phi;
        }
    append(c, *i);
}

/* Keeps only the first change of each variable, of the changes from number `from` on. */
static void forget_later_changes(struct construction *c, uint32_t from)
{
    struct phi_memory *m = c->memory;
    uint32_t to = from;
    for (uint32_t n = from; n < c->changes; n++) {
        unsigned variable = m->change[n].variable;
        if (m->seen[variable])
            continue;
        m->seen[variable] = 1;
        m->change[to] = m->change[n];
        m->change[to++].phi = 0;
    }
    c->changes = to;
    for (uint32_t n = from; n < to; n++)
        m->seen[m->change[n].variable] = 0;
}

static void end_loop(struct construction *c, const struct ir_instruction *i)
{
    struct phi_memory *m = c->memory;
    uint32_t from = m->region[--c->regions];
    for (uint32_t n = from; n < c->changes && m->change[n].phi; n++)
        append_phi(c, i, IR_next, TYPE_non, m->change[n].phi, m->held[m->change[n].variable]);
    struct ir_instruction again = *i;
    again.operand[0] = c->map[i->operand[0]];
    append(c, again);
    forget_later_changes(c, from);
}

static void end_when(struct construction *c, const struct ir_instruction *i)
{
    struct phi_memory *m = c->memory;
    uint32_t from = m->region[--c->regions];
    append(c, *i);
    forget_later_changes(c, from);
    for (uint32_t n = from; n < c->changes; n++) {
        uint16_t before = m->change[n].value, *held = &m->held[m->change[n].variable];
        if (!before)
            *held = 0;
        else if (*held != before)
            *held = append_phi(c, i, IR_join, m->type[m->change[n].variable], before, *held);
    }
}

/* A variable without a value reads as zero; valid recordings do not read one. */
static uint16_t read_variable(struct construction *c, const struct ir_instruction *i)
{
    uint16_t held = c->memory->held[i->k];
    return held ? held : append(c, (struct ir_instruction){.op = IR_literal, .type = i->type});
}

static void construct_instruction(struct construction *c, uint32_t number)
{
    const struct ir_instruction *i = &c->ir->instruction[number];
    switch (i->op) {
    case IR_nop: break;
    case IR_set: change(c, (unsigned)i->k, c->map[i->operand[0]]); break;
    case IR_get: c->map[number] = read_variable(c, i); break;
    case IR_loop: begin_loop(c, i); break;
    case IR_again: end_loop(c, i); break;
    case IR_end: end_when(c, i); break;
    default: {
        struct ir_instruction copy = *i;
        for (int o = 0; o < 3; o++)
            copy.operand[o] = c->map[i->operand[o]];
        c->map[number] = append(c, copy);
        if (i->op == IR_when)
            begin_region(c);
    }
    }
}

static unsigned construct(struct ir *ir, struct pass_memory *memory)
{
    struct construction c = {.ir = ir,
                             .memory = pass_scratch(memory, sizeof *c.memory),
                             .to = memory->rebuilt,
                             .map = memory->map,
                             .count = 1};
    find_sets(ir, c.memory);
    memset(c.memory->held, 0, sizeof c.memory->held);
    memset(c.memory->seen, 0, sizeof c.memory->seen);
    c.to[0] = ir->instruction[0];
    c.map[0] = 0;
    for (uint32_t number = 1; number < ir->count && !c.full; number++)
        construct_instruction(&c, number);
    if (c.full)
        return 0;
    pass_replace(ir, memory, c.count);
    ir->phis = c.phis;
    ir->variables = 0;
    return 1;
}

/* --- Phis and joins of one value ----------------------------------------------------------------------- */

/* The only value that a phi (given its `next`) or a join can have, or 0. A phi whose next value is itself or
 * its first value has only its first value. */
static uint16_t only_value(const struct ir *ir, const struct ir_instruction *i)
{
    if (i->op == IR_join)
        return i->operand[0] == i->operand[1] ? i->operand[0] : 0;
    unsigned phi = i->operand[0], start = ir->instruction[phi].operand[0];
    return i->operand[1] == phi || i->operand[1] == start ? (uint16_t)start : 0;
}

/* Follows replacements that were replaced themselves. */
static uint16_t resolve(const uint16_t *map, uint16_t value)
{
    while (map[value] != value)
        value = map[value];
    return value;
}

static unsigned remove_once(struct ir *ir, uint16_t *map)
{
    unsigned removed = 0;
    for (uint32_t number = 1; number < ir->count; number++) {
        struct ir_instruction *i = &ir->instruction[number];
        for (int o = 0; o < 3; o++)
            i->operand[o] = resolve(map, i->operand[o]);
        if (i->op != IR_next && i->op != IR_join)
            continue;
        uint16_t value = only_value(ir, i);
        if (!value)
            continue;
        uint32_t replaced = i->op == IR_join ? number : i->operand[0];
        map[replaced] = value;
        ir->instruction[replaced] = *i = (struct ir_instruction){0};
        removed++;
    }
    return removed;
}

static unsigned remove_trivial(struct ir *ir, uint16_t *map)
{
    unsigned changes = 0, removed;
    for (uint32_t number = 0; number < ir->count; number++)
        map[number] = (uint16_t)number;
    do
        changes += removed = remove_once(ir, map);
    while (removed);
    return changes;
}

unsigned pass_phi(struct ir *ir, struct pass_memory *memory)
{
    unsigned changes = ir->variables ? construct(ir, memory) : 0;
    if (!ir->phis)
        return changes;
    struct phi_memory *m = pass_scratch(memory, sizeof *m);
    return changes + remove_trivial(ir, m->replacement);
}
