#include "draw/batch.h"

#include <string.h>

enum { NUMBER_LIMIT = 1 << 24 };

/* --- Primitives to vertices -------------------------------------------------------------------------------
 */

static uint32_t vertex_at(const struct draw *draw, uint32_t i)
{
    switch (draw->index_bits) {
    case 16: return draw->base + ((const uint16_t *)draw->indices)[i];
    case 32: return draw->base + ((const uint32_t *)draw->indices)[i];
    default: return draw->base + i;
    }
}

/* The vertices of primitive p, in an order that keeps the winding of the first and begins with the vertex
 * that gives a flat triangle its colour (Direct3D 9: the strip's vertex p, the fan's vertex p + 1; the line's
 * first). */
static void primitive_vertices(const struct draw *draw, uint32_t p, uint32_t vertex[3])
{
    uint32_t odd = p & 1;
    switch (draw->primitive) {
    case TRIPTYCH_TRIANGLE_STRIP:
        vertex[0] = vertex_at(draw, p);
        vertex[1] = vertex_at(draw, p + 1 + odd);
        vertex[2] = vertex_at(draw, p + 2 - odd);
        break;
    case TRIPTYCH_TRIANGLE_FAN:
        vertex[0] = vertex_at(draw, p + 1);
        vertex[1] = vertex_at(draw, p + 2);
        vertex[2] = vertex_at(draw, 0);
        break;
    case TRIPTYCH_POINT_LIST: vertex[0] = vertex[1] = vertex[2] = vertex_at(draw, p); break;
    case TRIPTYCH_LINE_LIST:
        vertex[0] = vertex_at(draw, 2 * p);
        vertex[1] = vertex[2] = vertex_at(draw, 2 * p + 1);
        break;
    case TRIPTYCH_LINE_STRIP:
        vertex[0] = vertex_at(draw, p);
        vertex[1] = vertex[2] = vertex_at(draw, p + 1);
        break;
    default:
        for (uint32_t i = 0; i < 3; i++)
            vertex[i] = vertex_at(draw, 3 * p + i);
    }
}

/* --- Vertices to lanes ------------------------------------------------------------------------------------
 */

static void begin_batch(struct batch *batch, uint32_t first)
{
    batch->first = first;
    batch->vertices_count = batch->triangles_count = 0;
    if (++batch->number == NUMBER_LIMIT) {
        memset(batch->map, 0, sizeof batch->map);
        batch->number = 1;
    }
}

/* Whether a vertex is in the batch already cannot be predicted: no branch asks. */
static uint8_t lane_of(struct batch *batch, uint32_t vertex)
{
    struct batch_place *place = batch->map + vertex % BATCH_MAP;
    uint32_t next = batch->vertices_count, tag = batch->number << 8 | next;
    uint32_t known = (place->vertex == vertex) & (place->tag >> 8 == batch->number);
    tag = known ? place->tag : tag;
    batch->vertex[next] = vertex;
    batch->vertices_count = next + !known;
    *place = (struct batch_place){vertex, tag};
    return (uint8_t)tag;
}

static bool has_room(const struct batch *batch)
{
    return batch->vertices_count + 3 <= BATCH_VERTICES && batch->triangles_count < BATCH_TRIANGLES;
}

/* Lanes up to the next multiple of LANES_MAXIMUM repeat the last vertex. */
static void shade_vertices(struct batch *batch)
{
    const struct routine *routine = batch->draw->routine[UNIT_VERTEX];
    uint32_t count = batch->vertices_count;
    for (; count % LANES_MAXIMUM; count++)
        batch->vertex[count] = batch->vertex[count - 1];
    struct vertex_call call = {&batch->draw->job, batch->vertex, batch->vertices, count};
    routine_run(routine, &call, batch->vertices_count);
    batch->counts.vertices_shaded += batch->vertices_count;
}

/* --- Lanes to records -------------------------------------------------------------------------------------
 */

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

/* Sets up and bins the group of records collected so far, which are those of all primitives before `next`.
 * Returns false when the arena is full. */
static bool set_up(struct batch *batch, uint32_t next)
{
    const struct draw *draw = batch->draw;
    const struct routine *routine = draw->routine[UNIT_SETUP];
    uint32_t count = batch->setup_count, padded = count;
    batch->setup_count = 0;
    if (count) {
        for (; padded % LANES_MAXIMUM; padded++)
            for (int i = 0; i < SETUP_INDEX_ROWS; i++)
                batch->setup_index[i][padded] = batch->setup_index[i][count - 1];
        uint8_t *out = bin_reserve(batch->bins, padded * draw->stride);
        if (!out)
            return false;
        struct setup_call call = {&draw->job, batch->setup_index[0], batch->vertices, out, padded};
        routine_run(routine, &call, count);
        int visible =
            bin_records(batch->bins, count, draw->stride, draw->shape, &draw->sampling, &draw->scissor);
        if (visible < 0)
            return false;
        batch->counts.triangles_set_up += count;
        batch->counts.triangles_visible += (uint32_t)visible;
    }
    batch->done = next;
    return true;
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

/* Clip codes decide: dropped, clipped or as it is. Returns false when the arena is full. */
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

/* --- Lines and points --------------------------------------------------------------------------------------
 */

/* One record: `corner` as setup has them, the vertex with its flat colours, whether it draws a last pixel. */
struct record {
    uint32_t corner[3];
    uint32_t provoking;
    bool last_pixel;
};

static void add_record(struct batch *batch, const struct record *record)
{
    uint32_t i = batch->setup_count;
    add_to_setup(batch, record->corner[0], record->corner[1], record->corner[2]);
    batch->setup_index[3][i] = 4 * record->provoking;
    batch->setup_index[4][i] = record->last_pixel ? UINT32_MAX : 0;
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
    bool last = draw->primitive == TRIPTYCH_LINE_LIST || primitive + 1 == draw->count;
    bool cut = b & CLIP_NEEDED; /* the line goes on behind its end */
    if (count)
        add_record(batch,
                   &(struct record){{left[0], left[1], left[1]}, left[0], (last && draw->last_pixel) || cut});
    return true;
}

/* Clipped by its centre alone. One beyond the guard band is too far away for the largest point. */
static bool add_point(struct batch *batch, struct clipper *clipper, const uint8_t corner[3],
                      uint32_t primitive)
{
    uint32_t code = clip_code_of(batch, corner[0]) & ~batch->draw->clip_ignored, lane = corner[0];
    if (code & (CLIP_NEEDED | CLIP_INVALID))
        return true;
    if (!make_room(batch, clipper, primitive, false))
        return false;
    add_record(batch, &(struct record){{lane, lane, lane}, lane, false});
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
                                draw->last_pixel || !(clipped->corners >> next & 1)};
        if ((corners ? clipped->corners : clipped->edges) >> i & 1)
            add_record(batch, &record);
    }
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
    struct clipped clipped = {.count = 3, .lane = {lane[0], lane[1], lane[2]}, .corners = 7, .edges = 7};
    if (((any & CLIP_NEEDED) || clipper->wrapped) && clip_polygon(clipper, lane, &clipped)) {
        if (!make_room(batch, clipper, primitive, true))
            return false;
        clip_polygon(clipper, lane, &clipped);
    }
    add_outline(batch, &clipped, lane[0], corners);
    return true;
}

/* --- Batches
 * ------------------------------------------------------------------------------------------------
 */

typedef bool add_function(struct batch *, struct clipper *, const uint8_t corner[3], uint32_t primitive);

static bool add_all(struct batch *batch, struct clipper *clipper, enum primitive primitive)
{
    static add_function *const others[PRIMITIVE_COUNT] = {[PRIMITIVE_LINE] = add_line,
                                                          [PRIMITIVE_POINT] = add_point,
                                                          [PRIMITIVE_EDGE] = add_parts,
                                                          [PRIMITIVE_CORNER] = add_parts};
    uint32_t count = batch->triangles_count, i = 0;
    if (primitive == PRIMITIVE_TRIANGLE)
        while (i < count && add_triangle(batch, clipper, batch->lane[i], batch->first + i))
            i++;
    else
        while (i < count && others[primitive](batch, clipper, batch->lane[i], batch->first + i))
            i++;
    return i == count;
}

/* Shades and sets up the whole batch. Returns false when the arena is full. */
static bool end_batch(struct batch *batch)
{
    if (!batch->triangles_count)
        return true;
    shade_vertices(batch);
    const struct setup_key *key = &batch->draw->routine[UNIT_SETUP]->key.setup;
    struct clipper clipper =
        clipper_create(&batch->draw->job, key->varying, batch->vertices, batch->vertices_count);
    clipper.window = key->window;
    if (key->point_size)
        clipper.smooth |= 1ull << SLOT_POINT_SIZE;
    clipper.ignored = batch->draw->clip_ignored;
    clipper.wrapped = primitive_is_point(key->primitive) ? 0 : batch->draw->wrapped;
    batch->setup_count = 0;
    return add_all(batch, &clipper, key->primitive) && set_up(batch, batch->first + batch->triangles_count);
}

uint32_t batch_primitives(struct batch *batch, const struct draw *draw, uint32_t first, uint32_t count,
                          struct bin_writer *bins)
{
    batch->draw = draw;
    batch->bins = bins;
    batch->done = first;
    begin_batch(batch, first);
    for (uint32_t p = first; p < first + count; p++) {
        uint32_t vertex[3];
        primitive_vertices(draw, p, vertex);
        if (!has_room(batch)) {
            if (!end_batch(batch))
                return batch->done - first;
            begin_batch(batch, p);
        }
        uint8_t *lane = batch->lane[batch->triangles_count++];
        for (int i = 0; i < 3; i++)
            lane[i] = lane_of(batch, vertex[i]);
    }
    end_batch(batch);
    return batch->done - first;
}
