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
 * that gives a flat triangle its colour (Direct3D 9: the strip's vertex p, the fan's vertex p + 1). */
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
    routine->run(&call, routine);
    batch->counts.vertices_shaded += batch->vertices_count;
}

/* --- Lanes to triangle records ----------------------------------------------------------------------------
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

/* Sets up and bins the group of triangles collected so far, which are those of all primitives before `next`.
 * Returns false when the arena is full. */
static bool set_up(struct batch *batch, uint32_t next)
{
    const struct draw *draw = batch->draw;
    const struct routine *routine = draw->routine[UNIT_SETUP];
    uint32_t count = batch->setup_count, padded = count;
    batch->setup_count = 0;
    if (count) {
        for (; padded % LANES_MAXIMUM; padded++)
            for (int i = 0; i < 3; i++)
                batch->setup_index[i][padded] = batch->setup_index[i][count - 1];
        uint8_t *out = bin_reserve(batch->bins, padded * draw->stride);
        if (!out)
            return false;
        struct setup_call call = {&draw->job, batch->setup_index[0], batch->vertices, out, padded};
        routine->run(&call, routine);
        int visible = bin_triangles(batch->bins, count, draw->stride, &draw->scissor);
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
    uint32_t c = clip_code_of(batch, corner[2]);
    if ((a & b & c & CLIP_FRUSTUM) || ((a | b | c) & CLIP_INVALID))
        return true;
    if ((a | b | c) & CLIP_NEEDED)
        return clip_and_add(batch, clipper, corner, primitive);
    if (batch->setup_count == SETUP_CAPACITY) {
        if (!set_up(batch, primitive))
            return false;
        clipper->next = batch->vertices_count;
    }
    add_to_setup(batch, corner[0], corner[1], corner[2]);
    return true;
}

/* Shades and sets up the whole batch. Returns false when the arena is full. */
static bool end_batch(struct batch *batch)
{
    if (!batch->triangles_count)
        return true;
    shade_vertices(batch);
    struct clipper clipper =
        clipper_create(&batch->draw->job, batch->draw->routine[UNIT_SETUP]->key.setup.varying,
                       batch->vertices, batch->vertices_count);
    clipper.window = batch->draw->routine[UNIT_SETUP]->key.setup.window;
    batch->setup_count = 0;
    for (uint32_t i = 0; i < batch->triangles_count; i++)
        if (!add_triangle(batch, &clipper, batch->lane[i], batch->first + i))
            return false;
    return set_up(batch, batch->first + batch->triangles_count);
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
