/* Who reads each value, found from back to front: its last reader is the first that is met.
 *
 * What is given before a loop and read in it must be there in every pass: it lives to the loop's end, of the
 * outermost loop that it is given before. What nobody reads is never asked for, and so neither is what only
 * it reads. A variable is not set where whatever way leads on sets it again before it is got: what is got
 * behind a region is got on the way past it too, and what a loop gets, at its end too. */
#include "stitch/plan.h"

#include <string.h>

/* Variables, as a set. */
struct variables {
    uint64_t bits[VARIABLES / 64];
};

struct walk {
    struct plan *plan;
    unsigned depth;
    uint32_t begin[NESTING_MAXIMUM], end[NESTING_MAXIMUM]; /* the open loops, from the outermost */
    struct variables wanted;                               /* got before they are set again */
    unsigned skips;
    struct variables behind[NESTING_MAXIMUM]; /* wanted at the ends of the open regions that may be skipped */
};

static int wants(const struct walk *walk, int32_t variable)
{
    return walk->wanted.bits[variable / 64] >> variable % 64 & 1;
}

static void want(struct walk *walk, int32_t variable)
{
    walk->wanted.bits[variable / 64] |= 1ull << variable % 64;
}

static void get_variable(struct walk *walk, struct operation *get, uint32_t number)
{
    uint32_t next_set = walk->plan->variable[get->k[0]].next_set;
    get->k[1] = !next_set || walk->plan->value[number].last < next_set;
    want(walk, get->k[0]);
}

static void set_variable(struct walk *walk, int32_t variable, uint32_t number)
{
    walk->wanted.bits[variable / 64] &= ~(1ull << variable % 64);
    walk->plan->variable[variable].next_set = number;
}

/* What the loop's next pass gets is wanted at its end. */
static void want_again(struct walk *walk, const struct operation *again, uint32_t number)
{
    for (uint32_t n = (uint32_t)again->k[0]; n < number; n++)
        if (walk->plan->operation[n].kind == OPERATION_GET)
            want(walk, walk->plan->operation[n].k[0]);
}

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

static int is_needed(const struct walk *walk, const struct operation *operation, uint32_t number)
{
    switch (operation->kind) {
    case OPERATION_COMPUTE:
    case OPERATION_LITERAL:
    case OPERATION_READ:
    case OPERATION_GET: return walk->plan->value[number].last != 0;
    case OPERATION_SET: return wants(walk, operation->k[0]);
    default: return 1;
    }
}

static void control(struct walk *walk, struct operation *operation, uint32_t number)
{
    switch (operation->kind) {
    case OPERATION_GET: get_variable(walk, operation, number); break;
    case OPERATION_SET: set_variable(walk, operation->k[0], number); break;
    case OPERATION_END: walk->behind[walk->skips++] = walk->wanted; break;
    case OPERATION_WHEN:
        walk->skips--;
        for (int i = 0; i < VARIABLES / 64; i++)
            walk->wanted.bits[i] |= walk->behind[walk->skips].bits[i];
        break;
    case OPERATION_AGAIN:
        walk->begin[walk->depth] = (uint32_t)operation->k[0];
        walk->end[walk->depth++] = number;
        want_again(walk, operation, number);
        break;
    case OPERATION_LOOP: walk->depth--; break;
    default: break;
    }
}

void plan_find_readers(struct plan *plan)
{
    struct walk walk; /* what is open, which is most of it, has no values yet */
    walk.plan = plan;
    walk.depth = walk.skips = 0;
    memset(&walk.wanted, 0, sizeof walk.wanted);
    if (plan->unrecorded || plan->depth > NESTING_MAXIMUM)
        return;
    for (uint32_t number = plan->operations - 1; number; number--) {
        struct operation *operation = &plan->operation[number];
        if (!is_needed(&walk, operation, number)) {
            operation->kind = OPERATION_NONE;
            continue;
        }
        control(&walk, operation, number);
        read_operands(&walk, operation, number);
    }
}
