/* Geometry: primitives become batches of unique vertices, and batches become records in bins.
 *
 * A batch has up to BATCH_VERTICES vertices. Each is shaded once, even if several of the batch's triangles
 * share it. The lanes after them are for the clipper. The result for a triangle does not depend on the
 * other triangles of its batch, so primitives may be cut into batches anywhere. Lines and points are
 * processed like triangles: a line is a triangle whose third corner equals its second, and a point is one
 * whose corners are all equal. */
#ifndef RENDER_GEOMETRY_BATCH_H
#define RENDER_GEOMETRY_BATCH_H

#include "render/geometry/bin.h"
#include "render/geometry/clip.h"
#include "render/draw/command.h"

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
    uint32_t limit;          /* of its vertices; 0: BATCH_VERTICES */
    bool joins_pairs;        /* as the setting */
    uint32_t vertices_count, triangles_count, setup_count;
    uint32_t first; /* primitive of triangle 0 */
    uint32_t done;  /* primitives before this one are binned */
    const struct draw *draw;
    struct bin_writer *bins;
    struct batch_counts counts;
};

/* Begins a batch of batch->draw with primitives from p on, up to `end` or until it is full
 * (render/geometry/assemble.c). Returns the first primitive that is not in it. */
uint32_t batch_assemble(struct batch *batch, uint32_t p, uint32_t end);

/* Processes primitives first to first + count - 1 of a draw into bins. Returns how many are done: fewer than
 * count when the arena is full, and then nothing of the others is left in the bins. Adds to batch->counts. */
uint32_t batch_primitives(struct batch *batch, const struct draw *draw, uint32_t first, uint32_t count,
                          struct bin_writer *bins);

#endif
