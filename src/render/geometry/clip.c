/* Sutherland and Hodgman's polygon clipping in homogeneous coordinates (Reentrant Polygon Clipping, 1974),
 * against the planes that some vertex of the triangle is outside of, in the order of enum clip_plane.
 *
 * No cracks: triangles that share an edge get bit-identical new vertices on it, although each clips its own
 * copy, in its own direction, against its own set of planes. The clipping of an edge depends only on its two
 * vertices:
 *   - A new vertex is interpolated from the inside vertex to the outside one, whatever the order of the walk.
 *   - A vertex is outside of a plane only if the edge that it was made on began with a vertex outside of it.
 *     Rounding may put it slightly outside of other planes, but another triangle on the edge might not test
 *     those.
 * There is one exception. Rounding may make a polygon concave, so that a plane finds more than one run of
 * vertices inside. Only the first run is kept; the rest is thinner than a rounding error. So one plane adds
 * at most one vertex.
 *
 * Precision: distances, weights and sums are in double, and results are rounded to float once for each plane.
 * Both weights are quotients of the distances, so neither cancels, and the sum is monotone in its operands: a
 * property of both ends (0 <= z, z <= w, CLIP_EYE_W <= w, being finite) is a property of the new vertex. Then
 * the coordinate that defines the plane is put exactly on the plane. A vertex may be outside by its clip
 * code, which is computed in float, and inside by its distance; so distances are limited to the side that the
 * code names.
 *
 * Flat values: the polygon begins with vertex 0 or, if that is cut off, with a new vertex. Proof by
 * induction over the planes: the first vertex written is vertex 0 of the plane's input, or comes from an
 * edge that enters. All new vertices get vertex 0's flat values, and hence so does the first vertex of
 * each triangle of the fan. */
#include "render/geometry/clip.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* The eye first: the others may then rely on w > 0. Other user planes follow the first. */
enum clip_plane { EYE, NEAR, FAR, GUARD_LEFT, GUARD_RIGHT, GUARD_BOTTOM, GUARD_TOP, USER };

static const uint32_t plane_bit[CLIP_PLANES] = {
    [EYE] = CLIP_EYE,
    [NEAR] = CLIP_NEAR,
    [FAR] = CLIP_FAR,
    [GUARD_LEFT] = CLIP_GUARD_LEFT,
    [GUARD_RIGHT] = CLIP_GUARD_RIGHT,
    [GUARD_BOTTOM] = CLIP_GUARD_BOTTOM,
    [GUARD_TOP] = CLIP_GUARD_TOP,
    [USER] = CLIP_USER,
    [USER + 1] = CLIP_USER << 1,
    [USER + 2] = CLIP_USER << 2,
    [USER + 3] = CLIP_USER << 3,
    [USER + 4] = CLIP_USER << 4,
    [USER + 5] = CLIP_USER << 5,
};

enum { NO_LANE = VERTEX_CAPACITY };

struct point {
    float slot[SLOT_COUNT]; /* position and smooth slots are valid */
    uint32_t code;          /* CLIP_NEEDED bits of the planes that are still to come */
    uint32_t lane;          /* in the batch, or NO_LANE if new */
    bool corner;            /* it is one of the triangle's, */
    bool drawn;             /* and drawn as a point */
    bool edge; /* the polygon's edge from here to the next point lies on one of those that are drawn */
};

struct polygon {
    struct point point[CLIP_VERTICES_MAXIMUM];
    int count;
};

struct clipper clipper_create(const struct job *job, const uint8_t varying[VARYING_COUNT], float *vertices,
                              uint32_t next)
{
    struct clipper r = {.vertices = vertices, .next = next, .points = 7, .edges = 7, .job = job};
    for (int v = 0; v < VARYING_COUNT; v++) {
        uint64_t slots = ((UINT64_C(1) << varying_components[v]) - 1) << varying_slot[v];
        if (varying[v] == INTERPOLATION_SMOOTH)
            r.smooth |= slots;
        else if (varying[v] == INTERPOLATION_FLAT)
            r.flat |= slots;
    }
    r.smooth |= 1 << SLOT_X | 1 << SLOT_Y | 1 << SLOT_Z | 1 << SLOT_W;
    return r;
}

static inline float *batch_word(const struct clipper *c, uint32_t slot, uint32_t lane)
{
    return c->vertices + slot * VERTEX_CAPACITY + lane;
}

static uint32_t needed_code(const struct clipper *c, uint32_t lane)
{
    uint32_t code;
    memcpy(&code, batch_word(c, SLOT_CODE, lane), sizeof code);
    return code & CLIP_NEEDED & ~c->ignored;
}

/* The factor of the guard band: in the window it is a number of pixels. */
static float guard_scale(const struct clipper *c, const float slot[SLOT_COUNT])
{
    return c->window ? 1 : slot[SLOT_W];
}

/* Positive inside, negative outside. In the window only the planes of the guard band are used. */
static double distance(const struct clipper *c, enum clip_plane plane, const struct point *p)
{
    double x = p->slot[SLOT_X], y = p->slot[SLOT_Y], z = p->slot[SLOT_Z], w = guard_scale(c, p->slot);
    if (plane >= USER) {
        const float *user = c->job->clip_plane[plane - USER];
        return (double)user[0] * x + (double)user[1] * y + (double)user[2] * z + (double)user[3] * w;
    }
    switch (plane) {
    case EYE: return w - CLIP_EYE_W;
    case NEAR: return z;
    case FAR: return w - z;
    case GUARD_LEFT: return x - c->job->guard_left * w;
    case GUARD_RIGHT: return c->job->guard_right * w - x;
    case GUARD_BOTTOM: return y - c->job->guard_bottom * w;
    case GUARD_TOP: return c->job->guard_top * w - y;
    default: __builtin_unreachable();
    }
}

/* The product may round to infinity where the coordinate itself is next to the largest float. */
static float guard_limit(float guard, float w)
{
    return fminf(fmaxf(guard * w, -FLT_MAX), FLT_MAX);
}

static void put_on_plane(const struct clipper *c, enum clip_plane plane, float slot[SLOT_COUNT])
{
    float w = guard_scale(c, slot);
    switch (plane) {
    case EYE: slot[SLOT_W] = CLIP_EYE_W; break;
    case NEAR: slot[SLOT_Z] = 0; break;
    case FAR: slot[SLOT_Z] = slot[SLOT_W]; break;
    case GUARD_LEFT: slot[SLOT_X] = guard_limit(c->job->guard_left, w); break;
    case GUARD_RIGHT: slot[SLOT_X] = guard_limit(c->job->guard_right, w); break;
    case GUARD_BOTTOM: slot[SLOT_Y] = guard_limit(c->job->guard_bottom, w); break;
    case GUARD_TOP: slot[SLOT_Y] = guard_limit(c->job->guard_top, w); break;
    default:; /* no coordinate is a user plane's own */
    }
}

/* The planes after `plane` that the edge crosses and that the point on it is outside of. */
static uint32_t remaining_code(const struct clipper *c, enum clip_plane plane, uint32_t edge_code,
                               const struct point *p)
{
    uint32_t code = 0;
    for (int i = plane + 1; i < CLIP_PLANES; i++)
        if ((edge_code & plane_bit[i]) && distance(c, i, p) < 0)
            code |= plane_bit[i];
    return code;
}

/* Divides the weights by w where the values of vertices are in the window: there the product of a varying
 * with 1/w is linear, not the varying. */
static void divide_weights(const struct point *in, const struct point *out, float reciprocal_w,
                           double *weight_in, double *weight_out)
{
    if (reciprocal_w == 0)
        return;
    *weight_in *= (double)in->slot[SLOT_W] / (double)reciprocal_w;
    *weight_out *= (double)out->slot[SLOT_W] / (double)reciprocal_w;
}

static struct point cross(const struct clipper *c, enum clip_plane plane, const struct point *in,
                          const struct point *out)
{
    double d_in = distance(c, plane, in);
    double d_out = distance(c, plane, out);
    d_in = d_in > 0 ? d_in : 0;
    d_out = d_out < 0 ? d_out : 0;
    double length = d_in - d_out;
    double weight_in = length > 0 ? -d_out / length : 1;
    double weight_out = length > 0 ? d_in / length : 0;
    struct point p = {.lane = NO_LANE};
    for (uint64_t slots = c->smooth; slots; slots &= slots - 1) {
        int s = __builtin_ctzll(slots);
        p.slot[s] = (float)(in->slot[s] * weight_in + out->slot[s] * weight_out);
        if (c->window && s == SLOT_W)
            divide_weights(in, out, p.slot[SLOT_W], &weight_in, &weight_out);
    }
    put_on_plane(c, plane, p.slot);
    p.code = remaining_code(c, plane, in->code | out->code, &p);
    return p;
}

/* Bit i: point i is inside. One run of points, going round: the first. */
static uint32_t inside_run(const struct polygon *p, enum clip_plane plane)
{
    uint32_t inside = 0;
    for (int i = 0; i < p->count; i++)
        if (!(p->point[i].code & plane_bit[plane]))
            inside |= 1u << i;
    uint32_t first = inside & ~(inside + (inside & -inside));
    if (!(inside & 1) || !(inside >> (p->count - 1) & 1))
        return first;
    uint32_t outside = ~inside & ((1u << p->count) - 1);
    uint32_t last = outside ? ~0u << (32 - __builtin_clz(outside)) : 0;
    return first | (inside & last);
}

static void cut(const struct clipper *c, enum clip_plane plane, const struct polygon *from,
                struct polygon *to)
{
    uint32_t inside = inside_run(from, plane);
    to->count = 0;
    for (int i = 0; i < from->count; i++) {
        int j = i + 1 < from->count ? i + 1 : 0;
        const struct point *p = &from->point[i];
        const struct point *q = &from->point[j];
        bool p_inside = inside >> i & 1;
        bool q_inside = inside >> j & 1;
        if (p_inside)
            to->point[to->count++] = *p;
        if (p_inside != q_inside) {
            struct point *new = &to->point[to->count++];
            *new = p_inside ? cross(c, plane, p, q) : cross(c, plane, q, p);
            new->edge = q_inside && p->edge;
        }
    }
}

static struct point load_point(const struct clipper *c, uint32_t lane)
{
    struct point p = {.code = needed_code(c, lane), .lane = lane, .corner = true};
    for (uint64_t slots = c->smooth; slots; slots &= slots - 1) {
        int s = __builtin_ctzll(slots);
        p.slot[s] = *batch_word(c, s, lane);
    }
    return p;
}

/* Whole turns that the point's wrapped slots are away from the first one's are taken back; a point that has
 * any needs a lane of its own. */
static void wrap_point(const struct clipper *c, const struct point *first, struct point *p)
{
    for (uint64_t slots = c->wrapped & c->smooth; slots; slots &= slots - 1) {
        int s = __builtin_ctzll(slots);
        float turns = rintf(p->slot[s] - first->slot[s]);
        if (turns == 0 || !isfinite(turns))
            continue;
        p->slot[s] -= turns;
        p->lane = NO_LANE;
    }
}

static uint32_t store_point(struct clipper *c, const struct point *p, uint32_t provoking)
{
    uint32_t lane = c->next++;
    for (uint64_t slots = c->smooth; slots; slots &= slots - 1) {
        int s = __builtin_ctzll(slots);
        *batch_word(c, s, lane) = p->slot[s];
    }
    for (uint64_t slots = c->flat; slots; slots &= slots - 1) {
        int s = __builtin_ctzll(slots);
        *batch_word(c, s, lane) = *batch_word(c, s, provoking);
    }
    memset(batch_word(c, SLOT_CODE, lane), 0, sizeof(uint32_t));
    return lane;
}

/* Gives the new points lanes. Returns 0, or -1 when there are too few. */
static int store_points(struct clipper *c, struct point *point, int count, uint32_t provoking)
{
    uint32_t lanes = 0;
    for (int i = 0; i < count; i++)
        lanes += point[i].lane == NO_LANE;
    if (lanes > VERTEX_CAPACITY - c->next)
        return -1;
    for (int i = 0; i < count; i++)
        if (point[i].lane == NO_LANE)
            point[i].lane = store_point(c, &point[i], provoking);
    return 0;
}

int clip_polygon(struct clipper *c, const uint32_t lane[3], struct clipped *clipped)
{
    struct polygon polygon[2];
    struct polygon *from = &polygon[0], *to = &polygon[1];
    for (int i = 0; i < 3; i++) {
        from->point[i] = load_point(c, lane[i]);
        from->point[i].drawn = c->points >> i & 1;
        from->point[i].edge = c->edges >> i & 1;
    }
    wrap_point(c, &from->point[0], &from->point[1]);
    wrap_point(c, &from->point[0], &from->point[2]);
    from->count = 3;
    uint32_t code = from->point[0].code | from->point[1].code | from->point[2].code;
    for (int plane = 0; plane < CLIP_PLANES && from->count; plane++) {
        if (!(code & plane_bit[plane]))
            continue;
        cut(c, plane, from, to);
        struct polygon *swap = from;
        from = to;
        to = swap;
    }
    *clipped = (struct clipped){.count = from->count < 3 ? 0 : from->count};
    for (int i = 0; i < clipped->count; i++) {
        clipped->corners |= (uint32_t)from->point[i].corner << i;
        clipped->points |= (uint32_t)from->point[i].drawn << i;
        clipped->edges |= (uint32_t)from->point[i].edge << i;
    }
    if (store_points(c, from->point, clipped->count, lane[0]))
        return -1;
    for (int i = 0; i < clipped->count; i++)
        clipped->lane[i] = from->point[i].lane;
    return 0;
}

int clip_triangle(struct clipper *c, const uint32_t lane[3], uint32_t triangle[CLIP_TRIANGLES_MAXIMUM][3])
{
    struct clipped clipped;
    if (clip_polygon(c, lane, &clipped))
        return -1;
    for (int i = 0; i < clipped.count - 2; i++) {
        triangle[i][0] = clipped.lane[0];
        triangle[i][1] = clipped.lane[i + 1];
        triangle[i][2] = clipped.lane[i + 2];
    }
    return clipped.count ? clipped.count - 2 : 0;
}

int clip_line(struct clipper *c, const uint32_t lane[2], uint32_t left[2])
{
    struct point end[2] = {load_point(c, lane[0]), load_point(c, lane[1])};
    wrap_point(c, &end[0], &end[1]);
    for (int plane = 0; plane < CLIP_PLANES; plane++) {
        bool outside[2] = {end[0].code & plane_bit[plane], end[1].code & plane_bit[plane]};
        if (outside[0] && outside[1])
            return 0;
        if (outside[0] || outside[1])
            end[outside[1]] = cross(c, plane, &end[outside[0]], &end[outside[1]]);
    }
    if (store_points(c, end, 2, lane[0]))
        return -1;
    left[0] = end[0].lane;
    left[1] = end[1].lane;
    return 1;
}
