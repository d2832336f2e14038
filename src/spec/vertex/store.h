/* The outputs of the vertex routine: slots of the vertex batch (contract/layout.h), and the clip code of a
 * position. */
#ifndef SPEC_VERTEX_STORE_H
#define SPEC_VERTEX_STORE_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/vertex/clip.h"

static inline void store_slot(struct env *e, int slot, flt value)
{
    store_f(E, BASE_OUTPUT, slot * VERTEX_SLOT_BYTES, value);
}

static inline flt clamp_unit(struct env *e, flt value)
{
    flt low = max_f(E, value, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

static inline void store_color(struct env *e, int slot, const struct vector4 *color)
{
    for (int c = 0; c < 4; c++) {
        flt clamped = clamp_unit(E, color->v[c]);
        store_slot(E, slot + c, clamped);
    }
}

static inline bool in_window(const struct vertex_key *k)
{
    return k->attribute[ATTRIBUTE_POSITIONT] != ATTRIBUTE_FORMAT_NONE;
}

static inline void store_position(struct env *e, const struct vertex_key *k, const flt p[4])
{
    itg code = in_window(k) ? clip_code_window(E, p) : clip_code(E, k, p);
    store_i(E, BASE_OUTPUT, SLOT_CODE * VERTEX_SLOT_BYTES, code);
}

#endif
