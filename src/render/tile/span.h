/* Triangles whose blocks the span reading of a pixel routine can draw (docs/spans.md), and the runs of whole
 * blocks that it draws.
 *
 * The span reading leaves out the steps of planes that are zero in its class: u along y, v along x, 1/w
 * and every other varying along both. This changes no bit of a triangle whose planes have 0 or -0 in
 * these steps, and 0 or at least 2^-90 in their other words. Distances are multiples of 2^-8, and such a
 * word is a multiple of 2^-113, so a plane along one axis is exactly 0 or at least 2^-121 before it is
 * rounded. It is therefore neither -0 nor a denormal, and adding the product of a distance and 0 or -0 to
 * it changes nothing. */
#ifndef RENDER_TILE_SPAN_H
#define RENDER_TILE_SPAN_H

#include "contract/arguments.h"

#include <stdbool.h>

enum {
    SPAN_PLANES = 1 + 4 + 4 + 4 * TEXTURE_STAGES + 1, /* 1/w, two colours, channels, fog */
    SPAN_BLOCKS = 16,     /* the fewest blocks of a triangle in a tile for which the routine is called */
    SPAN_EXTENT = 16,     /* pixels: narrower or lower triangles are not tested */
    SPAN_WARMTH = 1 << 14 /* blocks that a key has drawn without the reading before its routine is built */
};

/* The planes of a key's records, and the axes along which each may vary. */
struct span_class {
    unsigned count;
    struct {
        uint16_t offset;
        uint8_t axes; /* enum axes */
    } plane[SPAN_PLANES];
};

/* The class of the pixel routine's key. */
struct span_class span_class(const struct pixel_key *key);

/* Returns true if the record's triangle is in the class. */
bool span_includes(const struct span_class *class, const uint8_t *record);

/* Returns true if a triangle is large enough to be tested. */
bool span_is_large(const struct triangle_head *head);

/* Moves the whole blocks among `count` entries of one triangle, in the order of blocks, to `spans`, if there
 * are at least `least`. Returns how many there are; *count is what is left. */
uint32_t span_take(struct entry *entries, uint32_t *count, uint32_t least, struct entry *spans);

#endif
