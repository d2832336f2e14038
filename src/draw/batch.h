/* Geometry: primitives become batches of unique vertices, batches become records in bins.
 *
 * A batch has up to BATCH_VERTICES vertices, each shaded once however many of the batch's triangles share it;
 * the lanes beyond are the clipper's. What a batch computes for a triangle does not depend on which others
 * are in it, so primitives may be cut into batches anywhere. Lines and points go the same way: a line counts
 * as a triangle whose third corner is its second, a point as one whose corners are all the same. */
#ifndef DRAW_BATCH_H
#define DRAW_BATCH_H

#include "draw/bin.h"
#include "draw/clip.h"
#include "draw/command.h"

enum {
    BATCH_VERTICES = VERTEX_CAPACITY - 16,
    BATCH_GROUPS = 2, /* of triangles for setup */
    BATCH_TRIANGLES = BATCH_GROUPS * SETUP_CAPACITY,
    BATCH_MAP = 1024
};

_Static_assert(VERTEX_CAPACITY - BATCH_VERTICES >= CLIP_VERTICES_MAXIMUM, "the clipper has room");
_Static_assert(BATCH_VERTICES % LANES_MAXIMUM == 0, "padded batches fit");

struct batch_counts {
    uint64_t vertices_shaded, triangles_set_up, triangles_visible;
};

/* One thread's workspace. */
struct batch {
    alignas(64) float vertices[SLOT_COUNT * VERTEX_CAPACITY];
    alignas(64) uint32_t corner[BATCH_GROUPS][SETUP_INDEX_ROWS][SETUP_CAPACITY]; /* as primitives have them */
    alignas(64) uint32_t setup_index[SETUP_INDEX_ROWS][SETUP_CAPACITY];          /* as clipping leaves them */
    alignas(64) uint32_t vertex[VERTEX_CAPACITY]; /* index of the vertex in each lane */
    uint64_t map[BATCH_MAP]; /* by a vertex' low bits where it was placed: vertex << 32 | batch << 8 | lane */
    uint32_t number;         /* of the batch, 24 bits */
    uint32_t vertices_count, triangles_count, setup_count;
    uint32_t first; /* primitive of triangle 0 */
    uint32_t done;  /* primitives before this one are binned */
    const struct draw *draw;
    struct bin_writer *bins;
    struct batch_counts counts;
};

/* Processes primitives first to first + count - 1 of a draw into bins. Returns how many are done: fewer than
 * count when the arena is full, and then nothing of the others is left in the bins. Adds to batch->counts. */
uint32_t batch_primitives(struct batch *batch, const struct draw *draw, uint32_t first, uint32_t count,
                          struct bin_writer *bins);

#endif
