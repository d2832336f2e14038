/* The arguments of routines, one structure per unit.
 *
 * The caller owns all memory that the pointers refer to, and keeps it until the routine returns.
 * contract/layout.h has the layouts. */
#ifndef CONTRACT_ARGUMENTS_H
#define CONTRACT_ARGUMENTS_H

#include "contract/job.h"
#include "contract/layout.h"

/* For each lane i < count (a multiple of W or of 16, at most VERTEX_CAPACITY): shades vertex index[i] into
 * lane i of out. */
struct vertex_arguments {
    const struct job *job;
    const uint32_t *index;
    float *out; /* SLOT_COUNT * VERTEX_CAPACITY words, 64-byte aligned */
    uint32_t count;
};

/* For each lane i < count (a multiple of W or of 16, at most SETUP_CAPACITY): the triangle of batch vertices
 * index[0][i], index[1][i], index[2][i], as *byte* offsets of their lanes (4 * lane), into record i of out.
 *
 * Lines and edges extend from vertex 0 to vertex 1; points and corners are at vertex 0. Edges and corners
 * belong to the triangle of all three vertices. These four take flat colours from vertex index[3][i];
 * index[4][i] is -1 if a line's last pixel is drawn, else 0; of smooth lines and edges it is the width in
 * 1/256 pixel. index[3][i] of a triangle with smooth edges has bit e for the edge from its vertex e to the
 * next. Rows that a primitive does not have are not read. Routines do not read `primitive`; engines that
 * observe do (struct engine). */
struct setup_arguments {
    const struct job *job;
    const uint32_t *index; /* SETUP_INDEX_ROWS rows of SETUP_CAPACITY words */
    const float *vertices;
    uint8_t *out; /* count records of the key's stride, 64-byte aligned */
    uint32_t count;
    uint32_t primitive; /* of the draw, from 0: the batch begins with it */
};

/* For each of count (at least 1) entries in order: shades its covered pixels into the tile. In the span
 * reading (the key's field `span`) all entries are whole blocks, those of a triangle follow each other, and
 * each has a higher number than the one before.
 *
 * With `tile`, which only a routine with takes_tiles gets (engine.h), the entries are those of the first row
 * of a tile's blocks, and the tile's other blocks are the same triangle's. If the routine needs their
 * entries, it draws nothing, and `tile` becomes 0. */
struct pixel_arguments {
    const struct job *job;
    const struct entry *entries;
    const uint8_t *triangles;
    struct lane_table *lanes;
    uint32_t *
        color; /* planes of TILE_PIXELS words, those of each target in turn (def/state/target.def), or of each
                        sample; 64-byte aligned */
    uint32_t *depth; /* TILE_PIXELS words (render/target/depth.h) of each sample in turn, 64-byte aligned */
    uint32_t count;
    uint32_t tile;
};

/* The words and pointers that a blit reads besides pixels, each of its operations (spec/blit/). */
struct blit_job {
    uint32_t word, mask;              /* clear: the new bits; with BLIT_MASK_JOB, those that are set */
    int32_t left, top, right, bottom; /* clear of a part: the pixels right of left, below top ... */
    const void *row[BLIT_ROWS];       /* shrink, blend: rows of texels */
    int32_t row_weight[BLIT_ROWS];    /* shrink: of each row */
    int32_t half, total;              /* shrink: the smaller level's width; the sum of all weights */
    float weight;                     /* blend: the lower row's */
    uint32_t missing;                 /* blend to bytes: bits that the format does not have, which are set */
};

/* The byte offset of a sample's word from the first one's, where samples are averaged. */
static inline int blit_sample_offset(const struct blit_key *key, int sample)
{
    int words = key->by_rows ? BLIT_ROW_WORDS : key->numbers ? 4 * TILE_PIXELS : TILE_PIXELS;
    return 4 * words * sample;
}

/* For each element i < count (a multiple of LANES_MAXIMUM): a blit writes out[i]. `index` is as the operation
 * defines it. Both are 64-byte aligned. */
struct blit_arguments {
    const struct blit_job *job;
    const uint32_t *index;
    uint32_t *out;
    uint32_t count;
};

/* For each element i < count (a multiple of the routine's lanes or of 16): the kernel reads index[i] at INPUT
 * and writes from out + i * stride on at OUTPUT. `job` is a structure of the kernel, at JOB. No kernel has
 * shader constants. */
struct kernel_arguments {
    const void *job;
    const int32_t *index;
    uint8_t *out;
    uint32_t count;
};

#endif
