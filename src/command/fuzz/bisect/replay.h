/* One execution of a routine that can be repeated: the same inputs for any routine, any number of times,
 * with its own memory for the outputs.
 *
 * An image is all memory that a routine may write, or that moves with its lanes:
 *
 *     outputs    vertex: the batch; setup: the records; pixel: colour planes, then depth planes; blit: words
 *     table      vertex, setup: the rows of indices; pixel: the lane table; blit: its input
 *     probes     rows of 16 words that probes (probe.h) write, after the table of the base that moves
 *
 * Other inputs (job, textures, triangles, rows of a blit) are not copied: a replay is valid as long as the
 * execution that it was taken from. */
#ifndef COMMAND_FUZZ_BISECT_REPLAY_H
#define COMMAND_FUZZ_BISECT_REPLAY_H

#include "contract/binding.h"
#include "contract/engine.h"

#include <stdbool.h>

enum { PROBE_ROW_BYTES = 4 * LANES_MAXIMUM, QUAD_LANES = 4, NO_PIXEL = -1 };

struct replay {
    enum unit unit;
    const union key *key;
    const void *job;          /* struct blit_job of a blit, otherwise struct job */
    const float *vertices;    /* setup */
    const uint8_t *triangles; /* pixel */
    struct triangle_layout layout;
    struct entry_list *entries; /* pixel */
    uint32_t count;             /* as in the call */
    size_t color_bytes, depth_bytes;
    size_t output_bytes, table_bytes; /* the table follows the outputs, probes follow the table */
    uint32_t probe_rows;
    uint8_t *before;          /* the image that routines find */
    int32_t pixel_x, pixel_y; /* differences elsewhere do not count; or NO_PIXEL */
};

/* The planes of the renderer's target in all samples, 0 where there is none. The arguments of a pixel routine
 * do not contain them. */
struct replay_target {
    uint32_t color_planes, depth_planes;
};

/* Copies a call. Returns 0, or -1 when there is no memory; replay_free it in either case. */
int replay_take(struct replay *replay, const struct routine *routine, const void *call,
                const struct replay_target *target);
void replay_free(struct replay *replay);

/* A new image, aligned, or null. */
uint8_t *replay_image(const struct replay *replay);

/* Reserves `rows` rows of probes in images made from now on. Returns 0, or -1 without memory. */
int replay_reserve(struct replay *replay, uint32_t rows);

/* Runs the routine on `before`, in the image; rows of probes are left as they are. */
void replay_run(const struct replay *replay, const struct routine *routine, uint8_t *image);

/* Where the outputs of two images differ. */
struct replay_place {
    size_t at;        /* byte of the word in the outputs, or of a counter in the table */
    uint32_t element; /* lane of the call: vertex, triangle, blit's; of pixels the lane in the block */
    uint32_t word[2];
};

/* Returns true if the images differ where it counts, and the first difference. All NaNs in vertices and
 * planes are equal, and the planes of invisible triangles are undefined. */
bool replay_differs(const struct replay *replay, const uint8_t *a, const uint8_t *b,
                    struct replay_place *place);

/* Narrows a replay to the one group of 16 elements, or to the one entry, with which the two routines still
 * differ. Returns 1 if there is one, 0 if it takes more, -1 without memory. */
int replay_narrow(struct replay *replay, const struct routine *a, const struct routine *b);

/* The addresses that four lanes work on, from `lane` on, of the first entry. */
void replay_bases(const struct replay *replay, uint8_t *image, uint32_t lane,
                  const uint8_t *base[BASE_COUNT]);

/* Returns true if the call makes the routine compute the four lanes from `lane` on. */
bool replay_has_quad(const struct replay *replay, uint32_t lane);

/* The base that moves with the lanes, and the displacement of a row of probes from it. */
enum base replay_probe_base(enum unit unit);
int32_t replay_probe_place(const struct replay *replay, uint32_t row);
uint32_t *replay_probe_row(const struct replay *replay, uint8_t *image, uint32_t row);

/* Pixel of a lane of the first entry. */
void replay_pixel(const struct replay *replay, uint32_t lane, int32_t *x, int32_t *y);

#endif
