/* Shared by the parts of the state: the values of tables (state_value.c), all other state (state.c). */
#ifndef RENDER_STATE_STATE_PART_H
#define RENDER_STATE_STATE_PART_H

#include "render/state/state.h"

/* Written so that a NaN fails. */
static inline bool state_within(double low, double value, double high)
{
    return value >= low && value <= high;
}

/* Sets all values of the tables to their defaults. */
void state_initialize_values(struct state *state);

#endif
