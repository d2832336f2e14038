/* The primitives of draws: the rows of def/state/primitive.def. */
#ifndef RENDER_STATE_PRIMITIVE_H
#define RENDER_STATE_PRIMITIVE_H

#include "contract/key.h"
#include "triptych.h"

struct state_primitive {
    enum primitive kind; /* of its parts */
    uint8_t parts, each, more;
};

extern const struct state_primitive state_primitives[TRIPTYCH_PRIMITIVE_COUNT];

/* How many vertices a draw of `count` primitives has; count > 0. */
static inline uint64_t state_corners(enum triptych_primitive primitive, uint32_t count)
{
    const struct state_primitive *row = state_primitives + primitive;
    return (uint64_t)count * row->each + row->more;
}

#endif
