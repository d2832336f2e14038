#include "derived.h"

#include "contract/key_query.h"

#include <string.h>

void derived_make(const struct situation *situation, struct derived *d)
{
    const struct state *state = &situation->state;
    enum primitive primitive = derive_primitive(state, situation->drawn);
    memset(d, 0, sizeof *d);
    derive_keys(state, primitive, d->key);
    for (int u = 0; u < UNIT_COUNT; u++)
        d->packed[u] = key_pack(u, &d->key[u]);
    derive_job(state, &d->key[UNIT_VERTEX].vertex, &d->key[UNIT_PIXEL].pixel, &d->values.job);
    d->values.scissor = derive_area(state, false);
    d->values.wrapped = derive_wrapped(state, &d->key[UNIT_PIXEL].pixel);
    d->values.sample_mask = derive_sampling(state).mask;
    d->values.shape = derive_shape(&d->key[UNIT_SETUP].setup);
    d->values.clip_ignored = derive_clip_ignored(state);
    d->values.last_pixel = d->values.shape == SHAPE_LINE && derive_last_pixel(state);
    d->values.line_extra = d->values.shape == SHAPE_LINE ? derive_line_extra(state) : 0;
    d->values.line_width = d->values.shape == SHAPE_SMOOTH_LINE ? derive_line_width(state, primitive) : 0;
    const struct state_element *masks = derive_edge_masks(state);
    if (masks && d->values.shape == SHAPE_SMOOTH_TRIANGLE)
        d->values.masks = derive_element(state, masks);
    d->values.edges = d->values.shape == SHAPE_SMOOTH_TRIANGLE ? derive_edges(state) : 0;
}

bool derived_key_differs(const struct derived *a, const struct derived *b, int unit)
{
    return !key_equal(&a->packed[unit], &b->packed[unit]);
}

bool derived_values_differ(const struct derived *a, const struct derived *b)
{
    return memcmp(&a->values, &b->values, sizeof a->values) != 0;
}

bool derived_differ(const struct derived *a, const struct derived *b)
{
    bool keys = false;
    for (int u = 0; u < UNIT_COUNT; u++)
        keys |= derived_key_differs(a, b, u);
    return keys || derived_values_differ(a, b);
}

/* Returns true if the pixel routine reads other results of setup. */
static bool pixel_reads_differ(const struct derived *a, const struct derived *b)
{
    const struct pixel_key *x = &a->key[UNIT_PIXEL].pixel, *y = &b->key[UNIT_PIXEL].pixel;
    return memcmp(x->varying, y->varying, sizeof x->varying) != 0 ||
           pixel_reads_depth(x) != pixel_reads_depth(y) ||
           (x->stencil == STENCIL_TWO) != (y->stencil == STENCIL_TWO) || pixel_reads_w(x) != pixel_reads_w(y);
}

bool derived_later_reads_differ(const struct derived *a, const struct derived *b, int unit)
{
    return (unit < UNIT_PIXEL && pixel_reads_differ(a, b)) ||
           (unit < UNIT_SETUP && derived_key_differs(a, b, UNIT_SETUP));
}
