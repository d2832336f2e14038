#include "render/geometry/edges.h"

#include "base/bits.h"
#include "base/half.h"

#include <string.h>

/* The bit of the draw's edges for each edge of a part, from corner 0 to 1, 1 to 2 and 2 to 0. */
enum { ALL_EDGES = 15, INSIDE = 4 }; /* an edge between the parts of a quad, which no bit is for */
struct edge_bits {
    uint8_t bit[3];
};

/* Corners are in the order of render/geometry/assemble.c. Bits count edges from the primitive's first vertex
 * on: of triangles and polygons from vertex to vertex as they are numbered, of quads around them. */
static struct edge_bits edge_bits(const struct draw *draw, uint32_t part)
{
    static const struct edge_bits list[2] = {{{0, 1, 2}}, {{2, 0, 1}}};
    static const struct edge_bits odd[2] = {{{2, 1, 0}}, {{1, 0, 2}}};
    static const struct edge_bits fan[2] = {{{1, 2, 0}}, {{2, 0, 1}}};
    static const struct edge_bits quad[2][2] = {{{{0, 1, INSIDE}}, {{INSIDE, 2, 3}}},
                                                {{{3, 0, INSIDE}}, {{INSIDE, 1, 2}}}};
    static const struct edge_bits last_strip[2] = {{{2, 3, INSIDE}}, {{INSIDE, 0, 1}}};
    const bool last = draw->last_provokes;
    switch (draw->primitive) {
    case TRIPTYCH_TRIANGLE_STRIP: return part & 1 ? odd[last] : list[last];
    case TRIPTYCH_TRIANGLE_FAN: return fan[last];
    case TRIPTYCH_QUAD_LIST: return quad[last][part & 1];
    case TRIPTYCH_QUAD_STRIP: return last ? last_strip[part & 1] : quad[0][part & 1];
    case TRIPTYCH_POLYGON: return list[0];
    default: return list[last];
    }
}

/* The first component of a vertex's element. */
static float first_number(const uint8_t *at, const struct vertex_type *type)
{
    uint32_t word = 0;
    memcpy(&word, at, type->bytes < sizeof word ? type->bytes : sizeof word);
    if (type->encoding == ENCODING_FLOAT)
        return bits_to_float(word);
    if (type->encoding == ENCODING_HALF)
        return half_to_float((uint16_t)word);
    if (type->encoding == ENCODING_COLOR)
        return (float)(word >> 16 & 255) * type->scale;
    uint32_t number = word << (32 - type->bits);
    if (type->encoding == ENCODING_SIGNED)
        return (float)((int32_t)number >> (32 - type->bits)) * type->scale;
    return (float)(number >> (32 - type->bits)) * type->scale;
}

/* The mask of a vertex: its number without a fraction, limited to 0 to 15. */
static uint32_t mask_of(const struct draw *draw, uint32_t vertex)
{
    const struct attribute_job *masks = &draw->edge_masks;
    if (!masks->data)
        return ALL_EDGES;
    float number =
        first_number(masks->data + (int64_t)vertex * masks->stride, &key_vertex_types[draw->edge_format]);
    return number >= ALL_EDGES ? ALL_EDGES : number > 0 ? (uint32_t)number : 0;
}

uint32_t edges_of_part(const struct draw *draw, uint32_t part, uint32_t vertex)
{
    const struct edge_bits of = edge_bits(draw, part);
    uint32_t edges = 0, outer = 7, smooth = draw->edges & mask_of(draw, vertex);
    for (int i = 0; i < 3; i++)
        edges |= (smooth >> of.bit[i] & 1) << i;
    if (draw->primitive == TRIPTYCH_POLYGON)
        outer = 2u | (part == 0 ? 1u : 0u) | (part + 1 == draw->count ? 4u : 0u);
    return edges & outer;
}
