/* Register allocation: gives each value of an operation plan a register, or a slot of the stack frame when
 * there are not enough registers, and appends the operations' parts.
 *
 * One walk from front to back. A result is put in a register. It stays there until its last reader, or until
 * another value needs the register. The value whose next reader is the farthest is spilled first, and only
 * then is it stored. A literal, or a word from memory that no routine writes, is loaded only before a reader
 * and never stored. An operand in memory is not loaded if the fragment has a form that reads memory.
 *
 * The operations that are executed once a call are first. The routine's loop begins with empty registers, and
 * reads their results from slots, which are never free again.
 *
 * Control flow: on every path, a value must be where the next reader expects it. So a value that is read
 * after a region that may be skipped is stored before the region, and after it only the registers that are
 * equal on both paths are valid. A loop begins with empty registers: every iteration reads earlier values
 * from the stack frame.
 *
 * At most VARIABLE_VECTORS variables have registers of their own while they are in use, so that the end of a
 * region or a loop costs at most a copy. The other variables have slots. A value that was read from a
 * variable shares the variable's register, unless the variable is set before the value's last reader.
 *
 * A slot is free again after its value's last reader. The slot freed last is reused first, while it is in the
 * cache. A variable's slot is never shared: the next iteration of a loop would read it again. */
#include "engines/stitch/location.h"

#include <string.h>

/* --- Operands --- */

static bool ends(const struct locating *p, uint32_t number)
{
    return location_value_at(p, number)->last == p->now;
}

static bool is_of_variable(const struct locating *p, uint32_t number)
{
    return location_in_vector(p, number) && p->holds[location_value_at(p, number)->vector] != number;
}

/* Returns true if the operation may overwrite the value's register. */
static bool may_change(const struct locating *p, uint32_t number)
{
    return ends(p, number) && !is_of_variable(p, number);
}

/* Removes the value from its register. */
static void leave_vector(struct locating *p, uint32_t number)
{
    if (is_of_variable(p, number))
        location_value_at(p, number)->vector = VECTOR_NONE;
    else if (location_in_vector(p, number))
        location_release_vector(p, location_value_at(p, number)->vector);
}

/* Frees the registers of operands that end here, for the result. Their slots are not free yet: a value that
 * the result evicts is stored before the operands are read. If two operands are the same value, the first has
 * its next reader. */
static void finish_operands(struct locating *p, const struct operation *operation)
{
    for (unsigned i = operation->operands; i--;) {
        uint32_t number = operation->operand[i];
        if (!ends(p, number))
            location_value_at(p, number)->next = operation->next[i];
        else
            leave_vector(p, number);
    }
}

/* Frees the slots of operands that end here. */
static void free_operands_slots(struct locating *p, const struct operation *operation)
{
    for (unsigned i = 0; i < operation->operands; i++)
        if (ends(p, operation->operand[i]))
            location_free_slot(p, location_value_at(p, operation->operand[i]));
}

/* Marks the operands' registers as busy, so that loading one operand does not evict another. */
static void begin_operands(struct locating *p, const struct operation *operation)
{
    p->busy = 0;
    for (unsigned i = 0; i < operation->operands; i++)
        if (location_in_vector(p, operation->operand[i]))
            p->busy |= 1u << location_value_at(p, operation->operand[i])->vector;
}

/* --- Operations --- */

/* Sets argument n of a part to the value's register, or to its address if the fragment has a form for memory.
 * Returns the form. */
static const struct fragment *set_operand(struct locating *p, const struct fragment *fragment,
                                          union arguments *arguments, unsigned n, uint32_t number)
{
    if (fragment->pooled >> n & 1) {
        arguments->value[n] = location_literal_offset(p->plan, &p->plan->operation[number]);
        return fragment;
    }
    if (fragment->folded == n && location_in_memory(p, number)) {
        location_set_address(p, arguments, n, number);
        p->plan->counts.folded++;
        return fragment + 1;
    }
    arguments->value[n] = location_load_value(p, number);
    return fragment;
}

/* The forms of mad follow each other, each with its form for memory: result in a register of its own, in a
 * factor's, in the sum's. */
enum { MAD_FACTOR = 2, MAD_SUM = 4 };

static void exchange(struct operation *operation)
{
    uint32_t number = operation->operand[0], next = operation->next[0];
    operation->operand[0] = operation->operand[1];
    operation->next[0] = operation->next[1];
    operation->operand[1] = number;
    operation->next[1] = next;
}

static void append_result(struct locating *p, const struct fragment *fragment, union arguments arguments,
                          unsigned vector)
{
    arguments.value[0] = (int32_t)vector;
    location_append_part(p, fragment, arguments);
    location_hold(p, vector, p->now);
}

static void locate_compute(struct locating *p, struct operation *operation)
{
    const struct fragment *fragment = operation->fragment, *form = fragment;
    union arguments arguments = {{0}};
    if (operation->commutes && location_in_memory(p, operation->operand[0]) &&
        !location_in_memory(p, operation->operand[1]))
        exchange(operation);
    memcpy(arguments.value + 1 + operation->operands, operation->k, sizeof operation->k);
    for (unsigned i = 0; i < operation->operands; i++) {
        const struct fragment *chosen = set_operand(p, fragment, &arguments, i + 1, operation->operand[i]);
        form = chosen != fragment ? chosen : form;
    }
    unsigned vector = fragment->apart ? location_take_vector(p) : 0;
    finish_operands(p, operation);
    if (!fragment->apart)
        vector = location_take_vector(p);
    append_result(p, form, arguments, vector);
}

/* a * b + c in the register of `taken`, an operand that ends here. */
static void locate_mad_in(struct locating *p, struct operation *operation, const struct fragment *fragment,
                          uint32_t taken, uint32_t first, uint32_t second)
{
    union arguments arguments = {{0}};
    unsigned vector = (unsigned)location_load_value(p, taken);
    arguments.value[1] = location_load_value(p, first);
    fragment = set_operand(p, fragment, &arguments, 2, second);
    finish_operands(p, operation);
    append_result(p, fragment, arguments, vector);
}

static void locate_mad(struct locating *p, struct operation *operation)
{
    uint32_t *operand = operation->operand, sum = operand[2];
    if (location_in_memory(p, operand[0]) && !location_in_memory(p, operand[1]))
        exchange(operation);
    if (may_change(p, sum) && location_in_vector(p, sum) && sum != operand[0] && sum != operand[1]) {
        locate_mad_in(p, operation, operation->fragment + MAD_SUM, sum, operand[0], operand[1]);
        return;
    }
    if (may_change(p, operand[1]) && !may_change(p, operand[0]))
        exchange(operation);
    if (may_change(p, operand[0]))
        locate_mad_in(p, operation, operation->fragment + MAD_FACTOR, operand[0], operand[1], sum);
    else
        locate_compute(p, operation);
}

static void append_copy(struct locating *p, unsigned to, unsigned from)
{
    location_append_part(p, &fragment_copy, (union arguments){{(int32_t)to, (int32_t)from}});
}

/* The value is the variable's register if the variable is not set before the value's last reader, else a
 * copy. The value of a variable in a slot stays there if only the next operation reads it. */
static void locate_get(struct locating *p, const struct operation *operation)
{
    struct value *value = location_value_at(p, p->now);
    struct variable_state *variable = location_variable_at(p, operation->k[0]);
    if (variable->vector != VECTOR_NONE && operation->k[1]) {
        value->vector = variable->vector;
        variable->last = variable->last < value->last ? value->last : variable->last;
        return;
    }
    if (variable->vector != VECTOR_NONE) {
        unsigned vector = location_take_vector(p);
        append_copy(p, vector, variable->vector);
        location_hold(p, vector, p->now);
        return;
    }
    value->slot = location_variable_slot(p, operation->k[0]);
    value->foreign = 1;
    if (value->last == p->now + 1)
        return;
    location_load_value(p, p->now);
    value->slot = SLOT_NONE;
    value->foreign = 0;
}

/* Copies or loads the value into a variable's register. */
static void load_vector(struct locating *p, unsigned vector, uint32_t number)
{
    if (location_in_memory(p, number)) {
        union arguments arguments = {{(int32_t)vector}};
        location_set_address(p, &arguments, 1, number);
        location_append_part(p, &fragment_load, arguments);
        p->plan->counts.loaded++;
    } else
        append_copy(p, vector, (unsigned)location_load_value(p, number));
}

static void locate_store(struct locating *p, const struct operation *operation, int32_t offset, int32_t base)
{
    union arguments arguments = {
        {location_load_value(p, operation->operand[0]), offset, [ARGUMENT_BASE] = base}};
    location_append_part(p, &fragment_store, arguments);
    finish_operands(p, operation);
}

static void locate_set(struct locating *p, const struct operation *operation)
{
    unsigned vector = location_variable_vector(p, operation->k[0]);
    if (vector == VECTOR_NONE) {
        locate_store(p, operation, location_variable_slot(p, operation->k[0]), REGISTER_FRAME);
        return;
    }
    load_vector(p, vector, operation->operand[0]);
    finish_operands(p, operation);
}

static void locate_scatter(struct locating *p, const struct operation *operation)
{
    union arguments arguments = {
        {location_load_value(p, operation->operand[0]), operation->k[0], operation->k[1], operation->k[2]}};
    location_append_part(p, operation->fragment, arguments);
    finish_operands(p, operation);
}

/* --- Control --- */

static void locate_when(struct locating *p, const struct operation *operation)
{
    struct opened *opened = &p->opened[p->depth++];
    int32_t mask = location_load_value(p, operation->operand[0]);
    finish_operands(p, operation);
    for (uint32_t held = ~(p->free | p->variables) & ((1u << VECTORS) - 1); held; held &= held - 1) {
        unsigned vector = (unsigned)__builtin_ctz(held);
        if (location_value_at(p, p->holds[vector])->last > (uint32_t)operation->k[0])
            location_spill(p, vector);
    }
    memcpy(opened->holds, p->holds, sizeof opened->holds);
    opened->part = location_append_part(p, &fragment_when, (union arguments){{mask}});
}

static void locate_end(struct locating *p)
{
    const struct opened *opened = &p->opened[--p->depth];
    plan_land(p->plan, opened->part, 1);
    for (unsigned vector = 0; vector < VECTORS; vector++)
        if (p->holds[vector] && p->holds[vector] != opened->holds[vector])
            location_release_vector(p, vector);
}

/* Stores the values in registers, unless they are in memory already, and empties the registers. */
static void leave_vectors(struct locating *p)
{
    for (unsigned vector = 0; vector < VECTORS; vector++)
        if (p->holds[vector]) {
            location_spill(p, vector);
            location_release_vector(p, vector);
        }
}

static void locate_loop(struct locating *p)
{
    leave_vectors(p);
    p->opened[p->depth++].part = p->plan->count;
}

static void end_value(struct locating *p, uint32_t number)
{
    struct value *value = location_value_at(p, number);
    leave_vector(p, number);
    location_free_slot(p, value);
}

static void locate_again(struct locating *p, const struct operation *operation)
{
    int32_t begin = (int32_t)p->opened[--p->depth].part;
    location_append_part(p, &fragment_again,
                         (union arguments){{location_load_value(p, operation->operand[0]), begin}});
    finish_operands(p, operation);
    for (uint32_t number = location_value_at(p, p->now)->dying; number;
         number = location_value_at(p, number)->dying)
        if (ends(p, number))
            end_value(p, number);
}

static void locate(struct locating *p, struct operation *operation)
{
    begin_operands(p, operation);
    switch (operation->kind) {
    case OPERATION_COMPUTE:
        if (operation->fragment->in_place)
            locate_mad(p, operation);
        else
            locate_compute(p, operation);
        break;
    case OPERATION_READ:
        if (!location_is_permanent(p, p->now))
            location_load_value(p, p->now);
        break;
    case OPERATION_GET: locate_get(p, operation); break;
    case OPERATION_SET: locate_set(p, operation); break;
    case OPERATION_STORE:
        locate_store(p, operation, operation->k[0], REGISTER_BASES + operation->k[1]);
        break;
    case OPERATION_SCATTER: locate_scatter(p, operation); break;
    case OPERATION_WHEN: locate_when(p, operation); break;
    case OPERATION_END: locate_end(p); break;
    case OPERATION_LOOP: locate_loop(p); break;
    case OPERATION_AGAIN: locate_again(p, operation); break;
    default: return;
    }
    free_operands_slots(p, operation);
}

static void start(struct locating *p, struct plan *plan)
{
    p->plan = plan;
    memset(p->holds, 0, sizeof p->holds);
    p->free = (1u << VECTORS) - 1;
    p->variables = p->free_slots = p->depth = 0;
    p->bytes = 0;
}

/* Appends the parts of the operations that are executed once, or of the others. */
static void locate_all(struct locating *p, bool once)
{
    for (p->now = 1; p->now < p->plan->operations; p->now++) {
        struct operation *operation = &p->plan->operation[p->now];
        if ((operation->once == ONCE_COMPUTED) != once)
            continue;
        p->plan->counts.operations += operation->kind != OPERATION_NONE;
        p->plan->counts.fused += operation->kind != OPERATION_NONE && operation->fused;
        locate(p, operation);
    }
}

int32_t plan_locate(struct plan *plan, enum unit unit, struct loop *loop)
{
    struct locating p; /* what is opened, which is most of it, has no values yet */
    start(&p, plan);
    if (plan->unrecorded || plan->depth > NESTING_MAXIMUM)
        return 0;
    locate_all(&p, true);
    p.now = 0;
    leave_vectors(&p);
    plan_begin_loop(plan, unit, loop);
    locate_all(&p, false);
    return p.bytes;
}
