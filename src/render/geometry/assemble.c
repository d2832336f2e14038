#include "base/minmax.h"
#include "render/geometry/batch.h"

#include <emmintrin.h>
#include <string.h>

enum { NUMBER_LIMIT = 1 << 24 };

/* --- Primitives to vertices --- */

/* The source of primitives: a copy of fields of the draw, so that the compiler can keep it in registers. */
struct index_source {
    enum triptych_primitive primitive;
    uint32_t bits, base;
    uint32_t count; /* parts of the draw */
    const void *indices;
};

static inline uint32_t vertex_at(const struct index_source *source, uint32_t i)
{
    switch (source->bits) {
    case 8: return source->base + ((const uint8_t *)source->indices)[i];
    case 16: return source->base + ((const uint16_t *)source->indices)[i];
    case 32: return source->base + ((const uint32_t *)source->indices)[i];
    default: return source->base + i;
    }
}

/* The first corner of triangle p of quads, and the two others of the triangle's quad that are on it: a, b, c
 * and a, c, d of the quad a, b, c, d. */
static inline void quad_vertices(const struct index_source *source, uint32_t p, const uint32_t quad[4],
                                 uint32_t vertex[3])
{
    uint32_t first = p / 2 * (source->primitive == TRIPTYCH_QUAD_LIST ? 4 : 2);
    vertex[0] = vertex_at(source, first + quad[0]);
    vertex[1] = vertex_at(source, first + quad[1 + (p & 1)]);
    vertex[2] = vertex_at(source, first + quad[2 + (p & 1)]);
}

/* The vertices of part p, in an order that keeps the winding of the first and begins with the vertex that
 * gives a flat triangle its colour (def/state/primitive.def). */
static inline void primitive_vertices(const struct index_source *source, uint32_t p, uint32_t vertex[3])
{
    uint32_t odd = p & 1;
    switch (source->primitive) {
    case TRIPTYCH_TRIANGLE_STRIP:
        vertex[0] = vertex_at(source, p);
        vertex[1] = vertex_at(source, p + 1 + odd);
        vertex[2] = vertex_at(source, p + 2 - odd);
        break;
    case TRIPTYCH_TRIANGLE_FAN:
        vertex[0] = vertex_at(source, p + 1);
        vertex[1] = vertex_at(source, p + 2);
        vertex[2] = vertex_at(source, 0);
        break;
    case TRIPTYCH_POINT_LIST: vertex[0] = vertex[1] = vertex[2] = vertex_at(source, p); break;
    case TRIPTYCH_LINE_LIST:
        vertex[0] = vertex_at(source, 2 * p);
        vertex[1] = vertex[2] = vertex_at(source, 2 * p + 1);
        break;
    case TRIPTYCH_LINE_STRIP:
        vertex[0] = vertex_at(source, p);
        vertex[1] = vertex[2] = vertex_at(source, p + 1);
        break;
    case TRIPTYCH_LINE_LOOP:
        vertex[0] = vertex_at(source, p);
        vertex[1] = vertex[2] = vertex_at(source, p + 1 == source->count ? 0 : p + 1);
        break;
    case TRIPTYCH_QUAD_LIST: quad_vertices(source, p, (const uint32_t[4]){0, 1, 2, 3}, vertex); break;
    case TRIPTYCH_QUAD_STRIP: quad_vertices(source, p, (const uint32_t[4]){0, 1, 3, 2}, vertex); break;
    case TRIPTYCH_POLYGON:
        vertex[0] = vertex_at(source, 0);
        vertex[1] = vertex_at(source, p + 1);
        vertex[2] = vertex_at(source, p + 2);
        break;
    default:
        vertex[0] = vertex_at(source, 3 * p);
        vertex[1] = vertex_at(source, 3 * p + 1);
        vertex[2] = vertex_at(source, 3 * p + 2);
    }
}

/* The same where the last vertex gives the colour. Quads are divided by their other diagonal, so that both
 * triangles have it. */
static inline void last_vertices(const struct index_source *source, uint32_t p, uint32_t vertex[3])
{
    switch (source->primitive) {
    case TRIPTYCH_TRIANGLE_LIST:
    case TRIPTYCH_TRIANGLE_STRIP: {
        uint32_t first = source->primitive == TRIPTYCH_TRIANGLE_LIST ? 3 * p : p;
        uint32_t odd = source->primitive == TRIPTYCH_TRIANGLE_LIST ? 0 : p & 1;
        vertex[0] = vertex_at(source, first + 2);
        vertex[1] = vertex_at(source, first + odd);
        vertex[2] = vertex_at(source, first + 1 - odd);
        break;
    }
    case TRIPTYCH_TRIANGLE_FAN:
        vertex[0] = vertex_at(source, p + 2);
        vertex[1] = vertex_at(source, 0);
        vertex[2] = vertex_at(source, p + 1);
        break;
    case TRIPTYCH_QUAD_LIST: quad_vertices(source, p, (const uint32_t[4]){3, 0, 1, 2}, vertex); break;
    case TRIPTYCH_QUAD_STRIP: quad_vertices(source, p, (const uint32_t[4]){3, 2, 0, 1}, vertex); break;
    default: primitive_vertices(source, p, vertex); /* a polygon's first one; lines are in batch.c */
    }
}

/* --- Vertices to lanes --- */

/* The most vertices of a batch. */
static uint32_t batch_vertices(const struct batch *batch)
{
    return batch->limit ? batch->limit : BATCH_VERTICES;
}

static void begin_batch(struct batch *batch, uint32_t first)
{
    batch->first = first;
    batch->vertices_count = batch->triangles_count = 0;
    if (++batch->number == NUMBER_LIMIT) {
        memset(batch->map, 0, sizeof batch->map);
        batch->number = 1;
    }
}

/* The vertex's lane, or the next lane if the batch does not have the vertex. A branch here could not be
 * predicted, and compilers insist on one, hence assembly: lane < VERTEX_CAPACITY ? (lane) : (next, count +
 * 1). */
static inline uint32_t lane_of(struct batch *batch, uint64_t number, uint32_t *count, uint32_t vertex)
{
    uint64_t *place = batch->map + vertex % BATCH_MAP;
    uint64_t here = (uint64_t)vertex << 32 | number, lane = *place ^ here, next = *count;
    batch->vertex[next] = vertex;
    __asm__("cmpq %[capacity], %[lane]\n\t"
            "cmovaeq %[next], %[lane]\n\t"
            "sbbl $-1, %[count]"
            : [lane] "+r"(lane), [count] "+r"(*count)
            : [next] "r"(next), [capacity] "e"(VERTEX_CAPACITY)
            : "cc");
    *place = here | lane;
    return (uint32_t)lane;
}

/* Adds primitives from p on to the batch that has just begun, until it is full. Returns the first that is
 * not added. */
typedef void vertices_function(const struct index_source *, uint32_t p, uint32_t vertex[3]);

static inline __attribute__((always_inline)) uint32_t assemble_by(struct batch *batch, uint32_t p,
                                                                  uint32_t end, struct index_source source,
                                                                  vertices_function *vertices_of)
{
    uint64_t number = (uint64_t)batch->number << 8;
    uint32_t count = 0, most = min_u32(end - p, BATCH_TRIANGLES), i = 0, vertices = batch_vertices(batch);
    for (; i < most && count + 3 <= vertices; i++) {
        uint32_t vertex[3], *corner = batch->corner[i / SETUP_CAPACITY][0] + i % SETUP_CAPACITY;
        vertices_of(&source, p + i, vertex);
        corner[0] = 4 * lane_of(batch, number, &count, vertex[0]);
        corner[SETUP_CAPACITY] = 4 * lane_of(batch, number, &count, vertex[1]);
        corner[2 * SETUP_CAPACITY] = 4 * lane_of(batch, number, &count, vertex[2]);
    }
    batch->vertices_count = count;
    batch->triangles_count = i;
    return p + i;
}

static inline __attribute__((always_inline)) uint32_t assemble_from(struct batch *batch, uint32_t p,
                                                                    uint32_t end, struct index_source source)
{
    return assemble_by(batch, p, end, source, primitive_vertices);
}

static uint32_t assemble_last(struct batch *batch, uint32_t p, uint32_t end, struct index_source source)
{
    return assemble_by(batch, p, end, source, last_vertices);
}

/* Writes first, first + step ... to `count` words, and up to three more. */
static void write_sequence(uint32_t *to, uint32_t first, uint32_t step, uint32_t count)
{
    __m128i value =
        _mm_set_epi32((int)(first + 3 * step), (int)(first + 2 * step), (int)(first + step), (int)first);
    for (uint32_t i = 0; i < count; i += 4) {
        _mm_store_si128((__m128i *)(void *)(to + i), value);
        value = _mm_add_epi32(value, _mm_set1_epi32((int)(4 * step)));
    }
}

/* The same for a list without indices, which shares no vertices. */
static uint32_t assemble_list(struct batch *batch, uint32_t p, uint32_t end)
{
    uint32_t count = min_u32(end - p, batch_vertices(batch) / 3);
    write_sequence(batch->vertex, batch->draw->base + 3 * p, 1, 3 * count);
    for (uint32_t k = 0; k < 3; k++)
        write_sequence(batch->corner[0][k], 4 * k, 4 * 3, count);
    batch->vertices_count = 3 * count;
    batch->triangles_count = count;
    return p + count;
}

uint32_t batch_assemble(struct batch *batch, uint32_t p, uint32_t end)
{
    const struct draw *draw = batch->draw;
    begin_batch(batch, p);
    struct index_source source = {draw->primitive, draw->index_bits, draw->base, draw->count, draw->indices};
    if (draw->last_provokes)
        return assemble_last(batch, p, end, source);
    if (draw->primitive != TRIPTYCH_TRIANGLE_LIST)
        return assemble_from(batch, p, end, source);
    switch (draw->index_bits) {
    case 8: return assemble_from(batch, p, end, source);
    case 16:
        return assemble_from(
            batch, p, end,
            (struct index_source){TRIPTYCH_TRIANGLE_LIST, 16, source.base, source.count, source.indices});
    case 32:
        return assemble_from(
            batch, p, end,
            (struct index_source){TRIPTYCH_TRIANGLE_LIST, 32, source.base, source.count, source.indices});
    default: return assemble_list(batch, p, end);
    }
}
