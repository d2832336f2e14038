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

/* Four times the vertex's lane, or the next lane if the batch does not have the vertex. A branch here could
 * not be predicted, and compilers insist on one, hence assembly:
 *
 *   lane = place ^ here;
 *   lane = lane < VERTEX_CAPACITY ? (lane) : (count++);
 *   place = here | lane;
 */
static inline uint32_t lane_of(struct batch *batch, uint64_t number, uint64_t *count, uint32_t vertex)
{
    uint64_t here = (uint64_t)vertex << 32 | number, lane;
    batch->vertex[*count] = vertex;
    __asm__("movq %[place], %[lane]\n\t"
            "xorq %[here], %[lane]\n\t"
            "cmpq %[capacity], %[lane]\n\t"
            "cmovaeq %[count], %[lane]\n\t"
            "sbbq $-1, %[count]\n\t"
            "orq %[lane], %[here]\n\t"
            "movq %[here], %[place]"
            : [lane] "=&r"(lane), [count] "+&r"(*count), [here] "+&r"(here),
              [place] "+m"(batch->map[vertex % BATCH_MAP])
            : [capacity] "e"(VERTEX_CAPACITY)
            : "cc");
    return 4 * (uint32_t)lane;
}

/* Adds primitives from p on to the batch that has just begun, until it is full. Returns the first that is
 * not added. */
typedef void vertices_function(const struct index_source *, uint32_t p, uint32_t vertex[3]);

static inline __attribute__((always_inline)) uint32_t assemble_by(struct batch *batch, uint32_t p,
                                                                  uint32_t end, struct index_source source,
                                                                  vertices_function *vertices_of)
{
    uint64_t number = (uint64_t)batch->number << 8;
    uint64_t count = 0;
    uint32_t most = min_u32(end - p, BATCH_TRIANGLES), i = 0, vertices = batch_vertices(batch);
    for (; i < most && count + 3 <= vertices; i++) {
        uint32_t vertex[3], *corner = batch->corner[i / SETUP_CAPACITY][0] + i % SETUP_CAPACITY;
        vertices_of(&source, p + i, vertex);
        corner[0] = lane_of(batch, number, &count, vertex[0]);
        corner[SETUP_CAPACITY] = lane_of(batch, number, &count, vertex[1]);
        corner[2 * SETUP_CAPACITY] = lane_of(batch, number, &count, vertex[2]);
    }
    batch->vertices_count = (uint32_t)count;
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

/* A list of indices of 16 or 32 bits, and where its triangles go. */
struct index_list {
    const uint8_t *from;
    uint32_t bits, base;
    uint32_t *corner;
    uint64_t number, count; /* of the batch, shifted; of its vertices */
};

static inline __attribute__((always_inline)) void add_index(struct batch *batch, struct index_list *list,
                                                            uint32_t triangle, uint32_t k)
{
    const void *from = list->from;
    uint32_t i = 3 * triangle + k;
    uint32_t index = list->bits == 16 ? ((const uint16_t *)from)[i] : ((const uint32_t *)from)[i];
    list->corner[k * SETUP_CAPACITY + triangle] =
        lane_of(batch, list->number, &list->count, list->base + index);
}

static inline __attribute__((always_inline)) void add_triangle(struct batch *batch, struct index_list *list,
                                                               uint32_t triangle)
{
    add_index(batch, list, triangle, 0);
    add_index(batch, list, triangle, 1);
    add_index(batch, list, triangle, 2);
}

static inline void advance(struct index_list *list, uint32_t triangles)
{
    list->from += triangles * 3 * (list->bits / 8);
    list->corner += triangles;
}

/* As assemble_by, of a list of indices of 16 or 32 bits. Nothing is computed from the number of a triangle.
 *
 * A vertex is often one of the triangle before, and then the load of its place waits for a store that has
 * just been made. Processors predict by the load's address in the code for which store it waits. Meshes are
 * often made of pairs of triangles whose corners repeat in the same order, so a pair has code of its own for
 * each of its six corners. */
static inline __attribute__((always_inline)) uint32_t assemble_indices(struct batch *batch, uint32_t p,
                                                                       uint32_t end, uint32_t bits)
{
    const struct draw *draw = batch->draw;
    struct index_list list = {(const uint8_t *)draw->indices + (size_t)p * 3 * (bits / 8),
                              bits,
                              draw->base,
                              NULL,
                              (uint64_t)batch->number << 8,
                              0};
    uint32_t most = min_u32(end - p, BATCH_TRIANGLES), i = 0, vertices = batch_vertices(batch);
    for (uint32_t group = 0; i < most; group++) {
        uint32_t group_end = min_u32((group + 1) * SETUP_CAPACITY, most);
        list.corner = batch->corner[group][0];
        for (; i + 2 <= group_end && list.count + 6 <= vertices; i += 2) {
            add_triangle(batch, &list, 0);
            add_triangle(batch, &list, 1);
            advance(&list, 2);
        }
        for (; i < group_end && list.count + 3 <= vertices; i++) {
            add_triangle(batch, &list, 0);
            advance(&list, 1);
        }
        if (i < group_end)
            break;
    }
    batch->vertices_count = (uint32_t)list.count;
    batch->triangles_count = i;
    return p + i;
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
    case 16: return assemble_indices(batch, p, end, 16);
    case 32: return assemble_indices(batch, p, end, 32);
    default: return assemble_list(batch, p, end);
    }
}
