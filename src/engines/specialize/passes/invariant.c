/* Loop-invariant motion: a value that is the same in every iteration of a loop is computed before the loop,
 * or before the outermost loop for which this is true.
 *
 * Operations cannot fail, so a value may be computed early even if a region in the loop would have skipped
 * it. A read is moved only to where its region certainly runs, and only if no routine writes that memory.
 * Values that depend on their position (phis, joins, gets) are not moved. A moved value may occupy a register
 * in the loop; without a free register it becomes a memory operand, which is still cheaper than computing it
 * in every iteration. The pass runs after the repeated ones, which do not distinguish the inside of a loop
 * from the outside. */
#include "engines/specialize/passes/pass.h"

/* By instruction and by loop. Loops are numbered from 1 in program order; 0 is the routine. */
struct invariant_memory {
    uint16_t home[IR_CAPACITY];      /* the innermost loop in which the value changes */
    uint16_t following[IR_CAPACITY]; /* the next instruction that is moved before the same loop, 0: none */
    uint16_t around[IR_CAPACITY];    /* the `when` around a `when` */
    uint8_t moves[IR_CAPACITY];
    uint16_t outer[PASS_LOOPS]; /* the loop around a loop */
    uint16_t first[PASS_LOOPS]; /* the first instruction that is moved before the loop, 0: none */
    uint16_t last[PASS_LOOPS];  /* the last one */
    uint8_t open[PASS_LOOPS];
};

static_assert(sizeof(struct invariant_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct motion {
    struct ir *ir;
    struct invariant_memory *memory;
    uint32_t loops;
    uint16_t loop, when; /* the innermost ones at the current instruction */
    unsigned moved;
};

static bool is_open(const struct motion *m, unsigned loop)
{
    return !loop || m->memory->open[loop];
}

/* The innermost loop in which an operand changes. A loop that has ended counts as the loop around it. */
static unsigned innermost_operand(const struct motion *m, const struct ir_instruction *i)
{
    unsigned innermost = 0;
    for (unsigned o = 0; o < ir_operands(i); o++) {
        unsigned loop = m->memory->home[i->operand[o]];
        while (!is_open(m, loop))
            loop = m->memory->outer[loop];
        if (innermost < loop)
            innermost = loop;
    }
    return innermost;
}

/* The innermost loop in which an instruction of the current loop has to stay, 0: none. */
static unsigned find_home(const struct motion *m, const struct ir_instruction *i)
{
    unsigned properties = ir_properties(i);
    if (i->op == IR_phi)
        return m->loops + 1;
    if (properties & (IR_EFFECT | IR_PLACED) || (properties & IR_READS && !ir_is_invariant_read(i)))
        return m->loop;
    unsigned home = innermost_operand(m, i);
    if (properties & IR_READS && m->when && home < m->memory->home[m->when])
        home = m->memory->home[m->when];
    return home;
}

/* Appends an instruction to the list of those before the outermost loop that it leaves. */
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
        if (ir_properties(i) & (IR_OPENS | IR_CLOSES))
            cross(m, i, number);
    }
}

/* Inserts the instructions that leave a loop before its phis. */
static void rebuild(struct motion *m, struct pass_memory *memory)
{
    struct ir *ir = m->ir;
    uint32_t count = pass_rebuild(ir, memory), loop = 1;
    bool opened = false;
    for (uint32_t number = 1; number < ir->count; number++) {
        unsigned op = ir->instruction[number].op;
        if (m->memory->moves[number] || op == IR_nop)
            continue;
        if ((op == IR_phi || op == IR_loop) && !opened)
            for (unsigned n = m->memory->first[loop]; n; n = m->memory->following[n])
                pass_append(ir, memory, n, &count);
        opened = op == IR_phi;
        loop += op == IR_loop;
        pass_append(ir, memory, number, &count);
    }
    pass_replace(ir, memory, count);
}

unsigned pass_invariant(struct ir *ir, struct pass_memory *memory)
{
    struct motion m = {.ir = ir, .memory = pass_scratch(memory, sizeof *m.memory)};
    if (!ir->loops)
        return 0;
    m.memory->home[0] = 0;
    find_moves(&m);
    if (m.moved)
        rebuild(&m, memory);
    return m.moved;
}
