/* Loop-invariant motion: what each pass of a loop would compute alike is computed before the loop, before
 * the outermost one for which that holds.
 *
 * Operations cannot fail, so they are computed ahead even if a region in the loop would have skipped them.
 * Memory is read ahead only where it would have been read anyway, and only if no routine writes it. What is
 * placed (phis, joins, gets) stays. A moved value may cost a register in the loop; if none is left it
 * becomes a memory operand, which is still less than computing it again. Runs after the other passes, which
 * see both sides of a loop as one. */
#include "jit/pass.h"

#include <string.h>

/* Loops are numbered from 1 in order; 0 is the routine. */
struct motion {
    struct ir *ir;
    struct invariant_memory *memory;
    uint32_t loops;
    uint16_t loop, when; /* the innermost */
    unsigned moved;
};

static int is_open(const struct motion *m, unsigned loop)
{
    return !loop || m->memory->open[loop];
}

/* The innermost loop that one of the operands belongs to: of those that have ended, the one around them. */
static unsigned innermost_operand(const struct motion *m, const struct ir_instruction *i)
{
    unsigned innermost = 0;
    for (int o = 0; o < ir_op_information[i->op].operands; o++) {
        unsigned loop = m->memory->home[i->operand[o]];
        while (!is_open(m, loop))
            loop = m->memory->outer[loop];
        if (innermost < loop)
            innermost = loop;
    }
    return innermost;
}

/* The loop, or the routine, that an instruction of the current loop belongs to. */
static unsigned find_home(const struct motion *m, const struct ir_instruction *i)
{
    unsigned properties = ir_op_information[i->op].properties;
    if (i->op == IR_phi)
        return m->loops + 1;
    if (properties & (IR_EFFECT | IR_PLACED) || (properties & IR_READS && !ir_is_invariant_read(i)))
        return m->loop;
    unsigned home = innermost_operand(m, i);
    if (properties & IR_READS && m->when && home < m->memory->home[m->when])
        home = m->memory->home[m->when];
    return home;
}

/* Appends an instruction to what is computed before the loop through which it leaves. */
static void move_out(struct motion *m, uint32_t number, unsigned home)
{
    struct invariant_memory *memory = m->memory;
    unsigned loop = m->loop;
    while (memory->outer[loop] != home)
        loop = memory->outer[loop];
    memory->following[number] = 0;
    if (memory->first[loop])
        memory->following[memory->last[loop]] = (uint16_t)number;
    else
        memory->first[loop] = (uint16_t)number;
    memory->last[loop] = (uint16_t)number;
    memory->moves[number] = 1;
    m->moved++;
}

static void cross(struct motion *m, const struct ir_instruction *i, uint32_t number)
{
    struct invariant_memory *memory = m->memory;
    switch (i->op) {
    case IR_loop:
        memory->outer[++m->loops] = m->loop;
        memory->first[m->loops] = 0;
        memory->open[m->loops] = 1;
        m->loop = (uint16_t)m->loops;
        break;
    case IR_again:
        memory->open[m->loop] = 0;
        m->loop = memory->outer[m->loop];
        break;
    case IR_when:
        memory->around[number] = m->when;
        m->when = (uint16_t)number;
        break;
    case IR_end: m->when = memory->around[m->when]; break;
    }
}

static void find_moves(struct motion *m)
{
    for (uint32_t number = 1; number < m->ir->count; number++) {
        const struct ir_instruction *i = &m->ir->instruction[number];
        unsigned home = find_home(m, i);
        m->memory->home[number] = (uint16_t)home;
        m->memory->moves[number] = 0;
        if (home < m->loop && i->op != IR_nop)
            move_out(m, number, home);
        if (ir_op_information[i->op].properties & (IR_OPENS | IR_CLOSES))
            cross(m, i, number);
    }
}

static void append(struct motion *m, struct ir_instruction *to, uint16_t *map, uint32_t number,
                   uint32_t *count)
{
    to[*count] = m->ir->instruction[number];
    for (int o = 0; o < 3; o++)
        to[*count].operand[o] = map[to[*count].operand[o]];
    map[number] = (uint16_t)(*count)++;
}

/* What leaves a loop stands before its phis. */
static void rebuild(struct motion *m, struct ir_instruction *to, uint16_t *map)
{
    struct ir *ir = m->ir;
    uint32_t count = 1, loop = 1;
    int opened = 0;
    map[0] = 0;
    to[0] = ir->instruction[0];
    for (uint32_t number = 1; number < ir->count; number++) {
        unsigned op = ir->instruction[number].op;
        if (m->memory->moves[number] || op == IR_nop)
            continue;
        if ((op == IR_phi || op == IR_loop) && !opened)
            for (unsigned n = m->memory->first[loop]; n; n = m->memory->following[n])
                append(m, to, map, n, &count);
        opened = op == IR_phi;
        loop += op == IR_loop;
        append(m, to, map, number, &count);
    }
    memcpy(ir->instruction, to, count * sizeof *to);
    ir->count = count;
}

unsigned pass_invariant(struct ir *ir, struct pass_memory *memory)
{
    struct motion m = {.ir = ir, .memory = &memory->invariant};
    if (!ir->loops)
        return 0;
    m.memory->home[0] = 0;
    find_moves(&m);
    if (m.moved)
        rebuild(&m, memory->rebuilt, memory->map);
    return m.moved;
}
