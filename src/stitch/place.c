/* Where values are: which register each has, and which slot of the frame when registers do not suffice.
 *
 * One walk from front to back. A result goes to a register and stays there until its last reader has met it,
 * or until another value needs the register: then the one whose next reader is farthest away gives way, and
 * only then is it stored. A literal, or a word that is read from what no routine writes, is not brought
 * before somebody reads it, nor ever stored. An operand that is in memory is left there if the fragment can
 * take it from there.
 *
 * Control: whatever way it takes, a value must be where the next reader looks. So what is read behind a
 * region that may be skipped is stored before it, and behind it only those registers count that are the same
 * on both ways. A loop begins with empty registers: every pass finds what was given before it in the frame.
 *
 * Variables have registers of their own as long as they are in use, if there are not too many, so that neither
 * a region's end nor a loop's costs more than a copy; the others have slots. A value that was got is the
 * variable's register itself, unless that is set before the value's last reader.
 *
 * Slots are taken when something is stored and free again when its last reader has met it; the one freed
 * last is taken first, while it is in the cache. A variable has a slot that was never anything else's: in the
 * next pass of a loop that would be back. */
#include "stitch/plan.h"

#include <string.h>

/* The last one is the fragments'. */
enum { VECTORS = 15, VARIABLE_VECTORS = 7 };

/* The registers at a region's begin. */
struct opened {
    uint32_t part;
    uint32_t holds[VECTORS];
};

struct placing {
    struct plan *plan;
    uint32_t now;              /* the operation */
    uint32_t holds[VECTORS];   /* the value in each register, 0: none */
    uint32_t free;             /* registers without a value, as a mask */
    uint32_t busy;             /* those of the operation's operands */
    uint32_t variables;        /* registers of variables */
    int32_t variable[VECTORS]; /* which ones */
    uint32_t free_slots;
    int32_t bytes; /* of all slots */
    unsigned depth;
    struct opened opened[NESTING_MAXIMUM];
};

static struct value *value_at(const struct placing *p, uint32_t number)
{
    return &p->plan->value[number];
}

static unsigned append_part(struct placing *p, const struct fragment *fragment, struct arguments arguments)
{
    const struct operation *operation = &p->plan->operation[p->now];
    unsigned number = plan_append(p->plan, fragment, arguments);
    p->plan->part[number].file = operation->file;
    p->plan->part[number].line = operation->line;
    return number;
}

/* --- Slots --- */

static int32_t take_slot(struct placing *p)
{
    if (p->free_slots)
        return p->plan->free_slot[--p->free_slots];
    int32_t slot = p->bytes;
    p->bytes += SLOT_BYTES;
    return slot;
}

static void free_slot(struct placing *p, struct value *value)
{
    if (value->slot != SLOT_NONE && !value->foreign)
        p->plan->free_slot[p->free_slots++] = value->slot;
    value->slot = SLOT_NONE;
}

static int32_t variable_slot(struct placing *p, int32_t variable)
{
    int32_t *slot = &p->plan->variable[variable].slot;
    if (*slot == SLOT_NONE) {
        *slot = p->bytes;
        p->bytes += SLOT_BYTES;
    }
    return *slot;
}

static void append_store(struct placing *p, unsigned vector, int32_t slot)
{
    append_part(p, &fragment_store,
                (struct arguments){{(int32_t)vector, slot, [ARGUMENT_BASE] = REGISTER_FRAME}});
    p->plan->counts.stored++;
}

/* --- Registers --- */

static void hold(struct placing *p, unsigned vector, uint32_t number)
{
    p->holds[vector] = number;
    p->free &= ~(1u << vector);
    p->busy |= 1u << vector;
    value_at(p, number)->vector = (uint8_t)vector;
}

static void let_go(struct placing *p, unsigned vector)
{
    value_at(p, p->holds[vector])->vector = VECTOR_NONE;
    p->holds[vector] = 0;
    p->free |= 1u << vector;
}

/* Can be had again from where it came from, as long as the routine runs. */
static int is_permanent(const struct placing *p, uint32_t number)
{
    const struct operation *operation = &p->plan->operation[number];
    return operation->kind == OPERATION_LITERAL ||
           (operation->kind == OPERATION_READ &&
            (operation->fragment == &fragment_uniform || !(p->plan->stored >> operation->k[1] & 1)));
}

static void keep(struct placing *p, unsigned vector)
{
    struct value *value = value_at(p, p->holds[vector]);
    if (value->slot != SLOT_NONE || is_permanent(p, p->holds[vector]))
        return;
    value->slot = take_slot(p);
    append_store(p, vector, value->slot);
}

/* A register without a value; its last value, if it had one, is the one that is read latest. */
static unsigned take_vector(struct placing *p)
{
    if (p->free)
        return (unsigned)__builtin_ctz(p->free);
    unsigned farthest = 0;
    uint32_t latest = 0;
    for (unsigned vector = 0; vector < VECTORS; vector++) {
        uint32_t next = value_at(p, p->holds[vector])->next;
        if (!(p->busy >> vector & 1) && next > latest) {
            latest = next;
            farthest = vector;
        }
    }
    keep(p, farthest);
    let_go(p, farthest);
    return farthest;
}

/* --- Variables --- */

static struct variable_state *variable_at(const struct placing *p, int32_t variable)
{
    return &p->plan->variable[variable];
}

/* Registers of variables that are not in use any more are free again. */
static void release_variables(struct placing *p)
{
    for (uint32_t set = p->variables; set; set &= set - 1) {
        unsigned vector = (unsigned)__builtin_ctz(set);
        if (variable_at(p, p->variable[vector])->last < p->now) {
            variable_at(p, p->variable[vector])->vector = VECTOR_NONE;
            p->variables &= ~(1u << vector);
            p->free |= 1u << vector;
        }
    }
}

/* Where it is set first, a variable is given a register, or else a slot when that is asked for. */
static unsigned variable_vector(struct placing *p, int32_t number)
{
    struct variable_state *variable = variable_at(p, number);
    release_variables(p);
    if (variable->vector != VECTOR_NONE || variable->slot != SLOT_NONE ||
        __builtin_popcount(p->variables) == VARIABLE_VECTORS)
        return variable->vector;
    unsigned vector = take_vector(p);
    p->variable[vector] = number;
    p->variables |= 1u << vector;
    p->free &= ~(1u << vector);
    return variable->vector = (uint8_t)vector;
}

/* --- Operands --- */

static int in_vector(const struct placing *p, uint32_t number)
{
    return value_at(p, number)->vector != VECTOR_NONE;
}

/* Eight words that a fragment can take. */
static int in_memory(const struct placing *p, uint32_t number)
{
    const struct operation *operation = &p->plan->operation[number];
    if (in_vector(p, number))
        return 0;
    return value_at(p, number)->slot != SLOT_NONE || operation->kind == OPERATION_LITERAL ||
           (operation->kind == OPERATION_READ && operation->fragment == &fragment_load);
}

static int32_t literal_offset(struct plan *plan, struct operation *literal)
{
    if (!literal->k[1]) {
        if (plan->literals == POOL_CAPACITY) {
            plan->unpooled++;
            return 0;
        }
        plan->literal[plan->literals] = (uint32_t)literal->k[0];
        literal->k[1] = (int32_t)plan->literals++;
    }
    return literal->k[1] * SLOT_BYTES;
}

/* Where the value is in memory, as argument n of a part. */
static void set_address(struct placing *p, struct arguments *arguments, unsigned n, uint32_t number)
{
    struct operation *operation = &p->plan->operation[number];
    int32_t slot = value_at(p, number)->slot;
    if (slot != SLOT_NONE) {
        arguments->value[n] = slot;
        arguments->value[ARGUMENT_BASE] = REGISTER_FRAME;
    } else if (operation->kind == OPERATION_LITERAL) {
        arguments->value[n] = literal_offset(p->plan, operation);
        arguments->value[ARGUMENT_BASE] = REGISTER_CONSTANTS;
    } else {
        arguments->value[n] = operation->k[0];
        arguments->value[ARGUMENT_BASE] = REGISTER_BASES + operation->k[1];
        p->plan->lost += operation->kind != OPERATION_READ;
    }
}

/* The value's register, into which it is brought if it is not there. */
static int32_t bring(struct placing *p, uint32_t number)
{
    struct value *value = value_at(p, number);
    if (value->vector != VECTOR_NONE) {
        p->plan->counts.carried++;
        return value->vector;
    }
    const struct operation *operation = &p->plan->operation[number];
    int read = value->slot == SLOT_NONE && operation->kind == OPERATION_READ;
    unsigned vector = take_vector(p);
    struct arguments arguments = {{(int32_t)vector}};
    set_address(p, &arguments, 1, number);
    append_part(p, read ? operation->fragment : &fragment_load, arguments);
    p->plan->counts.loaded++;
    hold(p, vector, number);
    return (int32_t)vector;
}

static int dies(const struct placing *p, uint32_t number)
{
    return value_at(p, number)->last == p->now;
}

static int is_variables(const struct placing *p, uint32_t number)
{
    return in_vector(p, number) && p->holds[value_at(p, number)->vector] != number;
}

/* Its register, if it has one, can be changed. */
static int gives_way(const struct placing *p, uint32_t number)
{
    return dies(p, number) && !is_variables(p, number);
}

static void leave_vector(struct placing *p, uint32_t number)
{
    if (is_variables(p, number))
        value_at(p, number)->vector = VECTOR_NONE;
    else if (in_vector(p, number))
        let_go(p, value_at(p, number)->vector);
}

/* The operands are about to be read: the registers of those that die can take the result. Their slots can not
 * yet take anything: what gives way to the result is stored before they are read. The first of two that are
 * the same value knows the next reader. */
static void finish_operands(struct placing *p, const struct operation *operation)
{
    for (unsigned i = operation->operands; i--;) {
        uint32_t number = operation->operand[i];
        if (!dies(p, number))
            value_at(p, number)->next = operation->next[i];
        else
            leave_vector(p, number);
    }
}

static void free_operands_slots(struct placing *p, const struct operation *operation)
{
    for (unsigned i = 0; i < operation->operands; i++)
        if (dies(p, operation->operand[i]))
            free_slot(p, value_at(p, operation->operand[i]));
}

/* Operands in registers are not to give way to one another. */
static void begin_operands(struct placing *p, const struct operation *operation)
{
    p->busy = 0;
    for (unsigned i = 0; i < operation->operands; i++)
        if (in_vector(p, operation->operand[i]))
            p->busy |= 1u << value_at(p, operation->operand[i])->vector;
}

/* --- Operations --- */

/* Argument n of a part, from its register or, if the fragment can, from memory. */
static const struct fragment *set_operand(struct placing *p, const struct fragment *fragment,
                                          struct arguments *arguments, unsigned n, uint32_t number)
{
    if (fragment->pooled >> n & 1) {
        arguments->value[n] = literal_offset(p->plan, &p->plan->operation[number]);
        return fragment;
    }
    if (fragment->folded == n && in_memory(p, number)) {
        set_address(p, arguments, n, number);
        p->plan->counts.folded++;
        return fragment + 1;
    }
    arguments->value[n] = bring(p, number);
    return fragment;
}

/* Each behind the other: those that make a new value, a factor's register the result's, the sum's. */
enum { MAD_FACTOR = 2, MAD_SUM = 4 };

static void exchange(struct operation *operation)
{
    uint32_t number = operation->operand[0], next = operation->next[0];
    operation->operand[0] = operation->operand[1];
    operation->next[0] = operation->next[1];
    operation->operand[1] = number;
    operation->next[1] = next;
}

static void append_result(struct placing *p, const struct fragment *fragment, struct arguments arguments,
                          unsigned vector)
{
    arguments.value[0] = (int32_t)vector;
    append_part(p, fragment, arguments);
    hold(p, vector, p->now);
}

static void place_compute(struct placing *p, struct operation *operation)
{
    const struct fragment *fragment = operation->fragment, *form = fragment;
    struct arguments arguments = {{0}};
    if (operation->commutes && in_memory(p, operation->operand[0]) && !in_memory(p, operation->operand[1]))
        exchange(operation);
    memcpy(arguments.value + 1 + operation->operands, operation->k, sizeof operation->k);
    for (unsigned i = 0; i < operation->operands; i++) {
        const struct fragment *chosen = set_operand(p, fragment, &arguments, i + 1, operation->operand[i]);
        form = chosen != fragment ? chosen : form;
    }
    unsigned vector = fragment->apart ? take_vector(p) : 0;
    finish_operands(p, operation);
    if (!fragment->apart)
        vector = take_vector(p);
    append_result(p, form, arguments, vector);
}

/* a * b + c in the register of an operand that dies, if there is one. */
static void place_mad_in(struct placing *p, struct operation *operation, const struct fragment *fragment,
                         uint32_t taken, uint32_t first, uint32_t second)
{
    struct arguments arguments = {{0}};
    unsigned vector = (unsigned)bring(p, taken);
    arguments.value[1] = bring(p, first);
    fragment = set_operand(p, fragment, &arguments, 2, second);
    finish_operands(p, operation);
    append_result(p, fragment, arguments, vector);
}

static void place_mad(struct placing *p, struct operation *operation)
{
    uint32_t *operand = operation->operand, sum = operand[2];
    if (in_memory(p, operand[0]) && !in_memory(p, operand[1]))
        exchange(operation);
    if (gives_way(p, sum) && in_vector(p, sum) && sum != operand[0] && sum != operand[1]) {
        place_mad_in(p, operation, operation->fragment + MAD_SUM, sum, operand[0], operand[1]);
        return;
    }
    if (gives_way(p, operand[1]) && !gives_way(p, operand[0]))
        exchange(operation);
    if (gives_way(p, operand[0]))
        place_mad_in(p, operation, operation->fragment + MAD_FACTOR, operand[0], operand[1], sum);
    else
        place_compute(p, operation);
}

static void append_copy(struct placing *p, unsigned to, unsigned from)
{
    append_part(p, &fragment_copy, (struct arguments){{(int32_t)to, (int32_t)from}});
}

/* The variable's register, if that stays as it is; into another at once, or left in the frame to a reader that
 * follows at once. */
static void place_get(struct placing *p, const struct operation *operation)
{
    struct value *value = value_at(p, p->now);
    struct variable_state *variable = variable_at(p, operation->k[0]);
    if (variable->vector != VECTOR_NONE && operation->k[1]) {
        value->vector = variable->vector;
        variable->last = variable->last < value->last ? value->last : variable->last;
        return;
    }
    if (variable->vector != VECTOR_NONE) {
        unsigned vector = take_vector(p);
        append_copy(p, vector, variable->vector);
        hold(p, vector, p->now);
        return;
    }
    value->slot = variable_slot(p, operation->k[0]);
    value->foreign = 1;
    if (value->last == p->now + 1)
        return;
    bring(p, p->now);
    value->slot = SLOT_NONE;
    value->foreign = 0;
}

/* What is in no register comes into the variable's at once. */
static void set_vector(struct placing *p, unsigned vector, uint32_t number)
{
    if (in_memory(p, number)) {
        struct arguments arguments = {{(int32_t)vector}};
        set_address(p, &arguments, 1, number);
        append_part(p, &fragment_load, arguments);
        p->plan->counts.loaded++;
    } else
        append_copy(p, vector, (unsigned)bring(p, number));
}

static void place_store(struct placing *p, const struct operation *operation, int32_t offset, int32_t base)
{
    struct arguments arguments = {{bring(p, operation->operand[0]), offset, [ARGUMENT_BASE] = base}};
    append_part(p, &fragment_store, arguments);
    finish_operands(p, operation);
}

static void place_set(struct placing *p, const struct operation *operation)
{
    unsigned vector = variable_vector(p, operation->k[0]);
    if (vector == VECTOR_NONE) {
        place_store(p, operation, variable_slot(p, operation->k[0]), REGISTER_FRAME);
        return;
    }
    set_vector(p, vector, operation->operand[0]);
    finish_operands(p, operation);
}

static void place_scatter(struct placing *p, const struct operation *operation)
{
    struct arguments arguments = {
        {bring(p, operation->operand[0]), operation->k[0], operation->k[1], operation->k[2]}};
    append_part(p, operation->fragment, arguments);
    finish_operands(p, operation);
}

/* --- Control --- */

static void place_when(struct placing *p, const struct operation *operation)
{
    struct opened *opened = &p->opened[p->depth++];
    int32_t mask = bring(p, operation->operand[0]);
    finish_operands(p, operation);
    for (uint32_t held = ~(p->free | p->variables) & ((1u << VECTORS) - 1); held; held &= held - 1) {
        unsigned vector = (unsigned)__builtin_ctz(held);
        if (value_at(p, p->holds[vector])->last > (uint32_t)operation->k[0])
            keep(p, vector);
    }
    memcpy(opened->holds, p->holds, sizeof opened->holds);
    opened->part = append_part(p, &fragment_when, (struct arguments){{mask}});
}

static void place_end(struct placing *p)
{
    const struct opened *opened = &p->opened[--p->depth];
    plan_land(p->plan, opened->part, 1);
    for (unsigned vector = 0; vector < VECTORS; vector++)
        if (p->holds[vector] && p->holds[vector] != opened->holds[vector])
            let_go(p, vector);
}

static void place_loop(struct placing *p)
{
    for (unsigned vector = 0; vector < VECTORS; vector++)
        if (p->holds[vector]) {
            keep(p, vector);
            let_go(p, vector);
        }
    p->opened[p->depth++].part = p->plan->count;
}

static void bury(struct placing *p, uint32_t number)
{
    struct value *value = value_at(p, number);
    leave_vector(p, number);
    free_slot(p, value);
}

static void place_again(struct placing *p, const struct operation *operation)
{
    int32_t begin = (int32_t)p->opened[--p->depth].part;
    append_part(p, &fragment_again, (struct arguments){{bring(p, operation->operand[0]), begin}});
    finish_operands(p, operation);
    for (uint32_t number = value_at(p, p->now)->dying; number; number = value_at(p, number)->dying)
        bury(p, number);
}

static void place(struct placing *p, struct operation *operation)
{
    begin_operands(p, operation);
    switch (operation->kind) {
    case OPERATION_COMPUTE:
        if (operation->fragment->in_place)
            place_mad(p, operation);
        else
            place_compute(p, operation);
        break;
    case OPERATION_READ:
        if (!is_permanent(p, p->now))
            bring(p, p->now);
        break;
    case OPERATION_GET: place_get(p, operation); break;
    case OPERATION_SET: place_set(p, operation); break;
    case OPERATION_STORE: place_store(p, operation, operation->k[0], REGISTER_BASES + operation->k[1]); break;
    case OPERATION_SCATTER: place_scatter(p, operation); break;
    case OPERATION_WHEN: place_when(p, operation); break;
    case OPERATION_END: place_end(p); break;
    case OPERATION_LOOP: place_loop(p); break;
    case OPERATION_AGAIN: place_again(p, operation); break;
    default: return;
    }
    free_operands_slots(p, operation);
}

static void start(struct placing *p, struct plan *plan)
{
    p->plan = plan;
    memset(p->holds, 0, sizeof p->holds);
    p->free = (1u << VECTORS) - 1;
    p->variables = p->free_slots = p->depth = 0;
    p->bytes = 0;
}

int32_t plan_place(struct plan *plan)
{
    struct placing p; /* what is opened, which is most of it, has no values yet */
    start(&p, plan);
    if (plan->unrecorded || plan->depth > NESTING_MAXIMUM)
        return 0;
    for (p.now = 1; p.now < plan->operations; p.now++) {
        struct operation *operation = &plan->operation[p.now];
        plan->counts.operations += operation->kind != OPERATION_NONE;
        plan->counts.fused += operation->kind != OPERATION_NONE && operation->fused;
        place(&p, operation);
    }
    return p.bytes;
}
