/* The preamble: what is the same for all elements of a call is computed before the routine's loop.
 *
 * Operations on words of the job, on constants of shaders and on literals move to the section
 * IR_SECTION_CALL (pass.h): products of two matrices, a normalized direction of a light, conditions. Reads
 * and literals move with the operations that need them, and never by themselves: a word that an instruction
 * reads from memory costs nothing (hoist.c). The register allocator decides whether a result keeps its
 * register in the loop. If not, it is a slot of the stack frame, which instructions read from memory.
 *
 * A region with a condition of lanes that is in no other region usually runs for some element of a call: the
 * pixels that pass the early tests. An operation from there or from outside of regions is executed once
 * instead of for each group of lanes, so a call with one element executes as many operations as before. Other
 * regions may be skipped in the whole call: inner ones, and those with a uniform condition. An operation that
 * leaves them has no effect and cannot fail, but may be executed for nothing. So at most an EXCESS-th of the
 * number of usual operations may move out of such regions, the first ones. Gathers do not move out of them.
 *
 * The pass runs once after the repeated ones and `invariant`, which move what loops do not change. A program
 * of the span reading is not changed: its section of triangles computes the same values (separate.c). */
#include "engines/specialize/passes/pass.h"

#include <string.h>

enum { EXCESS = 8 };

struct preamble_memory {
    uint8_t section[IR_CAPACITY]; /* of each value: enum ir_section */
    uint8_t moves[IR_CAPACITY];
};

static_assert(sizeof(struct preamble_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* Returns true for what moves by itself. */
static bool is_operation(const struct ir_instruction *i)
{
    return ir_properties(i) & IR_COMPUTES || i->op == IR_gather;
}

/* The open regions at an instruction. */
struct regions {
    uint32_t depth;
    uint32_t rare; /* the depth of the outermost one that may be skipped in the whole call, 0: none */
    bool closed;   /* there has been a region that ended before this instruction */
};

static void cross(struct regions *r, const struct preamble_memory *m, const struct ir_instruction *i)
{
    if (ir_properties(i) & IR_OPENS) {
        bool uniform = i->op == IR_when && m->section[i->operand[0]] == IR_SECTION_CALL;
        if (++r->depth > 1 || uniform)
            r->rare = r->rare ? r->rare : r->depth;
    } else if (ir_properties(i) & IR_CLOSES) {
        r->rare = r->depth == r->rare ? 0 : r->rare;
        r->depth--;
        r->closed = true;
    }
}

/* The numbers of operations: those that are usually executed; those after the preamble that are the same in
 * the whole call, and of these the ones in regions that may be skipped. */
struct operations {
    uint32_t usual, same, rare;
    bool repeated; /* some may be equal, since they are in two regions */
};

/* The section of an operation that could move, which it may not leave. Counts it. */
static uint8_t limit_section(struct operations *count, const struct regions *regions,
                             const struct ir_instruction *i, uint32_t limit)
{
    if (regions->rare && (i->op == IR_gather || count->rare >= limit))
        return IR_SECTION_BODY;
    count->same++;
    count->rare += regions->rare != 0;
    count->repeated |= regions->closed;
    return IR_SECTION_CALL;
}

/* Finds the section of each value of the body. At most `limit` operations are of the call in regions that may
 * be skipped. The instructions of a window (window.c) stay together. */
static struct operations find_sections(const struct ir *ir, struct preamble_memory *m, uint32_t limit)
{
    const uint32_t body = ir_find_body(ir);
    struct operations count = {0, 0, 0, false};
    struct regions regions = {0, 0, false};
    uint8_t *section = m->section;
    memset(section, IR_SECTION_CALL, body);
    for (uint32_t number = body, window = 0; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        const unsigned properties = ir_properties(i);
        section[number] = number <= window ? IR_SECTION_BODY : pass_section_of(i, section);
        if (properties & IR_COMPUTES)
            count.usual += !regions.rare;
        else if (properties & (IR_OPENS | IR_CLOSES))
            cross(&regions, m, i);
        else if (i->op == IR_window)
            window = number + i->scale;
        if (section[number] == IR_SECTION_CALL && is_operation(i))
            section[number] = limit_section(&count, &regions, i, limit);
    }
    return count;
}

/* Marks the operations that move, with the reads, literals and copies that they need, and a preamble that is
 * there already. */
static void mark(const struct ir *ir, struct preamble_memory *m)
{
    const uint32_t body = ir_find_body(ir);
    memset(m->moves, 1, body);
    memset(m->moves + body, 0, ir->count - body);
    for (uint32_t number = body; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        if (m->section[number] != IR_SECTION_CALL || !(is_operation(i) || i->op == IR_copy))
            continue;
        m->moves[number] = 1;
        for (int o = 0; o < 3; o++)
            m->moves[i->operand[o]] = 1;
    }
}

static bool is_end(const struct ir_instruction *i)
{
    return i->op == IR_nop || i->op == IR_section || i->op == IR_repeat;
}

static void append_marked(const struct ir *ir, struct pass_memory *memory, const struct preamble_memory *m,
                          bool marked, uint32_t *count)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (m->moves[number] == marked && !is_end(&ir->instruction[number]))
            pass_append(ir, memory, number, count);
}

static void rebuild(struct ir *ir, struct pass_memory *memory, const struct preamble_memory *m)
{
    uint32_t count = pass_rebuild(ir, memory);
    append_marked(ir, memory, m, true, &count);
    memory->rebuilt[count++] = (struct ir_instruction){.op = IR_section, .k = IR_SECTION_BODY};
    append_marked(ir, memory, m, false, &count);
    memory->rebuilt[count++] = (struct ir_instruction){.op = IR_repeat};
    pass_replace(ir, memory, count);
    ir->preamble = true;
}

/* Of equal operations one is enough. */
static void merge_equal(struct ir *ir, struct pass_memory *memory)
{
    pass_common(ir, memory);
    pass_copy(ir, memory);
}

unsigned pass_preamble(struct ir *ir, struct pass_memory *memory)
{
    struct preamble_memory *m = pass_scratch(memory, sizeof *m);
    if (ir->separated)
        return 0;
    struct operations count = find_sections(ir, m, ir->count);
    const uint32_t limit = ir->preamble ? 0 : count.usual / EXCESS;
    if (count.rare > limit)
        count = find_sections(ir, m, limit);
    if (!count.same || ir->count + 2 > IR_CAPACITY)
        return 0;
    mark(ir, m);
    rebuild(ir, memory, m);
    if (count.repeated)
        merge_equal(ir, memory);
    return count.same;
}
