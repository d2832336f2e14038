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
    struct pair_form form = {.depth = setup->depth != 0, .smooth = layout.smooth != 0};
    if (setup->primitive != PRIMITIVE_TRIANGLE || setup->facing || setup->smooth)
        return none;
    form.bytes = (uint16_t)(sizeof(struct triangle_head) +
                            (unsigned)(form.depth + form.smooth) * sizeof(struct plane));
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

static inline bool is_level(const struct plane *plane)
{
    return plane->dx == 0.0f && plane->dy == 0.0f;
}

/* All words but the planes of texture coordinates. */
static inline bool same_constants(const uint8_t *a, const uint8_t *b, const struct pair_form *form)
{
    unsigned at = sizeof(struct triangle_head);
    if (form->depth) {
        if (!is_level(plane_at(a, at)) || !is_level(plane_at(b, at)) ||
            !same_words(a, b, at, at + sizeof(float)))
            return false;
        at += sizeof(struct plane);
    }
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

/* The outermost centres of a rectangle, from the origins: those of the first record in the first two lanes,
 * those of the second in the others. All in pixels. */
struct centres {
    __m128 left, right, top, bottom;
    __m128 columns, rows; /* from left to right, from top to bottom */
    __m128 width, height; /* more than the rectangle's */
};

static inline __m128 for_both(float first, float second)
{
    return _mm_set_ps(second, second, first, first);
}

static inline void find_centres(const struct half *half, const struct triangle_head *first,
                                const struct triangle_head *second, struct centres *c)
{
    int32_t x0 = pixel_from(min_i32(half->x, half->free_x)), y0 = pixel_from(min_i32(half->y, half->free_y));
    int32_t columns = pixel_from(max_i32(half->x, half->free_x)) - x0;
    int32_t rows = pixel_from(max_i32(half->y, half->free_y)) - y0;
    float x = (float)x0 + 0.5f, y = (float)y0 + 0.5f;
    const __m128 more = _mm_set1_ps(2);
    c->columns = _mm_set1_ps((float)(columns - 1));
    c->rows = _mm_set1_ps((float)(rows - 1));
    c->left = for_both(x - first->origin_x, x - second->origin_x);
    c->top = for_both(y - first->origin_y, y - second->origin_y);
    c->right = _mm_add_ps(c->left, c->columns);
    c->bottom = _mm_add_ps(c->top, c->rows);
    c->width = _mm_add_ps(c->columns, more);
    c->height = _mm_add_ps(c->rows, more);
}

/* The planes of u and v of two records: lanes are u and v of the first, then of the second. */
struct planes {
    __m128 value, dx, dy;
};

static inline void load_planes(const struct plane *a, const struct plane *b, struct planes *p)
{
    /* value dx dy of u, value of v; dy of u, value dx dy of v */
    __m128 a_low = _mm_loadu_ps(&a->value), a_high = _mm_loadu_ps(&a->dy);
    __m128 b_low = _mm_loadu_ps(&b->value), b_high = _mm_loadu_ps(&b->dy);
    __m128 a_steps = _mm_shuffle_ps(a_low, a_high, _MM_SHUFFLE(3, 2, 2, 1));
    __m128 b_steps = _mm_shuffle_ps(b_low, b_high, _MM_SHUFFLE(3, 2, 2, 1));
    p->value = _mm_shuffle_ps(a_low, b_low, _MM_SHUFFLE(3, 0, 3, 0));
    p->dx = _mm_shuffle_ps(a_steps, b_steps, _MM_SHUFFLE(2, 0, 2, 0));
    p->dy = _mm_shuffle_ps(a_steps, b_steps, _MM_SHUFFLE(3, 1, 3, 1));
}

static inline __m128 evaluate(const struct planes *p, __m128 x, __m128 y, __m128 size)
{
    __m128 down = _mm_add_ps(p->value, _mm_mul_ps(y, p->dy));
    return _mm_mul_ps(_mm_add_ps(down, _mm_mul_ps(x, p->dx)), size);
}

/* The first record's integers nearest to v, for both records. */
static inline __m128 whole(__m128 v)
{
    return _mm_cvtepi32_ps(_mm_cvtps_epi32(_mm_shuffle_ps(v, v, _MM_SHUFFLE(1, 0, 1, 0))));
}

static inline __m128 magnitude(__m128 v)
{
    return _mm_andnot_ps(_mm_set1_ps(-0.0f), v);
}

static inline __m128 is_near(__m128 position, __m128 n)
{
    return _mm_cmple_ps(magnitude(_mm_sub_ps(position, n)), _mm_set1_ps(PAIR_STRAY));
}

static inline __m128 largest(__m128 a, __m128 b)
{
    return _mm_max_ps(magnitude(a), magnitude(b));
}

/* Returns true if all planes have the positions that the integers n have, at the four outermost centres. */
static inline bool agree(const struct planes *p, const struct centres *c, __m128 size)
{
    __m128 first = evaluate(p, c->left, c->top, size);
    __m128 nx = whole(_mm_mul_ps(p->dx, size)), ny = whole(_mm_mul_ps(p->dy, size));
    __m128 across = _mm_mul_ps(nx, c->columns), down = _mm_mul_ps(ny, c->rows);
    __m128 n0 = whole(first), n1 = _mm_add_ps(n0, across), n2 = _mm_add_ps(n0, down),
           n3 = _mm_add_ps(n1, down);
    __m128 upper = _mm_and_ps(is_near(first, n0), is_near(evaluate(p, c->right, c->top, size), n1));
    __m128 lower = _mm_and_ps(is_near(evaluate(p, c->left, c->bottom, size), n2),
                              is_near(evaluate(p, c->right, c->bottom, size), n3));
    __m128 reach = _mm_max_ps(largest(n0, n1), largest(n2, n3));
    __m128 small = _mm_and_ps(_mm_cmple_ps(reach, _mm_set1_ps(PAIR_REACH)),
                              _mm_cmple_ps(largest(nx, ny), _mm_set1_ps(PAIR_STEP)));
    return _mm_movemask_ps(_mm_and_ps(_mm_and_ps(upper, lower), small)) == 15;
}

/* The sizes of the texture in 1/256 texel, for both records. */
static inline __m128 texture_size(const struct job *job, unsigned sampler)
{
    const struct texture_job *texture = &job->texture[sampler];
    return _mm_set_ps(texture->height_256, texture->width_256, texture->height_256, texture->width_256);
}

/* Lanes where the step adds little over the whole rectangle. */
static inline __m128 is_residue(__m128 step, __m128 extent, __m128 size)
{
    return _mm_cmple_ps(magnitude(_mm_mul_ps(_mm_mul_ps(step, size), extent)), _mm_set1_ps(PAIR_RESIDUE));
}

/* Removes the steps of rounding from the first record's planes. */
static inline void straighten(struct plane *to, const struct planes *p, const struct centres *c, __m128 size)
{
    __m128 dx = _mm_andnot_ps(is_residue(p->dx, c->width, size), p->dx);
    __m128 dy = _mm_andnot_ps(is_residue(p->dy, c->height, size), p->dy);
    __m128 steps = _mm_unpacklo_ps(dx, dy);
    _mm_storel_pi((__m64 *)(void *)&to[0].dx, steps);
    _mm_storeh_pi((__m64 *)(void *)&to[1].dx, steps);
}

/* The largest of the sizes of textures that are sampled with the same coordinates as lookup i. */
static inline __m128 largest_size(const struct pair_form *form, const struct job *job, unsigned i)
{
    __m128 size = texture_size(job, form->lookup[i].sampler);
    for (unsigned j = 0; j < form->lookups; j++)
        if (j != i && form->lookup[j].offset == form->lookup[i].offset)
            size = _mm_max_ps(size, texture_size(job, form->lookup[j].sampler));
    return size;
}

/* Returns true if both records have the same positions at all centres; the first is then straightened. */
static bool join_lookups(uint8_t *a, const uint8_t *b, const struct pair_form *form, const struct job *job,
                         const struct centres *c)
{
    struct planes planes[PAIR_LOOKUPS];
    for (unsigned i = 0; i < form->lookups; i++) {
        unsigned offset = form->lookup[i].offset;
        load_planes(plane_at(a, offset), plane_at(b, offset), &planes[i]);
        if (!agree(&planes[i], c, texture_size(job, form->lookup[i].sampler)))
            return false;
    }
    for (unsigned i = 0; i < form->lookups; i++)
        straighten((struct plane *)(void *)(a + form->lookup[i].offset), &planes[i], c,
                   largest_size(form, job, i));
    return true;
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
        if (!join_lookups(first, second, form, job, &centres))
            return false;
    }
    make_rectangle(head, &a);
    return true;
}
