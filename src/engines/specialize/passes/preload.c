/* Loads operands that a loop would load in every iteration once, before the loop.
 *
 * Literals and slots of the constant table are in memory, and most instructions can read one operand from
 * there. An operand that the instruction cannot read from memory (the left side of a subtraction, the third
 * operand of a selection) costs a load in every iteration. In a loop, this pass replaces such an operand by a
 * copy that is made before the loop. The register allocator decides whether the copy keeps its register; if
 * not, the operand is read from memory as before, at no cost. The pass runs after the repeated ones, since
 * copy propagation would undo it. */
#include "engines/specialize/allocate/allocate.h"
#include "engines/specialize/passes/pass.h"

/* By copy, from 1, and by loop, from 1 in program order. */
struct preload_memory {
    uint16_t source[IR_CAPACITY];    /* what the copy copies */
    uint16_t following[IR_CAPACITY]; /* the next copy before the same loop, 0: none */
    uint16_t number[IR_CAPACITY];    /* of the copy in the new program */
    uint16_t outer[PASS_LOOPS];      /* the loop around a loop, 0: none */
    uint16_t first[PASS_LOOPS];      /* the first copy before the loop, 0: none */
    uint16_t start[PASS_LOOPS];      /* the number of the loop's first phi, or of the loop */
};

static_assert(sizeof(struct preload_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct preload {
    struct ir *ir;
    struct preload_memory *memory;
    struct pass_memory *pass;
    uint32_t count, copies, loops;
    uint16_t loop; /* the innermost, 0: none */
};

/* Returns true if operand `o` costs a load. Zero is made without memory. */
static bool is_loaded(const struct ir *ir, const struct ir_instruction *i, int o)
{
    const struct ir_instruction *source = &ir->instruction[i->operand[o]];
    if (o >= (int)ir_operands(i) || !(ir_properties(i) & IR_COMPUTES) || allocate_folds(i, o))
        return false;
    return (source->op == IR_literal && source->k) || source->op == IR_constant;
}

/* The copy of a value before the current loop, 0: none yet. */
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
        p->pass->rebuilt[p->count++] = (struct ir_instruction){.op = IR_copy,
                                                               .type = source->type,
                                                               .operand = {p->pass->map[m->source[copy]]},
                                                               .line = source->line,
                                                               .file = source->file,
                                                               .origin = source->origin};
    }
}

static void append(struct preload *p, uint32_t number)
{
    const struct ir_instruction *i = &p->ir->instruction[number];
    struct ir_instruction *to = &p->pass->rebuilt[p->count];
    pass_append(p->ir, p->pass, number, &p->count);
    for (int o = 0; p->loop && o < 3; o++) {
        unsigned copy = is_loaded(p->ir, i, o) ? find_copy(p, i->operand[o]) : 0;
        if (copy)
            to->operand[o] = p->memory->number[copy];
    }
}

/* Inserts the copies before the loop's phis. */
static void rebuild(struct preload *p)
{
    bool opened = false;
    p->count = pass_rebuild(p->ir, p->pass);
    p->loops = 0;
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
    pass_replace(p->ir, p->pass, p->count);
}

unsigned pass_preload(struct ir *ir, struct pass_memory *memory)
{
    struct preload p = {.ir = ir, .memory = pass_scratch(memory, sizeof *p.memory), .pass = memory};
    if (!ir->loops)
        return 0;
    find_copies(&p);
    if (p.copies)
        rebuild(&p);
    return p.copies;
}
