/* Derivation, whole: the pixel key first, then what it needs of setup, then what both need of vertices. */
#include "draw/derive_part.h"

#include <math.h>
#include <string.h>

_Static_assert((int)ATTRIBUTE_FORMAT_COUNT == (int)TRIPTYCH_FORMAT_COUNT,
               "formats agree with the public ones");
_Static_assert((int)ATTRIBUTE_COUNT == (int)TRIPTYCH_ATTRIBUTE_COUNT,
               "attributes agree with the public ones");
_Static_assert((int)LIGHT_COUNT == (int)TRIPTYCH_LIGHTS, "as many lights as the public ones");
_Static_assert((int)LIGHT_POINT == TRIPTYCH_LIGHT_POINT + 1, "light types follow the public ones");
_Static_assert((int)TARGET_SIZE_MAXIMUM == (int)TRIPTYCH_TARGET_MAXIMUM, "one limit of the target");

static bool smooth_varyings(const struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] == INTERPOLATION_SMOOTH)
            return true;
    return false;
}

void derive_setup(const struct state *state, const struct pixel_key *pixel, struct setup_key *key)
{
    key->cull = (uint8_t)(GET(cullmode) - CULLMODE_none);
    key->window = state->element[ATTRIBUTE_POSITIONT].format != TRIPTYCH_FORMAT_NONE;
    key->depth = (uint8_t)pixel_reads_depth(pixel);
    key->w = pixel_reads_w(pixel) && !smooth_varyings(pixel);
    memcpy(key->varying, pixel->varying, sizeof key->varying);
}

bool derive_effective(const struct pixel_key *key)
{
    return pixel_write_mask(key) || key->depth_write;
}

void derive_keys(const struct state *state, union key key[UNIT_COUNT])
{
    memset(key, 0, UNIT_COUNT * sizeof *key);
    derive_pixel(state, &key[UNIT_PIXEL].pixel);
    derive_setup(state, &key[UNIT_PIXEL].pixel, &key[UNIT_SETUP].setup);
    derive_vertex(state, &key[UNIT_PIXEL].pixel, &key[UNIT_VERTEX].vertex);
}

/* Column i's centre is at i + 1/2. */
static int32_t first_centre(double edge)
{
    return (int32_t)ceil(edge - 0.5);
}

static int32_t at_least(int32_t low, int32_t value)
{
    return value < low ? low : value;
}

static int32_t at_most(int32_t high, int32_t value)
{
    return value > high ? high : value;
}

struct rectangle derive_scissor(const struct state *state)
{
    double x = (double)state->viewport.x, y = (double)state->viewport.y;
    struct rectangle r = {first_centre(x), first_centre(y), first_centre(x + (double)state->viewport.width),
                          first_centre(y + (double)state->viewport.height)};
    if (!GET(scissortestenable))
        return r;
    const struct scissor *s = &state->scissor;
    r.x0 = at_least((int32_t)s->x, r.x0);
    r.y0 = at_least((int32_t)s->y, r.y0);
    r.x1 = at_least(r.x0, at_most((int32_t)(s->x + s->width), r.x1));
    r.y1 = at_least(r.y0, at_most((int32_t)(s->y + s->height), r.y1));
    return r;
}
