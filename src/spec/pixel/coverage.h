/* The part of its pixel that a smooth primitive covers: the area of what the primitive and the pixel's
 * square have in common. It multiplies the colour's alpha, or with the key's coverage_color all channels,
 * after fog and before the alpha test (OpenGL ES 1.1, Antialiasing Application). Geometry is not moved
 * outward.
 *
 * A straight edge cuts off the part u of the square. With the distance d of the centre from the edge,
 * positive inside, along the axis of the window that is nearer to the edge's normal, and the tangent s
 * between the two:
 *
 *   t = max(0, (1 + s) / 2 - |d|),  g = min(t, s),  u = g^2 / (2 s) + (t - g), for d < 0 that is 1 - u
 *
 * A triangle of the square is cut off while t < s, a trapezoid after that. So u is the exact area.
 *
 * A triangle covers 1 - u0 - u1 - u2 + v01 + v12 + v20. The part v that two edges both cut off is exact if
 * they are parallel. It is u0 u1 if they are perpendicular, which is exact where the sides of a square are.
 * In between it is (1 - |c|) u0 u1 + max(c, 0) min(u0, u1) with the cosine c between the normals.
 *
 * A line covers max(0, 1 - u0 - u1) of the strip between its long sides, times the same of its short sides.
 *
 * A point covers the mean length that its circle has in the square on DISC_COLUMNS lines, times the breadth
 * of the range that circle and square share. The lines are along the axis on which the centre is farther
 * away. */
#ifndef SPEC_PIXEL_COVERAGE_H
#define SPEC_PIXEL_COVERAGE_H

#include "contract/language.h"
#include "spec/math/color.h"
#include "spec/math/vector.h"
#include "spec/pixel/interpolate.h"

enum { DISC_COLUMNS = 8 };

_Static_assert(offsetof(struct smooth_edge, dx) == offsetof(struct plane, dx) &&
                   offsetof(struct smooth_edge, dy) == offsetof(struct plane, dy) &&
                   offsetof(struct smooth_edge, value) == offsetof(struct plane, value),
               "an edge begins with a plane");

/* How an edge cuts squares (struct smooth_edge). */
struct cut {
    flt slope, reach, bend;
};

static inline struct cut load_cut(struct env *e, size_t slope, size_t reach, size_t bend)
{
    struct cut r;
    r.slope = uniform_f(E, BASE_TRIANGLE, RECORD_COVERAGE + (int)slope);
    r.reach = uniform_f(E, BASE_TRIANGLE, RECORD_COVERAGE + (int)reach);
    r.bend = uniform_f(E, BASE_TRIANGLE, RECORD_COVERAGE + (int)bend);
    return r;
}

/* The part of the square that is beyond the edge. */
static inline flt cut_off(struct env *e, flt distance, const struct cut *cut)
{
    flt away = magnitude(E, distance);
    flt left = sub_f(E, cut->reach, away);
    flt deep = max_f(E, left, lit_f(E, 0.0f));
    flt bent = min_f(E, deep, cut->slope);
    flt rest = sub_f(E, deep, bent);
    flt square = mul_f(E, bent, bent);
    flt less = mad_f(E, square, cut->bend, rest);
    flt more = sub_f(E, lit_f(E, 1.0f), less);
    msk outside = lt_f(E, distance, lit_f(E, 0.0f));
    return select_f(E, outside, more, less);
}

static inline flt cut_by_edge(struct env *e, const struct pixel_position *at, int i)
{
    size_t edge = offsetof(struct smooth_triangle, edge) + sizeof(struct smooth_edge) * (size_t)i;
    struct cut cut =
        load_cut(E, edge + offsetof(struct smooth_edge, slope), edge + offsetof(struct smooth_edge, reach),
                 edge + offsetof(struct smooth_edge, bend));
    flt distance = evaluate_plane(E, at, RECORD_COVERAGE + (int)edge);
    return cut_off(E, distance, &cut);
}

/* The part that edges i and i + 1 both cut off. */
static inline flt overlap(struct env *e, int i, flt first, flt second)
{
    int at = RECORD_COVERAGE +
             (int)(offsetof(struct smooth_triangle, overlap) + sizeof(struct smooth_overlap) * (size_t)i);
    flt product = mul_f(E, first, second);
    flt least = min_f(E, first, second);
    flt of_least = uniform_f(E, BASE_TRIANGLE, at + (int)offsetof(struct smooth_overlap, least));
    flt of_product = uniform_f(E, BASE_TRIANGLE, at + (int)offsetof(struct smooth_overlap, product));
    flt part = mul_f(E, least, of_least);
    return mad_f(E, product, of_product, part);
}

static inline flt limit_coverage(struct env *e, flt part)
{
    flt low = max_f(E, part, lit_f(E, 0.0f));
    return min_f(E, low, lit_f(E, 1.0f));
}

static inline flt triangle_coverage(struct env *e, const struct pixel_position *at)
{
    flt cut[3];
    flt part = lit_f(E, 1.0f);
    for (int i = 0; i < 3; i++) {
        cut[i] = cut_by_edge(E, at, i);
        part = sub_f(E, part, cut[i]);
    }
    for (int i = 0; i < 3; i++) {
        flt both = overlap(E, i, cut[i], cut[(i + 1) % 3]);
        part = add_f(E, part, both);
    }
    return limit_coverage(E, part);
}

/* The part of the square between two parallel edges, given the distances from them. */
static inline flt strip_coverage(struct env *e, flt first, flt second, const struct cut *cut)
{
    flt before = cut_off(E, first, cut);
    flt after = cut_off(E, second, cut);
    flt rest = sub_f(E, lit_f(E, 1.0f), before);
    flt part = sub_f(E, rest, after);
    return max_f(E, part, lit_f(E, 0.0f));
}

static inline flt line_field(struct env *e, size_t field)
{
    return uniform_f(E, BASE_TRIANGLE, RECORD_COVERAGE + (int)field);
}

static inline flt line_coverage(struct env *e, const struct pixel_position *at)
{
    struct cut cut = load_cut(E, offsetof(struct smooth_line, slope), offsetof(struct smooth_line, reach),
                              offsetof(struct smooth_line, bend));
    flt x = line_field(E, offsetof(struct smooth_line, x));
    flt y = line_field(E, offsetof(struct smooth_line, y));
    flt half = line_field(E, offsetof(struct smooth_line, half));
    flt length = line_field(E, offsetof(struct smooth_line, length));
    flt back = mul_f(E, at->x, y);
    flt minus = neg_f(E, back);
    flt across = mad_f(E, at->y, x, minus);
    flt down = mul_f(E, at->y, y);
    flt along = mad_f(E, at->x, x, down);
    flt left = add_f(E, half, across);
    flt right = sub_f(E, half, across);
    flt ahead = sub_f(E, length, along);
    flt sides = strip_coverage(E, left, right, &cut);
    flt ends = strip_coverage(E, along, ahead, &cut);
    return mul_f(E, sides, ends);
}

/* The circle's length within `low` to `high` on the line at a distance from its centre. */
static inline flt disc_column(struct env *e, flt square, flt distance, flt low, flt high)
{
    flt minus = neg_f(E, distance);
    flt chord = mad_f(E, minus, distance, square);
    flt positive = max_f(E, chord, lit_f(E, 0.0f));
    flt top = sqrt_f(E, positive);
    flt bottom = neg_f(E, top);
    flt from = max_f(E, low, bottom);
    flt to = min_f(E, high, top);
    flt length = sub_f(E, to, from);
    return max_f(E, length, lit_f(E, 0.0f));
}

static inline flt disc_field(struct env *e, size_t field)
{
    return uniform_f(E, BASE_TRIANGLE, RECORD_COVERAGE + (int)field);
}

static inline flt point_coverage(struct env *e, const struct pixel_position *at)
{
    flt radius = disc_field(E, offsetof(struct smooth_point, radius));
    flt square = disc_field(E, offsetof(struct smooth_point, square));
    flt minus = neg_f(E, radius);
    flt x = magnitude(E, at->x);
    flt y = magnitude(E, at->y);
    flt near = min_f(E, x, y);
    flt far = max_f(E, x, y);
    flt low = sub_f(E, far, lit_f(E, 0.5f));
    flt high = add_f(E, far, lit_f(E, 0.5f));
    flt left = sub_f(E, near, lit_f(E, 0.5f));
    flt right = add_f(E, near, lit_f(E, 0.5f));
    flt first = max_f(E, left, minus);
    flt last = min_f(E, right, radius);
    flt range = sub_f(E, last, first);
    flt column = mul_f(E, range, lit_f(E, 1.0f / DISC_COLUMNS));
    flt sum = lit_f(E, 0.0f);
    for (int i = 0; i < DISC_COLUMNS; i++) {
        flt distance = mad_f(E, column, lit_f(E, (float)i + 0.5f), first);
        flt length = disc_column(E, square, distance, low, high);
        sum = add_f(E, sum, length);
    }
    flt area = mul_f(E, sum, column);
    return limit_coverage(E, area);
}

/* The part of the pixel that the primitive covers, 0 to 1; the key has coverage. */
static inline flt pixel_coverage(struct env *e, const struct pixel_key *k, const struct pixel_position *at)
{
    if (k->coverage == COVERAGE_EDGES)
        return triangle_coverage(E, at);
    return k->coverage == COVERAGE_LINE ? line_coverage(E, at) : point_coverage(E, at);
}

/* The part as a byte in both halves, or in that of alpha with 255 in the other. */
static inline fix coverage_factor(struct env *e, const struct pixel_key *k, flt part)
{
    itg byte = quantize(E, part);
    if (k->coverage_color)
        return both_halves(E, byte);
    itg high = shl_i(E, byte, 16);
    itg both = or_i(E, high, lit_i(E, 255));
    return fix_of(E, both);
}

static inline struct color cover_color(struct env *e, const struct pixel_key *k, fix factor,
                                       struct color color)
{
    if (k->coverage_color)
        color.rb = modulate(E, color.rb, factor);
    color.ga = modulate(E, color.ga, factor);
    return color;
}

#endif
