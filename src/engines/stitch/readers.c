/* Finds the readers of each value, from back to front. The first reader that is visited is the last one.
 *
 * A value that the routine's loop reads and that is computed before it is alive to the end.
 *
 * A value that is computed before a loop and read in it is needed in every iteration, so it ends with the
 * outermost such loop. An operation whose value is not read is dropped, and then so are the operations
 * that only it reads. A `set` is dropped if every path from it sets the variable again before it is read.
 * A variable that is read after a region is also needed at the region's begin, because the region may be
 * skipped, and a variable that is read in a loop is needed at the loop's end. */
#include "engines/stitch/plan.h"

#include <string.h>

/* Variables, as a set. */
struct variables {
    uint64_t bits[VARIABLES / 64];
};

struct walk {
    struct plan *plan;
    unsigned depth;
    uint32_t begin[NESTING_MAXIMUM], end[NESTING_MAXIMUM]; /* the open loops, from the outermost */
    struct variables needed; /* variables that are read before they are set again */
    unsigned skips;
    struct variables
        after[NESTING_MAXIMUM]; /* `needed` at the ends of the open regions that may be skipped */
};

static bool is_needed_variable(const struct walk *walk, int32_t variable)
{
    return walk->needed.bits[variable / 64] >> variable % 64 & 1;
}

static void need(struct walk *walk, int32_t variable)
{
    walk->needed.bits[variable / 64] |= 1ull << variable % 64;
}

static void get_variable(struct walk *walk, struct operation *get, uint32_t number)
{
    uint32_t next_set = walk->plan->variable[get->k[0]].next_set;
    get->k[1] = !next_set || walk->plan->value[number].last < next_set;
    need(walk, get->k[0]);
}

static void set_variable(struct walk *walk, int32_t variable, uint32_t number)
{
    walk->needed.bits[variable / 64] &= ~(1ull << variable % 64);
    walk->plan->variable[variable].next_set = number;
}

/* Variables that the next iteration reads are needed at the end of the loop. */
static void need_again(struct walk *walk, const struct operation *again, uint32_t number)
{
    for (uint32_t n = (uint32_t)again->k[0]; n < number; n++)
        if (walk->plan->operation[n].kind == OPERATION_GET)
            need(walk, walk->plan->operation[n].k[0]);
}

/* The end of the outermost open loop that begins after the value, or 0. */
static uint32_t loop_of(const struct walk *walk, uint32_t value)
{
    for (unsigned i = 0; i < walk->depth; i++)
        if (value < walk->begin[i])
            return walk->end[i];
    return 0;
}

/* Sets the last reader of a value: the reader, or the end of the loop. */
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
        value->read |= operation->once == ONCE_COMPUTED ? 2 : 1;
        operation->next[i] = value->last ? value->next : last_reader(walk, number, reader);
        value->next = reader;
    }
}

static bool is_needed(const struct walk *walk, const struct operation *operation, uint32_t number)
{
    switch (operation->kind) {
    case OPERATION_COMPUTE:
    case OPERATION_LITERAL:
    case OPERATION_READ:
    case OPERATION_GET: return walk->plan->value[number].last != 0;
    case OPERATION_SET: return is_needed_variable(walk, operation->k[0]);
    default: return true;
    }
}

static void control(struct walk *walk, struct operation *operation, uint32_t number)
{
    switch (operation->kind) {
    case OPERATION_GET: get_variable(walk, operation, number); break;
    case OPERATION_SET: set_variable(walk, operation->k[0], number); break;
    case OPERATION_END: walk->after[walk->skips++] = walk->needed; break;
    case OPERATION_WHEN:
        walk->skips--;
        for (int i = 0; i < VARIABLES / 64; i++)
            walk->needed.bits[i] |= walk->after[walk->skips].bits[i];
        break;
    case OPERATION_AGAIN:
        walk->begin[walk->depth] = (uint32_t)operation->k[0];
        walk->end[walk->depth++] = number;
        need_again(walk, operation, number);
        break;
    case OPERATION_LOOP: walk->depth--; break;
    default: break;
    }
}

/* Values that are read in the routine's loop, and computed or read before it, are alive to the end. */
static void keep_values(struct plan *plan)
{
    for (uint32_t number = 1; number < plan->operations; number++) {
        const struct operation *operation = &plan->operation[number];
        struct value *value = &plan->value[number];
        if (value->read & 1 && (operation->once == ONCE_COMPUTED || value->read & 2))
            value->last = plan->operations;
    }
}

void plan_find_readers(struct plan *plan)
{
    struct walk walk; /* its arrays are large and have no values yet */
    walk.plan = plan;
    walk.depth = walk.skips = 0;
    memset(&walk.needed, 0, sizeof walk.needed);
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
    keep_values(plan);
}
