#include "render/tile/hidden.h"
#include "contract/key_query.h"

#include "base/minmax.h"

#include <float.h>
#include <math.h>

enum { ALL_CHANNELS = 15 };

/* --- Traits --- */

static bool writes_all_channels(const struct pixel_key *key)
{
    for (int t = 0; t < TARGETS; t++)
        if (key->write_mask[t] && key->write_mask[t] != ALL_CHANNELS)
            return false;
    return pixel_write_mask(key);
}

/* Returns true if the written colour depends on the stored one. */
static bool blends(const struct pixel_key *key)
{
    return key->blend[BLEND_COLOR] != BLEND_COPY || key->blend[BLEND_ALPHA] != BLEND_COPY || key->logic ||
           pixel_blends_by_primitive(key);
}

static bool varies(const struct pixel_key *key)
{
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] == INTERPOLATION_SMOOTH)
            return true;
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        if (key->texture[i])
            return true;
    return key->fog || key->dither || key->clip_mask || key->coverage || key_program(key->shader);
}

unsigned hidden_traits(const struct pixel_key *key)
{
    unsigned traits = 0;
    bool single = !key->samples, stencil = pixel_stencil(key) != STENCIL_OFF;
    bool overwrites =
        single && writes_all_channels(key) && !blends(key) && !pixel_waits(key) && !stencil && !key->depth_w;
    if (overwrites)
        traits |= PIXEL_OVERWRITES;
    if (overwrites && key->depth_function == COMPARE_ALWAYS)
        traits |= PIXEL_OVERWRITES_ALL;
    if (!pixel_leaves_traces(key))
        traits |= PIXEL_COLORS_ONLY;
    if (overwrites && !key->count && !varies(key))
        traits |= PIXEL_UNIFORM;
    if (single && pixel_tests_depth(key) && !stencil && !key->depth_w && !key->depth_output)
        traits |= PIXEL_DEPTH_KNOWN;
    if (key->depth_write)
        traits |= PIXEL_WRITES_DEPTH;
    if (single && pixel_shades(key) && !key->span && varies(key))
        traits |= PIXEL_SPANS;
    return traits;
}

bool hidden_writes_all_targets(const struct pixel_key *key, const struct target *target)
{
    for (int t = 0; t < TARGETS; t++)
        if (target->colors[t].attachment && !key->write_mask[t])
            return false;
    return true;
}

/* --- Depths --- */

/* As spec/pixel/depth.h clamps: NaN is 0, and the pipeline has neither denormals nor -0. */
static float clamped(double depth)
{
    if (!(depth >= (double)FLT_MIN))
        return 0;
    return depth < 1 ? (float)depth : 1;
}

/* The distances from the plane's origin of the first and the last centre of an axis. */
struct extent {
    double first, last;
};

static struct extent span(int32_t first, int32_t end, float origin)
{
    return (struct extent){first + 0.5 - (double)origin, end - 0.5 - (double)origin};
}

static struct extent scaled(struct extent s, float by)
{
    double a = s.first * (double)by, b = s.last * (double)by;
    return a < b ? (struct extent){a, b} : (struct extent){b, a};
}

static double magnitude(struct extent s)
{
    return fmax(fabs(s.first), fabs(s.last));
}

bool hidden_is_level(const struct plane *plane)
{
    return plane->dx == 0 && plane->dy == 0 && fabsf(plane->value) < INFINITY;
}

struct depth_range hidden_level_depths(const struct plane *plane, enum triptych_depth_format format)
{
    uint32_t word = depth_encode(format, clamped((double)plane->value));
    return (struct depth_range){word, word};
}

/* The plane is evaluated with two roundings of binary32; `slack` is eight times what they can make of it. */
struct depth_range hidden_depths(const struct triangle_head *head, const struct plane *plane,
                                 const struct rectangle *area, enum triptych_depth_format format)
{
    struct extent x = scaled(span(area->x0, area->x1, head->origin_x), plane->dx);
    struct extent y = scaled(span(area->y0, area->y1, head->origin_y), plane->dy);
    double value = (double)plane->value, sum = fabs(value) + magnitude(x) + magnitude(y);
    if (!(sum < INFINITY))
        return (struct depth_range){0, depth_mask(format)};
    double slack = sum * 0x1p-21 + 0x1p-100;
    float least = clamped(value + x.first + y.first - slack);
    float most = clamped(value + x.last + y.last + slack);
    return (struct depth_range){depth_encode(format, least), depth_encode(format, most)};
}

enum depth_verdict hidden_verdict(int function, struct depth_range new, struct depth_range stored)
{
    bool below = new.most < stored.least, not_above = new.most <= stored.least;
    bool above = new.least > stored.most, not_below = new.least >= stored.most;
    bool passes, fails;
    switch (function) {
    case COMPARE_NEVER: return DEPTH_FAILS;
    case COMPARE_LESS: passes = below, fails = not_below; break;
    case COMPARE_EQUAL: passes = not_above && not_below, fails = below || above; break;
    case COMPARE_LESS_EQUAL: passes = not_above, fails = above; break;
    case COMPARE_GREATER: passes = above, fails = not_above; break;
    case COMPARE_NOT_EQUAL: passes = below || above, fails = not_above && not_below; break;
    case COMPARE_GREATER_EQUAL: passes = not_below, fails = below; break;
    default: return DEPTH_PASSES;
    }
    return passes ? DEPTH_PASSES : fails ? DEPTH_FAILS : DEPTH_UNDECIDED;
}

/* Tests that pass what is below leave nothing greater than was there, and the other way around. */
static bool only_lowers(int function)
{
    return function == COMPARE_LESS || function == COMPARE_LESS_EQUAL || function == COMPARE_EQUAL;
}

static bool only_raises(int function)
{
    return function == COMPARE_GREATER || function == COMPARE_GREATER_EQUAL || function == COMPARE_EQUAL;
}

struct depth_range hidden_widened(int function, struct depth_range stored, struct depth_range new)
{
    if (!only_raises(function))
        stored.least = min_u32(stored.least, new.least);
    if (!only_lowers(function))
        stored.most = max_u32(stored.most, new.most);
    return stored;
}

/* After a test that passes lesser values, depth is at most the lesser of the two. */
struct depth_range hidden_narrowed(int function, struct depth_range stored, struct depth_range new)
{
    switch (function) {
    case COMPARE_LESS:
    case COMPARE_LESS_EQUAL:
        return (struct depth_range){min_u32(stored.least, new.least), min_u32(stored.most, new.most)};
    case COMPARE_GREATER:
    case COMPARE_GREATER_EQUAL:
        return (struct depth_range){max_u32(stored.least, new.least), max_u32(stored.most, new.most)};
    case COMPARE_ALWAYS: return new;
    default: return hidden_widened(function, stored, new);
    }
}
