/* Dead-code elimination: a walk from back to front that marks what the stores need.
 *
 * A region without a live instruction is removed together with its condition. A set is kept while any get of
 * its variable is live, whether or not it reaches that get.
 *
 * In a loop an instruction can make an earlier one live that the walk has yet to reach, and also a later one
 * that it has already passed: an iteration reads what the previous one set, and the condition of a loop is
 * live only if something in the loop is. Therefore programs with loops are marked again and again until no
 * mark is new; only then are the unmarked instructions removed.
 *
 * This pass removes the computation of vertex outputs that the pixel routine does not read: the key has no
 * store for them. */
#include "engines/specialize/passes/pass.h"

#include <string.h>

struct dead_memory {
    uint8_t live[IR_CAPACITY];     /* of each value, and of the `again` of each loop that is kept */
    uint8_t read[VARIABLES];       /* of each variable: a get of it is live */
    uint8_t fed[IR_CAPACITY];      /* of each phi: the walk has marked its next value */
    uint16_t closing[IR_CAPACITY]; /* a stack of the ends of the regions that the walk is in */
    uint8_t kept[IR_CAPACITY];     /* for each of them: something live was found in it */
};

static_assert(sizeof(struct dead_memory) <= PASS_SCRATCH, "scratch memory is large enough");

struct sweep {
    struct ir *ir;
    struct dead_memory *memory;
    unsigned depth;
    bool joined;  /* a live join was found; its region is kept, since it decides the join's value */
    bool removes; /* this walk removes instructions */
    bool found;   /* a mark was made that the walk may have needed before */
    unsigned changes;
};

static void mark_operands(struct dead_memory *m, const struct ir_instruction *i)
{
    for (int o = 0; o < 3; o++)
        m->live[i->operand[o]] = 1;
}

/* The walk enters a region at its end. */
static void enter(struct sweep *s, uint32_t end)
{
    struct dead_memory *m = s->memory;
    m->closing[++s->depth] = (uint16_t)end;
    m->kept[s->depth] = m->live[end] || s->joined;
    s->joined = false;
    if (m->live[end])
        mark_operands(m, &s->ir->instruction[end]);
}

static void remove_instruction(struct sweep *s, uint32_t number)
{
    if (!s->removes)
        return;
    s->ir->instruction[number] = (struct ir_instruction){0};
    s->changes++;
}

static void mark(struct sweep *s, uint8_t *flag)
{
    s->found |= !*flag;
    *flag = 1;
}

/* The walk leaves a region at its beginning. Returns true if the region is kept. The frame needs the loops of
 * the span reading, even if nothing is in them. */
static bool leave(struct sweep *s, const struct ir_instruction *i)
{
    struct dead_memory *m = s->memory;
    unsigned end = m->closing[s->depth];
    bool keep = m->kept[s->depth--] || (i->op == IR_loop && i->k != IR_LOOP_LANES);
    if (!keep)
        remove_instruction(s, end);
    else if (i->op == IR_loop)
        mark(s, &m->live[end]);
    return keep;
}

/* Returns true if an instruction that is not an ordinary value is live. */
static bool is_live(struct sweep *s, uint32_t number)
{
    struct dead_memory *m = s->memory;
    const struct ir_instruction *i = &s->ir->instruction[number];
    switch (i->op) {
    case IR_when:
    case IR_loop: return leave(s, i);
    case IR_set: return m->read[i->k];
    case IR_get:
        if (m->live[number])
            mark(s, &m->read[i->k]);
        break;
    case IR_next: m->fed[i->operand[0]] = m->live[i->operand[0]]; return m->live[i->operand[0]];
    case IR_phi: s->found |= m->live[number] != m->fed[number]; break;
    case IR_join: s->joined |= m->live[number]; break;
    }
    return m->live[number];
}

static void sweep(struct sweep *s)
{
    struct dead_memory *m = s->memory;
    s->found = s->joined = false;
    s->depth = 0;
    m->kept[0] = 0;
    for (uint32_t number = s->ir->count - 1; number > 0; number--) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        unsigned properties = ir_properties(i);
        if (i->op == IR_nop)
            continue;
        if (properties & IR_CLOSES)
            enter(s, number);
        else if (properties & (IR_WRITES | IR_KEPT) ||
                 (properties & (IR_EFFECT | IR_PLACED) ? is_live(s, number) : m->live[number])) {
            mark_operands(m, i);
            m->kept[s->depth] = 1;
        } else
            remove_instruction(s, number);
    }
}

unsigned pass_dead(struct ir *ir, struct pass_memory *memory)
{
    struct sweep s = {.ir = ir};
    struct dead_memory *m = s.memory = pass_scratch(memory, sizeof *m);
    memset(m->live, 0, ir->count);
    memset(m->read, 0, ir->variables);
    if (ir->phis)
        memset(m->fed, 0, ir->count * sizeof m->fed[0]);
    if (ir->loops)
        do
            sweep(&s);
        while (s.found);
    s.removes = true;
    sweep(&s);
    return s.changes;
}
