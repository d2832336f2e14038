#include "render/geometry/batch.h"

#include "base/minmax.h"
#include "machine/prefetch.h"
#include "render/geometry/edges.h"

#include <emmintrin.h>
#include <string.h>

/* --- Vertices --- */

/* The number of lanes that a routine is called with for `count`: a multiple of its own number, a power of
 * two. */
static uint32_t padded_lanes(const struct routine *routine, uint32_t count)
{
    return (count + routine->lanes - 1) & -routine->lanes;
}

/* Lanes up to the end of the routine's last step repeat the last vertex. */
static void shade_vertices(struct batch *batch)
{
    const struct routine *routine = batch->draw->routine[UNIT_VERTEX];
    uint32_t count = batch->vertices_count, padded = padded_lanes(routine, count);
    for (uint32_t last = batch->vertex[count - 1]; count < padded; count++)
        batch->vertex[count] = last;
    struct vertex_arguments call = {batch->draw->job, batch->vertex, batch->vertices, count};
    routine_run(routine, &call, batch->vertices_count);
    batch->counts.vertices_shaded += batch->vertices_count;
}

/* --- Lanes to records --- */

static uint32_t clip_code_of(const struct batch *batch, uint32_t lane)
{
    uint32_t code;
    memcpy(&code, batch->vertices + SLOT_CODE * VERTEX_CAPACITY + lane, sizeof code);
    return code;
}

static void add_to_setup(struct batch *batch, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t i = batch->setup_count++;
    batch->setup_index[0][i] = 4 * a;
    batch->setup_index[1][i] = 4 * b;
    batch->setup_index[2][i] = 4 * c;
}

/* Prefetches the memory after the group of `bytes` that is about to be written, where the next group will
 * be: the cache of the core that read it in the last round may still hold it. */
static void prefetch_records(struct bin_writer *bins, uint32_t bytes)
{
    uint32_t from = bins->at + bytes, to = bins->end - from < bytes ? bins->end : from + bytes;
    from = from > bins->asked ? from : bins->asked;
    if (!bins->arena->shared || from >= to)
        return;
    prefetch_to_write(bins->arena->base + from, to - from);
    bins->asked = to;
}

/* The rows that records of a shape have (contract/arguments.h). */
static int index_rows(enum raster_shape shape)
{
    return shape == SHAPE_TRIANGLE ? 3 : shape == SHAPE_SMOOTH_TRIANGLE ? 4 : SETUP_INDEX_ROWS;
}

/* Sets up and bins a group of records, which are the last of all primitives before `next`. Returns false
 * when the arena is full. */
static bool set_up_group(struct batch *batch, uint32_t index[SETUP_INDEX_ROWS][SETUP_CAPACITY],
                         uint32_t count, uint32_t next)
{
    const struct draw *draw = batch->draw;
    const struct routine *routine = draw->routine[UNIT_SETUP];
    uint32_t padded = padded_lanes(routine, count);
    int rows = index_rows(draw->shape);
    if (count) {
        for (int i = 0; i < rows && count < padded; i++)
            for (uint32_t lane = count, last = index[i][count - 1]; lane < padded; lane++)
                index[i][lane] = last;
        uint8_t *out = bin_reserve(batch->bins, padded * draw->stride);
        if (!out)
            return false;
        prefetch_records(batch->bins, padded * draw->stride);
        struct setup_arguments call = {draw->job, index[0], batch->vertices, out, padded, batch->first};
        routine_run(routine, &call, count);
        batch->bins->joins = batch->joins_pairs && draw->pairs.bytes;
        int visible = bin_records(batch->bins, count, draw);
        if (visible < 0)
            return false;
        batch->counts.triangles_set_up += count;
        batch->counts.triangles_visible += (uint32_t)visible;
    }
    batch->done = next;
    return true;
}

/* The same for the triangles that the clipper has produced so far. */
static bool set_up(struct batch *batch, uint32_t next)
{
    uint32_t count = batch->setup_count;
    batch->setup_count = 0;
    return set_up_group(batch, batch->setup_index, count, next);
}

/* A triangle that needs the clipper. The clipper's lanes are free again after each setup. */
static bool clip_and_add(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                         uint32_t primitive)
{
    uint32_t lane[3] = {corner[0], corner[1], corner[2]}, triangle[CLIP_TRIANGLES_MAXIMUM][3];
    int count = -1;
    if (batch->setup_count + CLIP_TRIANGLES_MAXIMUM <= SETUP_CAPACITY)
        count = clip_triangle(clipper, lane, triangle);
    if (count < 0) {
        if (!set_up(batch, primitive))
            return false;
        clipper->next = batch->vertices_count;
        count = clip_triangle(clipper, lane, triangle);
    }
    for (int i = 0; i < count; i++)
        add_to_setup(batch, triangle[i][0], triangle[i][1], triangle[i][2]);
    return true;
}

/* Drops, clips or adds the triangle, by its clip codes. Returns false when the arena is full. */
static bool add_triangle(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                         uint32_t primitive)
{
    uint32_t a = clip_code_of(batch, corner[0]), b = clip_code_of(batch, corner[1]);
    uint32_t c = clip_code_of(batch, corner[2]), counts = ~batch->draw->clip_ignored;
    if ((a & b & c & CLIP_FRUSTUM & counts) || ((a | b | c) & CLIP_INVALID))
        return true;
    if (((a | b | c) & CLIP_NEEDED & counts) || batch->draw->wrapped)
        return clip_and_add(batch, clipper, corner, primitive);
    if (batch->setup_count == SETUP_CAPACITY) {
        if (!set_up(batch, primitive))
            return false;
        clipper->next = batch->vertices_count;
    }
    add_to_setup(batch, corner[0], corner[1], corner[2]);
    return true;
}

/* --- Lines and points --- */

/* One record: `corner` as setup has them, the vertex with its flat colours, whether it draws a last pixel,
 * and the pixels across beyond the first. */
struct record {
    uint32_t corner[3];
    uint32_t provoking;
    bool last_pixel;
    uint32_t extra;
};

static void add_record(struct batch *batch, const struct record *record)
{
    uint32_t i = batch->setup_count;
    add_to_setup(batch, record->corner[0], record->corner[1], record->corner[2]);
    batch->setup_index[3][i] = 4 * record->provoking;
    batch->setup_index[4][i] = record->last_pixel ? ~record->extra : record->extra;
    if (batch->draw->shape == SHAPE_SMOOTH_LINE)
        batch->setup_index[4][i] = batch->draw->line_width;
}

/* Room for all records of one primitive, so that none is set up while others are missing; with `empty` the
 * clipper's lanes are free again, too. Returns false when the arena is full. */
static bool make_room(struct batch *batch, struct clipper *clipper, uint32_t primitive, bool empty)
{
    if (!empty && batch->setup_count + CLIP_VERTICES_MAXIMUM <= SETUP_CAPACITY)
        return true;
    clipper->next = batch->vertices_count;
    return set_up(batch, primitive);
}

/* Sides of the frustum are the rasterizer's: a line or point beside the viewport may reach into it. */
static bool add_line(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                     uint32_t primitive)
{
    const struct draw *draw = batch->draw;
    uint32_t a = clip_code_of(batch, corner[0]) & ~draw->clip_ignored;
    uint32_t b = clip_code_of(batch, corner[1]) & ~draw->clip_ignored;
    uint32_t lane[2] = {corner[0], corner[1]}, left[2] = {corner[0], corner[1]};
    if ((a & b & CLIP_NEEDED) || ((a | b) & CLIP_INVALID))
        return true;
    if (!make_room(batch, clipper, primitive, false))
        return false;
    int count = ((a | b) & CLIP_NEEDED) || draw->wrapped ? clip_line(clipper, lane, left) : 1;
    if (count < 0) {
        if (!make_room(batch, clipper, primitive, true))
            return false;
        count = clip_line(clipper, lane, left);
    }
    bool last = draw->primitive == TRIPTYCH_LINE_LIST ||
                (draw->primitive == TRIPTYCH_LINE_STRIP && primitive + 1 == draw->count);
    bool cut = b & CLIP_NEEDED; /* the line goes on after its end */
    uint32_t provoking = draw->last_provokes ? corner[1] : left[0];
    if (count)
        add_record(batch, &(struct record){{left[0], left[1], left[1]},
                                           provoking,
                                           (last && draw->last_pixel) || cut,
                                           draw->line_extra});
    return true;
}

/* Only its centre is clipped. A point beyond the guard band is too far away to reach the viewport, however
 * large. */
static bool add_point(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                      uint32_t primitive)
{
    uint32_t code = clip_code_of(batch, corner[0]) & ~batch->draw->clip_ignored, lane = corner[0];
    if (code & batch->draw->point_clipped)
        return true;
    if (!make_room(batch, clipper, primitive, false))
        return false;
    add_record(batch, &(struct record){{lane, lane, lane}, lane, false, 0});
    return true;
}

/* The edges of a triangle as lines, or its corners as points, each with the next two or the last one of the
 * polygon that the triangle was clipped to. Edges that clipping has made are not drawn, nor are new corners.
 */
static void add_outline(struct batch *batch, const struct clipped *clipped, uint32_t provoking, bool corners)
{
    const struct draw *draw = batch->draw;
    for (int i = 0; i < clipped->count; i++) {
        int next = (i + 1) % clipped->count, third = (next + clipped->count / 2) % clipped->count;
        struct record record = {{clipped->lane[i], clipped->lane[next], clipped->lane[third]},
                                draw->flat || !corners ? provoking : clipped->lane[i],
                                draw->last_pixel || !(clipped->corners >> next & 1),
                                0};
        if ((corners ? clipped->points : clipped->edges) >> i & 1)
            add_record(batch, &record);
    }
}

/* The corners and edges of a part that are those of its quad or polygon, too. */
static void choose_outline(const struct draw *draw, uint32_t part, struct clipper *clipper)
{
    enum { AB = 1, BC = 2, CA = 4, ALL = 7, ONLY_C = 4 };
    bool first = part == 0, last = part + 1 == draw->count;
    if (draw->primitive == TRIPTYCH_QUAD_LIST || draw->primitive == TRIPTYCH_QUAD_STRIP) {
        first = !(part & 1);
        last = !first;
    } else if (draw->primitive != TRIPTYCH_POLYGON) {
        first = last = true;
    }
    clipper->points = first ? ALL : ONLY_C;
    clipper->edges = BC | (first ? AB : 0u) | (last ? CA : 0u);
}

static bool add_parts(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                      uint32_t primitive)
{
    const struct draw *draw = batch->draw;
    bool corners = draw->shape == SHAPE_POINT;
    uint32_t lane[3] = {corner[0], corner[1], corner[2]}, every = CLIP_FRUSTUM, any = 0;
    for (int i = 0; i < 3; i++) {
        uint32_t code = clip_code_of(batch, lane[i]) & ~draw->clip_ignored;
        every &= code;
        any |= code;
    }
    if ((every & (corners ? CLIP_NEEDED : CLIP_FRUSTUM)) || (any & CLIP_INVALID))
        return true;
    if (!make_room(batch, clipper, primitive, false))
        return false;
    choose_outline(draw, primitive, clipper);
    struct clipped clipped = {3, {lane[0], lane[1], lane[2]}, 7, clipper->points, clipper->edges};
    if (((any & CLIP_NEEDED) || clipper->wrapped) && clip_polygon(clipper, lane, &clipped)) {
        if (!make_room(batch, clipper, primitive, true))
            return false;
        clip_polygon(clipper, lane, &clipped);
    }
    add_outline(batch, &clipped, lane[0], corners);
    return true;
}

/* --- Triangles with smooth edges --- */

/* The triangles of a polygon, which share its first corner. Edges between them are not smooth. */
static void add_fan(struct batch *batch, const struct clipped *clipped)
{
    for (int i = 1; i + 1 < clipped->count; i++) {
        uint32_t first = i == 1 ? clipped->edges & 1 : 0, outer = clipped->edges >> i & 1;
        uint32_t last = i + 2 == clipped->count ? clipped->edges >> (i + 1) & 1 : 0;
        batch->setup_index[3][batch->setup_count] = first | outer << 1 | last << 2;
        add_to_setup(batch, clipped->lane[0], clipped->lane[i], clipped->lane[i + 1]);
    }
}

/* As add_triangle. */
static bool add_smooth(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                       uint32_t primitive)
{
    const struct draw *draw = batch->draw;
    uint32_t lane[3] = {corner[0], corner[1], corner[2]}, counts = ~draw->clip_ignored;
    uint32_t a = clip_code_of(batch, lane[0]), b = clip_code_of(batch, lane[1]);
    uint32_t c = clip_code_of(batch, lane[2]);
    if ((a & b & c & CLIP_FRUSTUM & counts) || ((a | b | c) & CLIP_INVALID))
        return true;
    if (!make_room(batch, clipper, primitive, false))
        return false;
    clipper->edges = edges_of_part(draw, primitive, batch->vertex[corner[0]]);
    struct clipped clipped = {3, {lane[0], lane[1], lane[2]}, 7, 7, clipper->edges};
    bool clips = ((a | b | c) & CLIP_NEEDED & counts) || draw->wrapped;
    if (clips && clip_polygon(clipper, lane, &clipped)) {
        if (!make_room(batch, clipper, primitive, true))
            return false;
        clip_polygon(clipper, lane, &clipped);
    }
    add_fan(batch, &clipped);
    return true;
}

/* --- Batches --- */

typedef bool add_function(struct batch *, struct clipper *, const uint8_t corner[3], uint32_t primitive);

/* One by one, as their clip codes require. */
static bool add_all(struct batch *batch, struct clipper *clipper, enum primitive primitive)
{
    static add_function *const add[PRIMITIVE_COUNT] = {[PRIMITIVE_TRIANGLE] = add_triangle,
                                                       [PRIMITIVE_LINE] = add_line,
                                                       [PRIMITIVE_POINT] = add_point,
                                                       [PRIMITIVE_EDGE] = add_parts,
                                                       [PRIMITIVE_CORNER] = add_parts};
    add_function *const add_one = batch->draw->shape == SHAPE_SMOOTH_TRIANGLE ? add_smooth : add[primitive];
    for (uint32_t i = 0; i < batch->triangles_count; i++) {
        const uint32_t *row = batch->corner[i / SETUP_CAPACITY][0] + i % SETUP_CAPACITY;
        const uint8_t corner[3] = {(uint8_t)(row[0] / 4), (uint8_t)(row[SETUP_CAPACITY] / 4),
                                   (uint8_t)(row[2 * SETUP_CAPACITY] / 4)};
        if (!add_one(batch, clipper, corner, batch->first + i))
            return false;
    }
    return true;
}

/* Bits of clip codes that count: those that all vertices of the batch have, and those that any has. */
struct batch_codes {
    uint32_t every, any;
};

static uint32_t every_bit(__m128i v)
{
    v = _mm_and_si128(v, _mm_shuffle_epi32(v, _MM_SHUFFLE(1, 0, 3, 2)));
    return (uint32_t)_mm_cvtsi128_si32(_mm_and_si128(v, _mm_shuffle_epi32(v, 1)));
}

static struct batch_codes batch_codes(const struct batch *batch)
{
    const float *code = batch->vertices + SLOT_CODE * VERTEX_CAPACITY;
    __m128i ones = _mm_set1_epi32(-1), every = ones, none = ones;
    for (uint32_t i = 0; i < batch->vertices_count; i += 4) {
        __m128i codes = _mm_load_si128((const __m128i *)(const void *)(code + i));
        every = _mm_and_si128(every, codes);
        none = _mm_andnot_si128(codes, none);
    }
    uint32_t counts = ~batch->draw->clip_ignored;
    return (struct batch_codes){every_bit(every) & counts, ~every_bit(none) & (counts | CLIP_INVALID)};
}

/* Drops triangles that lie on the outside of one side of the frustum altogether; returns how many are
 * left. */
static uint32_t drop_outside(const struct batch *batch, uint32_t corner[SETUP_INDEX_ROWS][SETUP_CAPACITY],
                             uint32_t count)
{
    uint32_t left = 0, counts = CLIP_FRUSTUM & ~batch->draw->clip_ignored;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = corner[0][i], b = corner[1][i], c = corner[2][i];
        uint32_t outside =
            clip_code_of(batch, a / 4) & clip_code_of(batch, b / 4) & clip_code_of(batch, c / 4);
        corner[0][left] = a;
        corner[1][left] = b;
        corner[2][left] = c;
        left += !(outside & counts);
    }
    return left;
}

/* Triangles that do not need the clipper: only those of the batch. */
static bool add_unclipped(struct batch *batch, uint32_t any)
{
    for (uint32_t i = 0; i < batch->triangles_count; i += SETUP_CAPACITY) {
        uint32_t(*corner)[SETUP_CAPACITY] = batch->corner[i / SETUP_CAPACITY];
        uint32_t count = min_u32(batch->triangles_count - i, SETUP_CAPACITY), left = count;
        if (any & CLIP_FRUSTUM)
            left = drop_outside(batch, corner, count);
        if (!set_up_group(batch, corner, left, batch->first + i + count))
            return false;
    }
    return true;
}

static bool add_clipped(struct batch *batch, const struct setup_key *key)
{
    struct clipper clipper =
        clipper_create(batch->draw->job, key->varying, batch->vertices, batch->vertices_count);
    clipper.window = key->window;
    if (key->point_size)
        clipper.smooth |= 1ull << SLOT_POINT_SIZE;
    clipper.ignored = batch->draw->clip_ignored;
    clipper.wrapped = primitive_is_point(key->primitive) ? 0 : batch->draw->wrapped;
    batch->setup_count = 0;
    return add_all(batch, &clipper, key->primitive) && set_up(batch, batch->first + batch->triangles_count);
}

/* Shades and sets up the whole batch. Returns false when the arena is full. */
static bool end_batch(struct batch *batch)
{
    const struct setup_key *key = &batch->draw->routine[UNIT_SETUP]->key.setup;
    shade_vertices(batch);
    struct batch_codes codes = batch_codes(batch);
    if (key->primitive != PRIMITIVE_TRIANGLE || key->smooth)
        return add_clipped(batch, key);
    if (codes.every & CLIP_FRUSTUM) {
        batch->done = batch->first + batch->triangles_count;
        return true;
    }
    if ((codes.any & (CLIP_NEEDED | CLIP_INVALID)) || batch->draw->wrapped)
        return add_clipped(batch, key);
    return add_unclipped(batch, codes.any);
}

/* Leaves the last triangle to the next batch, if its pair is there and they may be a rectangle. Returns the
 * first primitive that is not in the batch. */
static uint32_t keep_pairs(struct batch *batch, uint32_t next, uint32_t end)
{
    const bool joins = batch->joins_pairs && batch->draw->pairs.bytes;
    if (!joins || next == end || !(next & 1) || batch->triangles_count < 2)
        return next;
    batch->triangles_count--;
    return next - 1;
}

uint32_t batch_primitives(struct batch *batch, const struct draw *draw, uint32_t first, uint32_t count,
                          struct bin_writer *bins)
{
    bool single = draw->routine[UNIT_SETUP]->engine->observes;
    batch->draw = draw;
    batch->bins = bins;
    batch->done = first;
    for (uint32_t p = first; p < first + count;) {
        p = batch_assemble(batch, p, single ? p + 1 : first + count);
        p = keep_pairs(batch, p, first + count);
        if (!end_batch(batch))
            break;
    }
    return batch->done - first;
}
