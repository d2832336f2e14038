/* The locations of values during register allocation: a register, a slot of the stack frame, or memory to
 * read again. */
#ifndef ENGINES_STITCH_LOCATION_H
#define ENGINES_STITCH_LOCATION_H

#include "engines/stitch/plan.h"

/* The last register is reserved for fragments. */
enum { VECTORS = 15, VARIABLE_VECTORS = 7 };

/* The begin of an open region. */
struct opened {
    uint32_t part;
    uint32_t holds[VECTORS];
};

struct locating {
    struct plan *plan;
    uint32_t now;              /* the current operation */
    uint32_t holds[VECTORS];   /* the value in each register, 0: none */
    uint32_t free;             /* registers without a value, as a mask */
    uint32_t busy;             /* registers of the operation's operands */
    uint32_t variables;        /* registers of variables */
    int32_t variable[VECTORS]; /* the variable in each of them */
    uint32_t free_slots;
    int32_t bytes; /* of all slots */
    unsigned depth;
    struct opened opened[NESTING_MAXIMUM];
};

static inline struct value *location_value_at(const struct locating *p, uint32_t number)
{
    return &p->plan->value[number];
}

static inline struct variable_state *location_variable_at(const struct locating *p, int32_t variable)
{
    return &p->plan->variable[variable];
}

static inline bool location_in_vector(const struct locating *p, uint32_t number)
{
    return location_value_at(p, number)->vector != VECTOR_NONE;
}

static inline void location_hold(struct locating *p, unsigned vector, uint32_t number)
{
    p->holds[vector] = number;
    p->free &= ~(1u << vector);
    p->busy |= 1u << vector;
    location_value_at(p, number)->vector = (uint8_t)vector;
}

static inline void location_release_vector(struct locating *p, unsigned vector)
{
    location_value_at(p, p->holds[vector])->vector = VECTOR_NONE;
    p->holds[vector] = 0;
    p->free |= 1u << vector;
}

/* Appends a part of the current operation. */
static inline unsigned location_append_part(struct locating *p, const struct fragment *fragment,
                                            union arguments arguments)
{
    const struct operation *operation = &p->plan->operation[p->now];
    unsigned number = plan_append(p->plan, fragment, arguments);
    p->plan->part[number].file = operation->file;
    p->plan->part[number].line = operation->line;
    return number;
}

/* Frees the value's slot, if it has one of its own. */
static inline void location_free_slot(struct locating *p, struct value *value)
{
    if (value->slot != SLOT_NONE && !value->foreign)
        p->plan->free_slot[p->free_slots++] = value->slot;
    value->slot = SLOT_NONE;
}

/* Returns true if a fragment can read the value from memory as eight words. */
static inline bool location_in_memory(const struct locating *p, uint32_t number)
{
    const struct operation *operation = &p->plan->operation[number];
    if (location_in_vector(p, number))
        return false;
    return location_value_at(p, number)->slot != SLOT_NONE || operation->kind == OPERATION_LITERAL ||
           (operation->kind == OPERATION_READ && operation->fragment == &fragment_load);
}

/* The slot of a variable. It is never shared with a value. */
int32_t location_variable_slot(struct locating *p, int32_t variable);

/* Returns true if the value can be read from its origin again at any time during the routine. */
bool location_is_permanent(const struct locating *p, uint32_t number);

/* Stores the register's value to a slot, unless it has one or can be read again. */
void location_spill(struct locating *p, unsigned vector);

/* Spills the value whose next reader is the latest. Returns its register. */
unsigned location_evict(struct locating *p);

/* A register without a value. */
static inline unsigned location_take_vector(struct locating *p)
{
    return p->free ? (unsigned)__builtin_ctz(p->free) : location_evict(p);
}

/* The variable's register, or VECTOR_NONE for a variable in a slot. Chosen when the variable is first set. */
unsigned location_variable_vector(struct locating *p, int32_t number);

/* The offset of a literal among those after the code. */
int32_t location_literal_offset(struct plan *plan, struct operation *literal);

/* Sets argument n of a part to the value's address in memory. */
void location_set_address(struct locating *p, union arguments *arguments, unsigned n, uint32_t number);

/* The value's register. Loads the value if it is not in a register. */
int32_t location_load_value(struct locating *p, uint32_t number);

#endif
