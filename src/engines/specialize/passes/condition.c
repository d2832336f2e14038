/* Uniform conditions: a region whose condition is the same in all lanes and for all elements of a call, such
 * as the comparison of two constants of a shader, runs in all lanes or in none. In the region the condition
 * is therefore true: uses of it become a literal, and the repeated passes remove the selections by it. The
 * condition itself is then only what the region is skipped by, and the pass `preamble` moves it before the
 * routine's loop.
 *
 * Regions that are skipped have no effect in any lane, so nothing changes but work. Only regions of shaders
 * have such conditions; their results leave them by joins, so a program without joins is not searched. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

/* Sections are found only for the values that conditions are computed from. */
enum { UNKNOWN = IR_SECTIONS, DEPTH = 64 };

struct condition_memory {
    uint8_t section[IR_CAPACITY]; /* of each value: enum ir_section, or UNKNOWN */
    uint8_t holds[IR_CAPACITY];   /* of each value: it is the condition of an open region */
    uint16_t when[IR_CAPACITY];   /* a stack of the open regions */
};

static_assert(sizeof(struct condition_memory) <= PASS_SCRATCH, "scratch memory is large enough");

/* Finds the section of a value. A value that is computed in more than DEPTH steps counts as part of the
 * body. */
static uint8_t find_section(const struct ir *ir, struct condition_memory *m, unsigned value, unsigned depth)
{
    const struct ir_instruction *i = &ir->instruction[value];
    if (m->section[value] != UNKNOWN)
        return m->section[value];
    if (depth == DEPTH)
        return IR_SECTION_BODY;
    for (unsigned o = 0; o < ir_operands(i); o++)
        if (find_section(ir, m, i->operand[o], depth + 1) == IR_SECTION_BODY)
            return m->section[value] = IR_SECTION_BODY;
    return m->section[value] = pass_section_of(i, m->section);
}

/* Returns true if a region can be entered only if its condition is true in all lanes. */
static bool is_uniform(const struct ir *ir, struct condition_memory *m, const struct ir_instruction *i)
{
    unsigned condition = i->operand[0];
    return i->op == IR_when && ir->instruction[condition].op != IR_literal &&
           find_section(ir, m, condition, 0) == IR_SECTION_CALL;
}

/* Returns true if an instruction in the region of a `when` uses its condition. */
static bool is_used(const struct ir *ir, uint32_t when)
{
    const unsigned condition = ir->instruction[when].operand[0];
    for (unsigned depth = 1; depth;) {
        const struct ir_instruction *i = &ir->instruction[++when];
        if (i->operand[0] == condition || i->operand[1] == condition || i->operand[2] == condition)
            return true;
        depth += i->op == IR_when;
        depth -= i->op == IR_end;
    }
    return false;
}

static bool has_uses(const struct ir *ir, struct condition_memory *m)
{
    for (uint32_t number = 1; number < ir->count; number++)
        if (ir->instruction[number].op == IR_when && is_uniform(ir, m, &ir->instruction[number]) &&
            is_used(ir, number))
            return true;
    return false;
}

/* Opens and closes the uniform regions at an instruction. Returns the depth of regions after it. */
static uint32_t cross(const struct ir *ir, struct condition_memory *m, uint32_t number, uint32_t depth)
{
    const struct ir_instruction *i = &ir->instruction[number];
    if (i->op == IR_when) {
        m->when[depth++] = (uint16_t)number;
        m->holds[i->operand[0]] += is_uniform(ir, m, i);
    } else if (i->op == IR_end) {
        const struct ir_instruction *when = &ir->instruction[m->when[--depth]];
        m->holds[when->operand[0]] -= is_uniform(ir, m, when);
    }
    return depth;
}

/* Rebuilds the program after a literal that is true in all lanes. Returns the number of its uses. */
static unsigned replace_uses(struct ir *ir, struct pass_memory *memory, struct condition_memory *m)
{
    uint32_t count = pass_rebuild(ir, memory), depth = 0;
    const uint32_t truth = count++;
    unsigned uses = 0;
    memory->rebuilt[truth] = (struct ir_instruction){.op = IR_literal, .type = TYPE_msk, .k = -1};
    memset(m->holds, 0, ir->count);
    for (uint32_t number = 1; number < ir->count; number++) {
        const struct ir_instruction *i = &ir->instruction[number];
        pass_append(ir, memory, number, &count);
        for (unsigned o = 0; o < ir_operands(i); o++)
            if (m->holds[i->operand[o]]) {
                memory->rebuilt[count - 1].operand[o] = (uint16_t)truth;
                uses++;
            }
        depth = cross(ir, m, number, depth);
    }
    pass_replace(ir, memory, count);
    return uses;
}

unsigned pass_condition(struct ir *ir, struct pass_memory *memory)
{
    struct condition_memory *m = pass_scratch(memory, sizeof *m);
    if (!ir->phis || ir->count + 1 >= IR_CAPACITY)
        return 0;
    memset(m->section, UNKNOWN, ir->count);
    m->section[0] = IR_SECTION_CALL;
    return has_uses(ir, m) ? replace_uses(ir, memory, m) : 0;
}
