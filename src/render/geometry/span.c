#include "render/geometry/span.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "render/raster/raster_part.h"

#include <math.h>

enum { SIGN = INT32_MIN, LEAST = (127 - 90) << 23, INFINITE = 255 << 23 };

static void add_plane(struct span_class *class, unsigned offset, enum axes axes, bool is_one)
{
    class->plane[class->count].offset = (uint16_t)offset;
    class->plane[class->count].axes = (uint8_t)axes;
    class->plane[class->count++].is_one = is_one;
}

/* The components of a varying: planes, or flat numbers, which are tested only if they have to be 1. */
static void add_varying(struct span_class *class, const struct triangle_layout *layout, enum span span, int v,
                        enum interpolation interpolation)
{
    const bool is_flat = interpolation == INTERPOLATION_FLAT, is_one = span_has_ones(span, v);
    const unsigned stride = is_flat ? sizeof(float) : sizeof(struct plane);
    for (int c = 0; c < varying_components[v] && (!is_flat || is_one); c++) {
        class->plane[class->count].is_flat = is_flat;
        add_plane(class, layout->varying[v] + stride * (unsigned)c, varying_span_axes(span, v, c), is_one);
    }
}

enum span span_narrowest(const struct pixel_key *key)
{
    return key->varying[VARYING_diffuse] ? SPAN_WHITE : SPAN_LEVEL;
}

enum span span_widest(const struct pixel_key *key)
{
    return key->varying[VARYING_diffuse] == INTERPOLATION_SMOOTH ? SPAN_FADE : SPAN_LEVEL;
}

struct span_class span_class(const struct pixel_key *key, enum span span)
{
    struct span_class class = {0};
    struct triangle_layout layout = layout_of_pixel(key);
    if (layout.smooth)
        add_plane(&class, layout.reciprocal_w, AXES_NONE, span_has_unit_w(span));
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v])
            add_varying(&class, &layout, span, v, (enum interpolation)key->varying[v]);
    return class;
}

/* 0 or finite from 2^-90 on in magnitude. */
static bool is_tame(float number)
{
    uint32_t magnitude = bits_of_float(number) & ~(uint32_t)SIGN;
    return !magnitude || (magnitude >= LEAST && magnitude < INFINITE);
}

static bool is_minus_zero(float number)
{
    return bits_of_float(number) == (uint32_t)SIGN;
}

static bool is_zero(float number)
{
    return !(bits_of_float(number) & ~(uint32_t)SIGN);
}

/* The outermost centres of a record's bounds along an axis, from its origin. */
struct extent {
    double first, last;
};

static struct extent extent_of(const int32_t corner[3], float origin)
{
    int32_t low = min_i32(min_i32(corner[0], corner[1]), corner[2]);
    int32_t high = max_i32(max_i32(corner[0], corner[1]), corner[2]);
    return (struct extent){pixel_from(low) + 0.5 - (double)origin, pixel_from(high) - 0.5 - (double)origin};
}

static bool is_within(double color)
{
    return color >= -SPAN_STRAY && color <= 1 + SPAN_STRAY;
}

/* A row of the bounds, where the plane has the value `start` at the origin's column. */
static bool row_is_within(double start, const struct plane *plane, const struct extent *x)
{
    return fabs(start) <= 2 && is_within(start + x->first * (double)plane->dx) &&
           is_within(start + x->last * (double)plane->dx);
}

static bool is_color(const struct plane *plane, const struct triangle_head *head)
{
    struct extent x = extent_of(head->x, head->origin_x), y = extent_of(head->y, head->origin_y);
    double value = (double)plane->value, dy = (double)plane->dy;
    return fabs(value) <= 2 && row_is_within(value + y.first * dy, plane, &x) &&
           row_is_within(value + y.last * dy, plane, &x);
}

static bool includes(const struct plane *plane, unsigned axes)
{
    return (axes & AXES_X ? is_tame(plane->dx) : is_zero(plane->dx)) &&
           (axes & AXES_Y ? is_tame(plane->dy) : is_zero(plane->dy)) && is_tame(plane->value) &&
           !is_minus_zero(plane->value);
}

bool span_includes(const struct span_class *class, const uint8_t *record)
{
    const struct triangle_head *head = (const struct triangle_head *)(const void *)record;
    for (unsigned i = 0; i < class->count; i++) {
        const struct plane *plane = (const struct plane *)(const void *)(record + class->plane[i].offset);
        if (class->plane[i].is_one && plane->value != 1.0f)
            return false;
        if (class->plane[i].is_flat)
            continue;
        if (class->plane[i].axes == AXES_BOTH ? !is_color(plane, head)
                                              : !includes(plane, class->plane[i].axes))
            return false;
    }
    return true;
}
