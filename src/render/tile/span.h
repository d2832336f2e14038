/* The whole blocks of a tile that wait for the span reading of a pixel routine (docs/spans.md,
 * render/geometry/span.h), beside those that wait for the ordinary routine.
 *
 * Both lists belong to one draw, and each has its triangles in drawing order. The order matters only where
 * two triangles meet in a block. So a whole block waits for the span reading only if no earlier block of the
 * same number waits for the ordinary routine, and the span reading's list is drawn first. */
#ifndef RENDER_TILE_SPAN_H
#define RENDER_TILE_SPAN_H

#include "render/geometry/span.h"

enum {
    SPAN_BLOCKS = 16,     /* the fewest blocks of a triangle in a tile for which the routine is called */
    SPAN_EXTENT = 16,     /* pixels: narrower or lower triangles are not tested */
    SPAN_WARMTH = 1 << 14 /* blocks that a key has drawn without the reading before its routine is built */
};

struct tile_spans {
    alignas(16) struct entry entry[PIXEL_ENTRIES + 4]; /* some are read beyond the last */
    uint32_t count;
    uint32_t marked_count; /* of the entries that wait for the ordinary routine, those that are marked: */
    uint64_t marked[TILE_BLOCKS / 64]; /* a bit for the block of each */
};

/* Nothing waits. */
void tile_begin_spans(struct tile_spans *spans);

/* Moves the whole blocks among `count` entries of one triangle, in their order, to `to`, if there are at
 * least `least`. Returns how many there are; *count is what is left. `to` has room for one more. */
uint32_t tile_take_spans(struct entry *entries, uint32_t *count, uint32_t least, struct entry *to);

/* Returns true if one of the first `count` entries, which wait for the ordinary routine, has the block of one
 * of the `added` entries after the list's last. `entries` begin with the same ones since tile_begin_spans. */
bool tile_spans_meet(struct tile_spans *spans, const struct entry *entries, uint32_t count, uint32_t added);

#endif
