/* Derivation, whole: the pixel key first, then what it needs of setup, then what both need of vertices. */
#include "base/minmax.h"
#include "render/derive/derive_part.h"
#include "contract/key_query.h"

#include <math.h>
#include <string.h>

_Static_assert((int)ATTRIBUTE_FORMAT_COUNT == (int)TRIPTYCH_FORMAT_COUNT,
               "formats agree with the public ones");
_Static_assert((int)ATTRIBUTE_COUNT == (int)TRIPTYCH_ATTRIBUTE_COUNT,
               "attributes agree with the public ones");
_Static_assert((int)LIGHT_COUNT == (int)TRIPTYCH_LIGHTS, "as many lights as the public ones");
_Static_assert((int)LIGHT_POINT == TRIPTYCH_LIGHT_POINT + 1, "light types follow the public ones");
_Static_assert((int)TARGET_SIZE_MAXIMUM == (int)TRIPTYCH_TARGET_MAXIMUM, "one limit of the target");

/* As pixel_writes_stencil, before the format is in the key. */
static bool key_changes_stencil(const struct pixel_key *key)
{
    bool changes = false;
    for (int i = 0; i < key->stencil; i++)
        changes |= key->stencil_fail[i] || key->stencil_depth_fail[i] || key->stencil_pass[i];
    return changes;
}

bool derive_effective(const struct pixel_key *key)
{
    return pixel_write_mask(key) || key->depth_write || key->count || key_changes_stencil(key);
}

void derive_keys(const struct state *state, enum primitive primitive, union key key[UNIT_COUNT])
{
    memset(key, 0, UNIT_COUNT * sizeof *key);
    derive_pixel(state, primitive, &key[UNIT_PIXEL].pixel);
    derive_setup(state, primitive, &key[UNIT_PIXEL].pixel, &key[UNIT_SETUP].setup);
    derive_vertex(state, &key[UNIT_PIXEL].pixel, &key[UNIT_SETUP].setup, &key[UNIT_VERTEX].vertex);
}

/* The first of `side` columns whose centre is at `edge` or after it; `side` if there is none. */
static int32_t first_centre(const struct state *state, double edge, uint32_t side)
{
    double centre = ceil(edge - pixel_centre(state));
    double inside = centre > 0 ? centre : 0;
    return (int32_t)(inside < (double)side ? inside : (double)side);
}

static struct rectangle viewport_centres(const struct state *state)
{
    const struct triptych_viewport *v = &state->viewport;
    double x = (double)v->x, y = (double)v->y;
    return (struct rectangle){first_centre(state, x, state->width), first_centre(state, y, state->height),
                              first_centre(state, x + (double)v->width, state->width),
                              first_centre(state, y + (double)v->height, state->height)};
}

static uint64_t min_u64(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

struct rectangle derive_area(const struct state *state, bool everywhere)
{
    const struct rectangle whole = {0, 0, (int32_t)state->width, (int32_t)state->height};
    struct rectangle r = everywhere ? whole : viewport_centres(state);
    if (!GET(state, scissortestenable))
        return r;
    const struct scissor *s = &state->scissor;
    r.x0 = max_i32((int32_t)min_u64(s->x, state->width), r.x0);
    r.y0 = max_i32((int32_t)min_u64(s->y, state->height), r.y0);
    r.x1 = max_i32(r.x0, (int32_t)min_u64((uint64_t)s->x + s->width, (uint64_t)r.x1));
    r.y1 = max_i32(r.y0, (int32_t)min_u64((uint64_t)s->y + s->height, (uint64_t)r.y1));
    return r;
}
