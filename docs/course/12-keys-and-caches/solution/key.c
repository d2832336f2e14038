#include "state.h"

/* Appends a parameter of `values` values to the key, a number of mixed radixes. */
static void append(uint32_t *number, unsigned values, unsigned value)
{
    *number = *number * values + value;
}

/* A blend whose factors are 1 and 0 has no effect. */
static int blends(const struct state *state)
{
    return state->blend && !(state->source_factor == 1 && state->destination_factor == 0);
}

/* A blend with the factors 0 and 1 leaves the target as it is. */
static int writes(const struct state *state)
{
    return !(state->blend && state->source_factor == 0 && state->destination_factor == 1);
}

/* The colour has an effect on what is written. A factor of 0 removes it, if the other factor does not read
 * it. */
static int color_matters(const struct state *state)
{
    return !state->blend || state->source_factor != 0 || state->destination_factor == 2 ||
           state->destination_factor == 3;
}

/* The texture has an effect if it is there, the stage reads it, and the result is read. */
static int samples(const struct state *state)
{
    return state->texture && state->stage != 0 && (color_matters(state) || state->alpha_test != 0);
}

struct key key_of(const struct state *state)
{
    uint32_t number = 0;
    int texture = samples(state), blend = blends(state);
    append(&number, 6, texture ? state->stage : 0);
    append(&number, 6, texture ? state->filter : 0);
    append(&number, 6, texture ? state->address : 0);
    append(&number, 6, state->alpha_test);
    append(&number, 4, blend ? state->source_factor : 1);
    append(&number, 4, blend ? state->destination_factor : 0);
    append(&number, 2, color_matters(state) ? state->fog : 0);
    if (!writes(state))
        number = 0xffff;
    return (struct key){{(uint8_t)number, (uint8_t)(number >> 8)}};
}
