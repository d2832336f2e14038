/* Who reads each value, found from back to front: its last reader is the first that is met.
 *
 * What is given before a loop and read in it must be there in every pass: it lives to the loop's end, of the
 * outermost loop that it is given before. What nobody reads is never asked for, and so neither is what only
 * it reads; variables that nobody gets are not set. */
#include "stitch/plan.h"

struct walk {
    struct plan *plan;
    unsigned depth;
    uint32_t begin[NESTING_MAXIMUM], end[NESTING_MAXIMUM]; /* the open loops, from the outermost */
};

/* The end of the outermost open loop that begins behind the value; 0: there is none. */
static uint32_t loop_of(const struct walk *walk, uint32_t value)
{
    for (unsigned i = 0; i < walk->depth; i++)
        if (value < walk->begin[i])
            return walk->end[i];
    return 0;
}

/* The value's last reader is found; in a loop that is its end. */
static uint32_t last_reader(const struct walk *walk, uint32_t number, uint32_t reader)
{
    struct value *value = &walk->plan->value[number];
    uint32_t end = loop_of(walk, number);
    value->last = end ? end : reader;
    if (end) {
        value->dying = walk->plan->value[end].dying;
        walk->plan->value[end].dying = number;
    }
    return end != reader ? end : 0;
}

static void read_operands(struct walk *walk, struct operation *operation, uint32_t reader)
{
    for (unsigned i = 0; i < operation->operands; i++) {
        uint32_t number = operation->operand[i];
        struct value *value = &walk->plan->value[number];
        operation->next[i] = value->last ? value->next : last_reader(walk, number, reader);
        value->next = reader;
    }
}

static int is_needed(const struct plan *plan, const struct operation *operation, uint32_t number)
{
    switch (operation->kind) {
    case OPERATION_COMPUTE:
    case OPERATION_LITERAL:
    case OPERATION_READ:
    case OPERATION_GET: return plan->value[number].last != 0;
    case OPERATION_SET: return plan->variable[operation->k[0]].gets != 0;
    default: return 1;
    }
}

void plan_find_readers(struct plan *plan)
{
    struct walk walk;
    walk.plan = plan;
    walk.depth = 0;
    if (plan->unrecorded || plan->depth > NESTING_MAXIMUM)
        return;
    for (uint32_t number = plan->operations - 1; number; number--) {
        struct operation *operation = &plan->operation[number];
        if (!is_needed(plan, operation, number)) {
            if (operation->kind == OPERATION_GET)
                plan->variable[operation->k[0]].gets--;
            operation->kind = OPERATION_NONE;
            continue;
        }
        if (operation->kind == OPERATION_AGAIN) {
            walk.begin[walk.depth] = (uint32_t)operation->k[0];
            walk.end[walk.depth++] = number;
        } else if (operation->kind == OPERATION_LOOP)
            walk.depth--;
        read_operands(&walk, operation, number);
    }
}
