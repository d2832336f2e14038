#include "render/geometry/bin_pair.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "render/raster/raster_part.h"

#include <string.h>

enum { COORDINATE_BYTES = 2 * sizeof(struct plane) };

/* --- Forms --- */

/* Adds the samplers of a channel whose planes are at the offset. */
static bool add_samplers(struct pair_form *form, unsigned offset, unsigned samplers)
{
    for (; samplers; samplers &= samplers - 1) {
        if (form->lookups == PAIR_LOOKUPS)
            return false;
        form->lookup[form->lookups].offset = (uint16_t)offset;
        form->lookup[form->lookups++].sampler = (uint16_t)__builtin_ctz(samplers);
    }
    return true;
}

/* A varying's words after those that the form has. */
static bool add_varying(struct pair_form *form, const struct setup_key *setup, int v,
                        const uint16_t samplers[TEXTURE_STAGES])
{
    unsigned offset = form->bytes;
    bool smooth = setup->varying[v] == INTERPOLATION_SMOOTH;
    unsigned bytes = smooth ? sizeof(struct plane) : sizeof(float);
    form->bytes = (uint16_t)(form->bytes + bytes * varying_components[v]);
    if (!smooth)
        return true;
    unsigned found = varying_is_texcoord(v) ? samplers[(v - VARYING_texcoord0) / VARYING_CHANNEL]
                                            : 0; /* 0: of what else? */
    return found && add_samplers(form, offset, found);
}

struct pair_form bin_pair_form(const struct setup_key *setup, enum precision precision,
                               const uint16_t samplers[TEXTURE_STAGES])
{
    const struct pair_form none = {0};
    struct triangle_layout layout = layout_of_setup(setup);
    struct pair_form form = {.smooth = layout.smooth != 0};
    if (setup->primitive != PRIMITIVE_TRIANGLE || setup->facing || setup->smooth || setup->depth)
        return none;
    form.bytes = (uint16_t)(sizeof(struct triangle_head) + (form.smooth ? sizeof(struct plane) : 0));
    for (int v = 0; v < VARYING_COUNT; v++)
        if (setup->varying[v] != INTERPOLATION_NONE &&
            (layout.varying[v] != form.bytes || !add_varying(&form, setup, v, samplers)))
            return none;
    /* 1/w may be 1, and w another number. */
    return form.lookups && precision != PRECISION_EXACT ? none : form;
}

/* --- Halves of a rectangle --- */

/* A triangle with two sides along the axes: the corner between them, and the opposite one, without vertex. */
struct half {
    int32_t x, y, free_x, free_y;
};

/* Bit i: vertices i and i + 1 have the same coordinate. */
static inline unsigned equal_pairs(const int32_t position[3])
{
    __m128i v = _mm_loadu_si128((const __m128i *)(const void *)position); /* the fourth is not used */
    __m128i next = _mm_shuffle_epi32(v, _MM_SHUFFLE(3, 0, 2, 1));
    return (unsigned)_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(v, next))) & 7;
}

/* Returns false if no two vertices of the triangle, which has an area, share x, or none share y. */
static inline bool find_half(const struct triangle_head *head, struct half *half)
{
    static const uint8_t third[8] = {[1] = 2, [2] = 0, [4] = 1};
    unsigned same_x = equal_pairs(head->x), same_y = equal_pairs(head->y);
    if (!same_x || !same_y)
        return false;
    unsigned across = third[same_x], down = third[same_y]; /* the ends of the sides */
    *half = (struct half){head->x[down], head->y[across], head->x[across], head->y[down]};
    return true;
}

static inline bool are_halves(const struct half *a, const struct half *b)
{
    return a->x == b->free_x && a->y == b->free_y && a->free_x == b->x && a->free_y == b->y;
}

/* --- The same results --- */

static inline bool same_words(const uint8_t *a, const uint8_t *b, unsigned begin, unsigned end)
{
    uint32_t different = 0;
    for (unsigned at = begin; at < end; at += sizeof(uint32_t)) {
        uint32_t first, second;
        memcpy(&first, a + at, sizeof first);
        memcpy(&second, b + at, sizeof second);
        different |= first ^ second;
    }
    return !different;
}

static inline const struct plane *plane_at(const uint8_t *record, unsigned offset)
{
    return (const struct plane *)(const void *)(record + offset);
}

static inline bool is_one(const struct plane *plane)
{
    return plane->value == 1.0f && plane->dx == 0.0f && plane->dy == 0.0f;
}

/* All words but the planes of texture coordinates. */
static inline bool same_constants(const uint8_t *a, const uint8_t *b, const struct pair_form *form)
{
    unsigned at = sizeof(struct triangle_head);
    if (form->smooth) {
        if (!is_one(plane_at(a, at)) || !is_one(plane_at(b, at)))
            return false;
        at += sizeof(struct plane);
    }
    for (unsigned i = 0; i < form->lookups; i++)
        if (form->lookup[i].offset >= at) {
            if (!same_words(a, b, at, form->lookup[i].offset))
                return false;
            at = form->lookup[i].offset + COORDINATE_BYTES;
        }
    return same_words(a, b, at, form->bytes);
}

/* The four outermost centres of a rectangle: their distances from the first one, and from the origins of both
 * records, in pixels. */
struct centres {
    __m128 across, down;
    __m128 x[2], y[2];
    float width, height; /* more than the rectangle's */
};

static inline void find_centres(const struct half *half, const struct triangle_head *first,
                                const struct triangle_head *second, struct centres *c)
{
    int32_t x0 = pixel_from(min_i32(half->x, half->free_x)), y0 = pixel_from(min_i32(half->y, half->free_y));
    int32_t columns = pixel_from(max_i32(half->x, half->free_x)) - x0;
    int32_t rows = pixel_from(max_i32(half->y, half->free_y)) - y0;
    float right = (float)(columns - 1), below = (float)(rows - 1);
    float x = (float)x0 + 0.5f, y = (float)y0 + 0.5f;
    c->across = _mm_set_ps(right, 0, right, 0);
    c->down = _mm_set_ps(below, below, 0, 0);
    c->x[0] = _mm_add_ps(c->across, _mm_set1_ps(x - first->origin_x));
    c->y[0] = _mm_add_ps(c->down, _mm_set1_ps(y - first->origin_y));
    c->x[1] = _mm_add_ps(c->across, _mm_set1_ps(x - second->origin_x));
    c->y[1] = _mm_add_ps(c->down, _mm_set1_ps(y - second->origin_y));
    c->width = (float)(columns + 1);
    c->height = (float)(rows + 1);
}

static inline __m128 whole(__m128 v)
{
    return _mm_cvtepi32_ps(_mm_cvtps_epi32(v));
}

static inline __m128 magnitude(__m128 v)
{
    return _mm_andnot_ps(_mm_set1_ps(-0.0f), v);
}

static inline __m128 evaluate(const struct plane *plane, __m128 x, __m128 y, __m128 size)
{
    __m128 down = _mm_mul_ps(y, _mm_set1_ps(plane->dy)), across = _mm_mul_ps(x, _mm_set1_ps(plane->dx));
    return _mm_mul_ps(_mm_add_ps(_mm_add_ps(_mm_set1_ps(plane->value), down), across), size);
}

/* A mask of centres at which both planes have the position that the integers n have. */
static inline __m128 agree(const struct plane *a, const struct plane *b, const struct centres *c, float size)
{
    __m128 scale = _mm_set1_ps(size), stray = _mm_set1_ps(PAIR_STRAY);
    __m128 first = evaluate(a, c->x[0], c->y[0], scale), second = evaluate(b, c->x[1], c->y[1], scale);
    __m128 nx = whole(_mm_mul_ps(_mm_set1_ps(a->dx), scale));
    __m128 ny = whole(_mm_mul_ps(_mm_set1_ps(a->dy), scale));
    __m128 n0 = whole(first), start = _mm_shuffle_ps(n0, n0, 0);
    __m128 n = _mm_add_ps(start, _mm_add_ps(_mm_mul_ps(nx, c->across), _mm_mul_ps(ny, c->down)));
    __m128 close = _mm_and_ps(_mm_cmple_ps(magnitude(_mm_sub_ps(first, n)), stray),
                              _mm_cmple_ps(magnitude(_mm_sub_ps(second, n)), stray));
    __m128 steps = _mm_max_ps(magnitude(nx), magnitude(ny));
    __m128 small = _mm_and_ps(_mm_cmple_ps(magnitude(n), _mm_set1_ps(PAIR_REACH)),
                              _mm_cmple_ps(steps, _mm_set1_ps(PAIR_STEP)));
    return _mm_and_ps(close, small);
}

/* Returns true if both records have the same positions at all centres. */
static bool same_positions(const uint8_t *a, const uint8_t *b, const struct pair_form *form,
                           const struct job *job, const struct centres *c)
{
    __m128 all = _mm_castsi128_ps(_mm_set1_epi32(-1));
    for (unsigned i = 0; i < form->lookups; i++) {
        const struct texture_job *texture = &job->texture[form->lookup[i].sampler];
        const struct plane *first = plane_at(a, form->lookup[i].offset);
        const struct plane *second = plane_at(b, form->lookup[i].offset);
        all = _mm_and_ps(all, agree(first, second, c, texture->width_256));
        all = _mm_and_ps(all, agree(first + 1, second + 1, c, texture->height_256));
    }
    return _mm_movemask_ps(all) == 15;
}

static inline bool is_residue(float step, float extent, float size)
{
    float change = step * size * extent;
    return step != 0 && change <= PAIR_RESIDUE && change >= -PAIR_RESIDUE;
}

/* Removes the steps of rounding from a plane. */
static inline void straighten(struct plane *plane, const struct centres *c, float size)
{
    if (is_residue(plane->dx, c->width, size))
        plane->dx = 0;
    if (is_residue(plane->dy, c->height, size))
        plane->dy = 0;
}

/* The largest size of the textures decides, if there are several. */
static void straighten_lookups(uint8_t *record, const struct pair_form *form, const struct job *job,
                               const struct centres *c)
{
    for (unsigned i = 0; i < form->lookups; i++) {
        struct plane *plane = (struct plane *)(void *)(record + form->lookup[i].offset);
        float width = 0, height = 0;
        for (unsigned j = 0; j < form->lookups; j++)
            if (form->lookup[j].offset == form->lookup[i].offset) {
                const struct texture_job *texture = &job->texture[form->lookup[j].sampler];
                width = texture->width_256 > width ? texture->width_256 : width;
                height = texture->height_256 > height ? texture->height_256 : height;
            }
        straighten(plane, c, width);
        straighten(plane + 1, c, height);
    }
}

static void make_rectangle(struct triangle_head *head, const struct half *half)
{
    int32_t low_x = min_i32(half->x, half->free_x), high_x = max_i32(half->x, half->free_x);
    int32_t low_y = min_i32(half->y, half->free_y), high_y = max_i32(half->y, half->free_y);
    head->visible = HEAD_RECTANGLE;
    head->x[0] = head->x[2] = low_x;
    head->x[1] = high_x;
    head->y[0] = low_y;
    head->y[1] = head->y[2] = high_y;
}

bool bin_pair_join(uint8_t *first, const uint8_t *second, const struct pair_form *form, const struct job *job)
{
    struct triangle_head *head = (struct triangle_head *)(void *)first;
    const struct triangle_head *other = (const struct triangle_head *)(const void *)second;
    struct half a, b;
    if (!find_half(head, &a) || !find_half(other, &b) || !are_halves(&a, &b) ||
        !same_constants(first, second, form))
        return false;
    if (form->lookups) {
        struct centres centres;
        find_centres(&a, head, other, &centres);
        if (!same_positions(first, second, form, job, &centres))
            return false;
        straighten_lookups(first, form, job, &centres);
    }
    make_rectangle(head, &a);
    return true;
}
