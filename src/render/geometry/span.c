#include "render/geometry/span.h"

#include "base/bits.h"

enum { SIGN = INT32_MIN, LEAST = (127 - 90) << 23, INFINITE = 255 << 23 };

static void add_plane(struct span_class *class, unsigned offset, enum axes axes)
{
    class->plane[class->count].offset = (uint16_t)offset;
    class->plane[class->count++].axes = (uint8_t)axes;
}

struct span_class span_class(const struct pixel_key *key)
{
    struct span_class class = {0};
    struct triangle_layout layout = layout_of_pixel(key);
    if (layout.smooth)
        add_plane(&class, layout.reciprocal_w, AXES_NONE);
    for (int v = 0; v < VARYING_COUNT; v++)
        for (int c = 0; c < varying_components[v] && key->varying[v] == INTERPOLATION_SMOOTH; c++)
            add_plane(&class, layout.varying[v] + (unsigned)sizeof(struct plane) * (unsigned)c,
                      varying_span_axes(v, c));
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

static bool includes(const struct plane *plane, unsigned axes)
{
    return (axes & AXES_X ? is_tame(plane->dx) : is_zero(plane->dx)) &&
           (axes & AXES_Y ? is_tame(plane->dy) : is_zero(plane->dy)) && is_tame(plane->value) &&
           !is_minus_zero(plane->value);
}

bool span_includes(const struct span_class *class, const uint8_t *record)
{
    for (unsigned i = 0; i < class->count; i++)
        if (!includes((const struct plane *)(const void *)(record + class->plane[i].offset),
                      class->plane[i].axes))
            return false;
    return true;
}
