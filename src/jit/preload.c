/* What a loop reads from memory into a register each time is loaded once, before the loop.
 *
 * Literals and frame constants are operands in memory, for which most instructions have room. Where one has
 * none (the left side of a subtraction, the other side of a selection) it takes a load each time. In a loop
 * such an operand becomes a copy made before it. Whether that copy keeps its register is the allocator's
 * decision: if not, the operand is in memory as before, at no cost. Runs last: copies would be propagated. */
#include "jit/allocate.h"
#include "jit/pass.h"

#include <string.h>

struct preload {
    struct ir *ir;
    struct preload_memory *memory;
    struct ir_instruction *to;
    uint16_t *map;
    uint32_t count, copies, loops;
    uint16_t loop; /* the innermost, 0: none */
};

/* Zero is made without memory. */
static int is_loaded(const struct ir *ir, const struct ir_instruction *i, int o)
{
    const struct ir_instruction *source = &ir->instruction[i->operand[o]];
    if (o >= ir_op_information[i->op].operands || i->op >= IR_copy || allocate_folds(i, o))
        return 0;
    return (source->op == IR_literal && source->k) || source->op == IR_constant;
}

/* The copy of a value before the current loop; 0: there is none yet. */
static unsigned find_copy(const struct preload *p, unsigned value)
{
    unsigned copy = p->memory->first[p->loop];
    while (copy && p->memory->source[copy] != value)
        copy = p->memory->following[copy];
    return copy;
}

static void add_copy(struct preload *p, unsigned value)
{
    struct preload_memory *m = p->memory;
    if (value >= m->start[p->loop] || find_copy(p, value) || p->ir->count + p->copies + 1 >= IR_CAPACITY)
        return;
    uint16_t copy = (uint16_t)++p->copies;
    m->source[copy] = (uint16_t)value;
    m->following[copy] = m->first[p->loop];
    m->first[p->loop] = copy;
}

static void cross(struct preload *p, unsigned op)
{
    if (op == IR_loop) {
        p->memory->outer[++p->loops] = p->loop;
        p->loop = (uint16_t)p->loops;
    } else if (op == IR_again)
        p->loop = p->memory->outer[p->loop];
}

static void begin_list(struct preload *p, uint32_t number)
{
    while (p->ir->instruction[number - 1].op == IR_phi)
        number--;
    p->memory->start[p->loop] = (uint16_t)number;
    p->memory->first[p->loop] = 0;
}

static void find_copies(struct preload *p)
{
    for (uint32_t number = 1; number < p->ir->count; number++) {
        const struct ir_instruction *i = &p->ir->instruction[number];
        cross(p, i->op);
        if (i->op == IR_loop)
            begin_list(p, number);
        for (int o = 0; p->loop && o < 3; o++)
            if (is_loaded(p->ir, i, o))
                add_copy(p, i->operand[o]);
    }
}

static void append_copies(struct preload *p, unsigned loop)
{
    struct preload_memory *m = p->memory;
    for (unsigned copy = m->first[loop]; copy; copy = m->following[copy]) {
        const struct ir_instruction *source = &p->ir->instruction[m->source[copy]];
        m->number[copy] = (uint16_t)p->count;
        p->to[p->count++] = (struct ir_instruction){.op = IR_copy,
                                                    .type = source->type,
                                                    .operand = {p->map[m->source[copy]]},
                                                    .line = source->line,
                                                    .file = source->file};
    }
}

static void append(struct preload *p, uint32_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct ir_instruction *to = &p->to[p->count];
    *to = *i;
    for (int o = 0; o < 3; o++) {
        unsigned copy = p->loop && is_loaded(p->ir, i, o) ? find_copy(p, i->operand[o]) : 0;
        to->operand[o] = copy ? p->memory->number[copy] : p->map[i->operand[o]];
    }
    p->map[number] = (uint16_t)p->count++;
}

/* Copies stand before the loop's phis. */
static void rebuild(struct preload *p)
{
    int opened = 0;
    p->count = 1;
    p->loops = 0;
    p->map[0] = 0;
    p->to[0] = p->ir->instruction[0];
    for (uint32_t number = 1; number < p->ir->count; number++) {
        unsigned op = p->ir->instruction[number].op;
        if (op == IR_nop)
            continue;
        if ((op == IR_phi || op == IR_loop) && !opened)
            append_copies(p, p->loops + 1);
        opened = op == IR_phi;
        cross(p, op);
        append(p, number);
    }
    memcpy(p->ir->instruction, p->to, p->count * sizeof *p->to);
    p->ir->count = p->count;
}

unsigned pass_preload(struct ir *ir, struct pass_memory *memory)
{
    struct preload p = {.ir = ir, .memory = &memory->preload, .to = memory->rebuilt, .map = memory->map};
    if (!ir->loops)
        return 0;
    find_copies(&p);
    if (p.copies)
        rebuild(&p);
    return p.copies;
}
