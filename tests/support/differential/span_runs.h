/* Runs of whole blocks of a textured span, as calls of pixel routines have them. */
#ifndef TESTS_SUPPORT_DIFFERENTIAL_SPAN_RUNS_H
#define TESTS_SUPPORT_DIFFERENTIAL_SPAN_RUNS_H

#include "tests/support/differential/differential_part.h"

enum { SPAN_SIDE = 64, SPAN_ROW = TILE_SIZE / BLOCK_SIZE };

/* How the texels of a triangle follow each other: u, in texels, begins at `first` and grows by `step` from
 * pixel to pixel; v begins at 0 and grows by `down`. The origin is a number of 1/256 pixels. */
struct span_texels {
    const char *what;
    int address;
    float first, step, down, origin;
    bool tile; /* those of a whole tile follow each other, from its first column to its last */
};

/* The key of the span reading in which texture 0 replaces the colour. */
union key span_textured(int filter, int address, int compact);

/* Fills the inputs: two triangles, the second one half a texture further, and a texture of 64x64 texels. */
void span_fill_triangles(struct differential *d, const union key *key, const struct span_texels *texels);

/* Adds the blocks from `start` up to `end` of a row to the call; makes the call of `rows` runs of `length`
 * blocks, one below the other. */
void span_add_run(struct differential *d, unsigned row, unsigned start, unsigned end, unsigned triangle);
void span_fill_runs(struct differential *d, unsigned rows, unsigned start, unsigned length);

/* Runs both routines on the same tile, and compares the tiles. */
void span_expect_equal(struct differential *d, const struct routine *const routine[2], const char *what);

/* Compares runs of every length at every column, one and two of them; rectangles of every height; shapes
 * whose columns change at every row; and runs with equal columns of two triangles. */
void span_expect_equal_shapes(struct differential *d, const struct routine *const routine[2],
                              const char *what);
#endif
