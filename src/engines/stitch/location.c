#include "engines/stitch/location.h"

/* --- Slots --- */

static int32_t take_slot(struct locating *p)
{
    if (p->free_slots)
        return p->plan->free_slot[--p->free_slots];
    int32_t slot = p->bytes;
    p->bytes += SLOT_BYTES;
    return slot;
}

int32_t location_variable_slot(struct locating *p, int32_t variable)
{
    int32_t *slot = &p->plan->variable[variable].slot;
    if (*slot == SLOT_NONE) {
        *slot = p->bytes;
        p->bytes += SLOT_BYTES;
    }
    return *slot;
}

static void append_store(struct locating *p, unsigned vector, int32_t slot)
{
    location_append_part(p, &fragment_store,
                         (union arguments){{(int32_t)vector, slot, [ARGUMENT_BASE] = REGISTER_FRAME}});
    p->plan->counts.stored++;
}

/* --- Registers --- */

bool location_is_permanent(const struct locating *p, uint32_t number)
{
    const struct operation *operation = &p->plan->operation[number];
    return operation->kind == OPERATION_LITERAL ||
           (operation->kind == OPERATION_READ &&
            (operation->fragment == &fragment_uniform || !(p->plan->stored >> operation->k[1] & 1)));
}

void location_spill(struct locating *p, unsigned vector)
{
    struct value *value = location_value_at(p, p->holds[vector]);
    if (value->slot != SLOT_NONE || location_is_permanent(p, p->holds[vector]))
        return;
    value->slot = take_slot(p);
    append_store(p, vector, value->slot);
}

unsigned location_evict(struct locating *p)
{
    unsigned farthest = 0;
    uint32_t latest = 0;
    for (unsigned vector = 0; vector < VECTORS; vector++) {
        uint32_t number = p->holds[vector], next = location_value_at(p, number)->next;
        if (number && !next) /* a value of the preamble, for the next element */
            next = p->plan->operations;
        if (!(p->busy >> vector & 1) && next > latest) {
            latest = next;
            farthest = vector;
        }
    }
    location_spill(p, farthest);
    location_release_vector(p, farthest);
    return farthest;
}

/* --- Variables --- */

/* Frees the registers of variables that are no longer in use. */
static void release_variables(struct locating *p)
{
    for (uint32_t set = p->variables; set; set &= set - 1) {
        unsigned vector = (unsigned)__builtin_ctz(set);
        if (location_variable_at(p, p->variable[vector])->last < p->now) {
            location_variable_at(p, p->variable[vector])->vector = VECTOR_NONE;
            p->variables &= ~(1u << vector);
            p->free |= 1u << vector;
        }
    }
}

unsigned location_variable_vector(struct locating *p, int32_t number)
{
    struct variable_state *variable = location_variable_at(p, number);
    release_variables(p);
    if (variable->vector != VECTOR_NONE || variable->slot != SLOT_NONE ||
        __builtin_popcount(p->variables) == VARIABLE_VECTORS)
        return variable->vector;
    unsigned vector = location_take_vector(p);
    p->variable[vector] = number;
    p->variables |= 1u << vector;
    p->free &= ~(1u << vector);
    return variable->vector = (uint8_t)vector;
}

/* --- Operands --- */

int32_t location_literal_offset(struct plan *plan, struct operation *literal)
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

void location_set_address(struct locating *p, union arguments *arguments, unsigned n, uint32_t number)
{
    struct operation *operation = &p->plan->operation[number];
    int32_t slot = location_value_at(p, number)->slot;
    if (slot != SLOT_NONE) {
        arguments->value[n] = slot;
        arguments->value[ARGUMENT_BASE] = REGISTER_FRAME;
    } else if (operation->kind == OPERATION_LITERAL) {
        arguments->value[n] = location_literal_offset(p->plan, operation);
        arguments->value[ARGUMENT_BASE] = REGISTER_CONSTANTS;
    } else {
        arguments->value[n] = operation->k[0];
        arguments->value[ARGUMENT_BASE] = REGISTER_BASES + operation->k[1];
        p->plan->lost += operation->kind != OPERATION_READ;
    }
}

int32_t location_load_value(struct locating *p, uint32_t number)
{
    struct value *value = location_value_at(p, number);
    if (value->vector != VECTOR_NONE) {
        p->plan->counts.carried++;
        return value->vector;
    }
    const struct operation *operation = &p->plan->operation[number];
    bool read = value->slot == SLOT_NONE && operation->kind == OPERATION_READ;
    unsigned vector = location_take_vector(p);
    union arguments arguments = {{(int32_t)vector}};
    location_set_address(p, &arguments, 1, number);
    location_append_part(p, read ? operation->fragment : &fragment_load, arguments);
    p->plan->counts.loaded++;
    location_hold(p, vector, number);
    return (int32_t)vector;
}
