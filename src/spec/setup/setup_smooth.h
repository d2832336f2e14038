/* The values from which the coverage of smooth primitives is computed (contract/layout.h,
 * spec/pixel/coverage.h).
 *
 * A triangle: of each edge from vertex p to vertex q, with a = p.y - q.y, b = q.x - p.x and the larger
 * magnitude m, the plane (a, b) / m, which is a distance along one axis of the window. It is 0 at vertex 0
 * for the edges there, and twice the triangle's area / m for the third. An edge that is not smooth has a
 * plane that is 1. Two edges with the cosine c between their normals have the overlap product 1 - |c| and
 * least max(c, 0).
 *
 * A line: the rectangle around it whose sides are parallel to it and perpendicular to it, of the width that
 * the draw has. It begins and ends at the line's vertices. */
#ifndef SPEC_SETUP_SETUP_SMOOTH_H
#define SPEC_SETUP_SETUP_SMOOTH_H

#include "contract/language.h"
#include "spec/math/vector.h"
#include "spec/setup/setup_plane.h"

/* Places of fields in records. */
#define SMOOTH_EDGE(i, field)                                                                                \
    (RECORD_COVERAGE + offsetof(struct smooth_triangle, edge) + sizeof(struct smooth_edge) * (size_t)(i) +   \
     offsetof(struct smooth_edge, field))
#define SMOOTH_OVERLAP(i, field)                                                                             \
    (RECORD_COVERAGE + offsetof(struct smooth_triangle, overlap) +                                           \
     sizeof(struct smooth_overlap) * (size_t)(i) + offsetof(struct smooth_overlap, field))
#define SMOOTH_LINE(field)  (RECORD_COVERAGE + offsetof(struct smooth_line, field))
#define SMOOTH_POINT(field) (RECORD_COVERAGE + offsetof(struct smooth_point, field))

/* A vector of the window divided by its larger component, and that component's magnitude. */
struct direction {
    flt x, y, most;
    flt slope; /* the smaller magnitude over the larger one */
};

/* No vector but 0 is shorter than 1/256 pixel. */
static inline struct direction direction_of(struct env *e, flt x, flt y)
{
    struct direction r;
    flt wide = magnitude(E, x);
    flt high = magnitude(E, y);
    flt larger = max_f(E, wide, high);
    flt smaller = min_f(E, wide, high);
    r.most = max_f(E, larger, lit_f(E, 1.0f / (1 << SUBPIXEL_BITS)));
    r.x = div_f(E, x, r.most);
    r.y = div_f(E, y, r.most);
    r.slope = div_f(E, smaller, r.most);
    return r;
}

/* 1 / (2 slope); of a slope of 0 it is finite, and not used. */
static inline flt direction_bend(struct env *e, const struct direction *d)
{
    flt least = max_f(E, d->slope, lit_f(E, 0x1p-24f));
    return div_f(E, lit_f(E, 0.5f), least);
}

static inline flt direction_reach(struct env *e, const struct direction *d)
{
    return mad_f(E, d->slope, lit_f(E, 0.5f), lit_f(E, 0.5f));
}

/* The length of the vector in units of its larger component. */
static inline flt direction_length(struct env *e, const struct direction *d)
{
    flt square = mad_f(E, d->slope, d->slope, lit_f(E, 1.0f));
    return sqrt_f(E, square);
}

/* Edge i of the record, whose distance at vertex 0 is `start` over the normal's larger component. */
static inline void record_edge(struct env *e, const struct triangle_layout *layout, int i,
                               const struct direction *normal, flt start, itg edges)
{
    itg bit = and_i(E, edges, lit_i(E, 1 << i));
    msk off = eq_i(E, bit, lit_i(E, 0));
    flt distance = div_f(E, start, normal->most);
    flt value = select_f(E, off, lit_f(E, 1.0f), distance);
    flt dx = select_f(E, off, lit_f(E, 0.0f), normal->x);
    flt dy = select_f(E, off, lit_f(E, 0.0f), normal->y);
    flt reach = direction_reach(E, normal);
    flt bend = direction_bend(E, normal);
    record_f(E, layout, SMOOTH_EDGE(i, value), value);
    record_f(E, layout, SMOOTH_EDGE(i, dx), dx);
    record_f(E, layout, SMOOTH_EDGE(i, dy), dy);
    record_f(E, layout, SMOOTH_EDGE(i, slope), normal->slope);
    record_f(E, layout, SMOOTH_EDGE(i, reach), reach);
    record_f(E, layout, SMOOTH_EDGE(i, bend), bend);
}

static inline void record_overlap(struct env *e, const struct triangle_layout *layout, int i,
                                  const struct direction *first, const struct direction *second)
{
    flt y = mul_f(E, first->y, second->y);
    flt product = mad_f(E, first->x, second->x, y);
    flt first_length = direction_length(E, first);
    flt second_length = direction_length(E, second);
    flt lengths = mul_f(E, first_length, second_length);
    flt cosine = div_f(E, product, lengths);
    flt size = magnitude(E, cosine);
    flt rest = sub_f(E, lit_f(E, 1.0f), size);
    flt least = max_f(E, cosine, lit_f(E, 0.0f));
    record_f(E, layout, SMOOTH_OVERLAP(i, product), rest);
    record_f(E, layout, SMOOTH_OVERLAP(i, least), least);
}

/* The draw's bits in the head's order: with vertices 1 and 2 exchanged, so are edges 0 and 2. */
static inline itg head_edges(struct env *e, msk turned)
{
    itg edges = load_i(E, BASE_INPUT, 3 * SETUP_INDEX_BYTES);
    itg first = and_i(E, edges, lit_i(E, 1));
    itg last = ushr_i(E, edges, 2);
    itg low = and_i(E, last, lit_i(E, 1));
    itg middle = and_i(E, edges, lit_i(E, 2));
    itg high = shl_i(E, first, 2);
    itg two = or_i(E, low, middle);
    itg exchanged = or_i(E, two, high);
    return select_i(E, turned, exchanged, edges);
}

static inline void record_smooth_triangle(struct env *e, const struct triangle_layout *layout,
                                          const struct corner p[3], flt area)
{
    msk turned = lt_f(E, area, lit_f(E, 0.0f));
    itg edges = head_edges(E, turned);
    flt x[3], y[3];
    x[0] = p[0].x;
    y[0] = p[0].y;
    x[1] = select_f(E, turned, p[2].x, p[1].x);
    y[1] = select_f(E, turned, p[2].y, p[1].y);
    x[2] = select_f(E, turned, p[1].x, p[2].x);
    y[2] = select_f(E, turned, p[1].y, p[2].y);
    flt inside = magnitude(E, area);
    struct direction normal[3];
    record_i(E, layout, RECORD_COVERAGE + offsetof(struct smooth_triangle, edges), edges);
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        flt a = sub_f(E, y[i], y[next]);
        flt b = sub_f(E, x[next], x[i]);
        normal[i] = direction_of(E, a, b);
        record_edge(E, layout, i, &normal[i], i == 1 ? inside : lit_f(E, 0.0f), edges);
    }
    for (int i = 0; i < 3; i++)
        record_overlap(E, layout, i, &normal[i], &normal[(i + 1) % 3]);
}

/* `width` in 1/256 pixel. */
static inline void record_smooth_line(struct env *e, const struct triangle_layout *layout, flt dx, flt dy,
                                      itg width)
{
    struct direction along = direction_of(E, dx, dy);
    flt pixels = window_pixels(E, width);
    flt across = direction_length(E, &along);
    flt whole = mul_f(E, pixels, across);
    flt half = mul_f(E, whole, lit_f(E, 0.5f));
    flt down = mul_f(E, along.y, dy);
    flt length = mad_f(E, along.x, dx, down);
    flt reach = direction_reach(E, &along);
    flt bend = direction_bend(E, &along);
    record_f(E, layout, SMOOTH_LINE(x), along.x);
    record_f(E, layout, SMOOTH_LINE(y), along.y);
    record_f(E, layout, SMOOTH_LINE(half), half);
    record_f(E, layout, SMOOTH_LINE(length), length);
    record_f(E, layout, SMOOTH_LINE(slope), along.slope);
    record_f(E, layout, SMOOTH_LINE(reach), reach);
    record_f(E, layout, SMOOTH_LINE(bend), bend);
}

/* `reach`: the radius in 1/256 pixel. */
static inline void record_smooth_point(struct env *e, const struct triangle_layout *layout, itg reach)
{
    flt radius = window_pixels(E, reach);
    flt square = mul_f(E, radius, radius);
    record_f(E, layout, SMOOTH_POINT(radius), radius);
    record_f(E, layout, SMOOTH_POINT(square), square);
}

#endif
