#include "render/geometry/bin_pair.h"

#include "base/bits.h"
#include "base/minmax.h"
#include "machine/cpu.h"
#include "render/raster/raster_part.h"

#include <immintrin.h>
#include <string.h>

#define WALK __attribute__((target("avx2,fma")))

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
    if (!smooth && v == VARYING_diffuse)
        form->diffuse = (uint16_t)offset;
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

/* The first record's planes without the steps of rounding: {dx, dy} of u, then of v. */
static inline __m128 straight_steps(const struct planes *p, const struct centres *c, __m128 size)
{
    __m128 dx = _mm_andnot_ps(is_residue(p->dx, c->width, size), p->dx);
    __m128 dy = _mm_andnot_ps(is_residue(p->dy, c->height, size), p->dy);
    return _mm_unpacklo_ps(dx, dy);
}

static inline void set_steps(struct plane *to, __m128 steps)
{
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

/* --- Positions, pixel by pixel --- */

/* Positions along a row or a column of pixels: of number i, side * across + ((start + i) * along + base). */
struct course {
    float base, along, start, across, side;
};

/* A coordinate's planes, and where the rectangle's outermost centres are from each one's origin. */
struct walk {
    struct plane plane[2], joined;
    float left[2], right[2], top[2], bottom[2];
    int columns, rows;
};

/* 0, or neither small nor large: no term of a position is a denormal or infinite. */
static bool is_moderate(float word)
{
    return word == 0 || (word >= PAIR_LEAST && word <= PAIR_MOST) ||
           (word <= -PAIR_LEAST && word >= -PAIR_MOST);
}

static bool are_moderate(const struct plane *plane)
{
    return is_moderate(plane->value) && is_moderate(plane->dx) && is_moderate(plane->dy);
}

/* The course of plane r's pixels along x, in the row at a distance y from the origin; and along y. */
WALK static struct course along_row(const struct walk *w, const struct plane *plane, int r, float y)
{
    return (struct course){__builtin_fmaf(y, plane->dy, plane->value), plane->dx, w->left[r], 0, 0};
}

static struct course along_column(const struct walk *w, const struct plane *plane, int r, float x)
{
    return (struct course){plane->value, plane->dy, w->top[r], plane->dx, x};
}

WALK static inline __m256i positions(const struct course *c, __m256 number, __m256 size)
{
    __m256 at = _mm256_add_ps(_mm256_set1_ps(c->start), number);
    __m256 v = _mm256_fmadd_ps(at, _mm256_set1_ps(c->along), _mm256_set1_ps(c->base));
    v = _mm256_fmadd_ps(_mm256_set1_ps(c->side), _mm256_set1_ps(c->across), v);
    return _mm256_cvtps_epi32(_mm256_mul_ps(v, size));
}

/* Returns true if `count` pixels of all courses have the positions of the first. */
WALK static bool courses_agree(const struct course *course, unsigned courses, int count, float size)
{
    const __m256 last = _mm256_set1_ps((float)(count - 1)), sizes = _mm256_set1_ps(size);
    __m256 number = _mm256_setr_ps(0, 1, 2, 3, 4, 5, 6, 7);
    for (int i = 0; i < count; i += 8, number = _mm256_add_ps(number, _mm256_set1_ps(8))) {
        const __m256 here = _mm256_min_ps(number, last);
        const __m256i wanted = positions(course, here, sizes);
        __m256i same = _mm256_set1_epi32(-1);
        for (unsigned c = 1; c < courses; c++)
            same = _mm256_and_si256(same, _mm256_cmpeq_epi32(wanted, positions(course + c, here, sizes)));
        if (_mm256_movemask_epi8(same) != -1)
            return false;
    }
    return true;
}

/* Returns true if the two records have the positions of the joined one at each centre. */
static bool walk_agrees(const struct walk *w, float size)
{
    const bool down = w->joined.dx == 0 && w->joined.dy != 0;
    struct course course[5];
    unsigned courses = 1;
    if ((w->joined.dx != 0 && w->joined.dy != 0) || !are_moderate(&w->plane[0]) ||
        !are_moderate(&w->plane[1]))
        return false;
    course[0] = down ? along_column(w, &w->joined, 0, 0) : along_row(w, &w->joined, 0, 0);
    for (int r = 0; r < 2; r++) {
        const struct plane *plane = &w->plane[r];
        course[courses++] = down ? along_column(w, plane, r, w->left[r]) : along_row(w, plane, r, w->top[r]);
        if ((down ? plane->dx : plane->dy) != 0)
            course[courses++] =
                down ? along_column(w, plane, r, w->right[r]) : along_row(w, plane, r, w->bottom[r]);
    }
    return courses_agree(course, courses, down ? w->rows : w->columns, size);
}

/* Lanes 0 and 2, or 1 and 3, of u's or v's. */
static inline void split(__m128 lanes, int axis, float to[2])
{
    float all[4];
    _mm_storeu_ps(all, lanes);
    to[0] = all[axis], to[1] = all[axis + 2];
}

/* The same as agree(), for any steps. */
static bool agree_everywhere(const struct planes *p, const struct centres *c, __m128 size, __m128 steps)
{
    struct walk w = {.columns = 1 + (int)_mm_cvtss_f32(c->columns), .rows = 1 + (int)_mm_cvtss_f32(c->rows)};
    float value[2], dx[2], dy[2], sizes[2], step[4];
    if (!cpu_has_avx2_fma() || w.columns > PAIR_WALK || w.rows > PAIR_WALK)
        return false;
    split(c->left, 0, w.left), split(c->right, 0, w.right);
    split(c->top, 0, w.top), split(c->bottom, 0, w.bottom);
    _mm_storeu_ps(step, steps);
    for (int axis = 0; axis < 2; axis++) {
        split(p->value, axis, value), split(p->dx, axis, dx), split(p->dy, axis, dy);
        split(size, axis, sizes);
        for (int r = 0; r < 2; r++)
            w.plane[r] = (struct plane){value[r], dx[r], dy[r]};
        w.joined = (struct plane){value[0], step[2 * axis], step[2 * axis + 1]};
        if (!walk_agrees(&w, sizes[0]))
            return false;
    }
    return true;
}

/* Returns true if both records have the same positions at all centres; the first is then straightened. */
static bool join_lookups(uint8_t *a, const uint8_t *b, const struct pair_form *form, const struct job *job,
                         const struct centres *c)
{
    __m128 steps[PAIR_LOOKUPS];
    for (unsigned i = 0; i < form->lookups; i++) {
        unsigned offset = form->lookup[i].offset;
        __m128 size = texture_size(job, form->lookup[i].sampler);
        struct planes planes;
        load_planes(plane_at(a, offset), plane_at(b, offset), &planes);
        steps[i] = straight_steps(&planes, c, largest_size(form, job, i));
        if (!agree(&planes, c, size) && !agree_everywhere(&planes, c, size, steps[i]))
            return false;
    }
    for (unsigned i = 0; i < form->lookups; i++)
        set_steps((struct plane *)(void *)(a + form->lookup[i].offset), steps[i]);
    return true;
}

bool bin_pair_has_unit_color(const uint8_t *record, const struct pair_form *form)
{
    enum { ONE = 0x3f800000, NORMAL = 0x00800000 };
    if (!form->diffuse)
        return true;
    const __m128i bits = _mm_loadu_si128((const __m128i *)(const void *)(record + form->diffuse));
    const __m128i large = _mm_cmpgt_epi32(bits, _mm_set1_epi32(ONE));
    const __m128i small = _mm_cmpgt_epi32(_mm_set1_epi32(NORMAL), bits);
    const __m128i zero = _mm_cmpeq_epi32(bits, _mm_setzero_si128());
    return !_mm_movemask_epi8(_mm_or_si128(large, _mm_andnot_si128(zero, small)));
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
