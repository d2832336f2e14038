/* Dead-code elimination: backward, from the stores. A region in which nothing is left goes with its
 * condition. A set stays while any get of its variable does: which of them it reaches is not asked.
 *
 * Where there are loops, what is live ahead may become so by what is found behind: the next pass of a loop
 * reads what the last one set, and its condition counts only once something in it does. So the marks are
 * made over and over until none is new, and only then what has none goes.
 *
 * This is where a vertex output that the pixel routine does not read disappears with all that computed it:
 * the key has no store for it. */
#include "jit/pass.h"

#include <string.h>

struct sweep {
    struct ir *ir;
    uint8_t *live;     /* values, and the `again` of each loop that is kept */
    uint8_t *read;     /* variables */
    uint16_t *fed;     /* phis whose next value was seen to be live */
    uint16_t *closing; /* stack of open regions' ends, seen from behind */
    uint16_t *kept;    /* per level: whether something live was seen since */
    unsigned depth;
    unsigned joined;  /* a live join was seen, whose region decides its value */
    unsigned removes; /* this time */
    unsigned changes;
    unsigned found; /* marks that what was passed already has not seen */
};

static void mark_operands(uint8_t *live, const struct ir_instruction *i)
{
    for (int o = 0; o < 3; o++)
        live[i->operand[o]] = 1;
}

static void enter(struct sweep *s, uint32_t number)
{
    s->closing[++s->depth] = (uint16_t)number;
    s->kept[s->depth] = s->live[number] || s->joined;
    s->joined = 0;
    if (s->live[number])
        mark_operands(s->live, &s->ir->instruction[number]);
}

static void remove_instruction(struct sweep *s, uint32_t number)
{
    if (!s->removes)
        return;
    s->ir->instruction[number] = (struct ir_instruction){0};
    s->changes++;
}

/* Whether a region stays: when something in it does. Decided when its beginning is reached from behind. */
static int leave(struct sweep *s, const struct ir_instruction *i)
{
    unsigned end = s->closing[s->depth], keep = s->kept[s->depth--];
    if (!keep)
        remove_instruction(s, end);
    else if (i->op == IR_loop && !s->live[end])
        s->found += s->live[end] = 1;
    return (int)keep;
}

/* Of what is not an ordinary value. */
static int is_live(struct sweep *s, uint32_t number)
{
    const struct ir_instruction *i = &s->ir->instruction[number];
    switch (i->op) {
    case IR_store:
    case IR_store_where:
    case IR_scatter:
    case IR_window: return 1;
    case IR_when:
    case IR_loop: return leave(s, i);
    case IR_set: return s->read[i->k];
    case IR_get:
        if (s->live[number] && !s->read[i->k])
            s->found += s->read[i->k] = 1;
        break;
    case IR_next: s->fed[i->operand[0]] = s->live[i->operand[0]]; return s->live[i->operand[0]];
    case IR_phi: s->found += s->live[number] != s->fed[number]; break;
    case IR_join: s->joined |= s->live[number]; break;
    }
    return s->live[number];
}

static void sweep(struct sweep *s)
{
    s->found = s->depth = s->joined = 0;
    s->kept[0] = 0;
    uint8_t *live = s->live;
    for (uint32_t number = s->ir->count - 1; number > 0; number--) {
        const struct ir_instruction *i = &s->ir->instruction[number];
        if (i->op == IR_nop)
            continue;
        if (ir_op_information[i->op].properties & IR_CLOSES)
            enter(s, number);
        else if (i->op < IR_store ? live[number] : is_live(s, number)) {
            mark_operands(live, i);
            s->kept[s->depth] = 1;
        } else
            remove_instruction(s, number);
    }
}

unsigned pass_dead(struct ir *ir, struct pass_memory *memory)
{
    struct sweep s = {.ir = ir,
                      .live = memory->flag,
                      .read = memory->read,
                      .fed = memory->region,
                      .closing = memory->table,
                      .kept = memory->map};
    memset(s.live, 0, ir->count);
    memset(s.read, 0, ir->variables);
    if (ir->phis)
        memset(s.fed, 0, ir->count * sizeof s.fed[0]);
    if (ir->loops)
        do
            sweep(&s);
        while (s.found);
    s.removes = 1;
    sweep(&s);
    return s.changes;
}
