/* From the state to what routines are built for and called with: the keys of the three units, and the job.
 *
 * Keys are normalised: states that draw the same thing have the same keys, so that one routine serves them
 * all and no operation is generated whose result nobody reads. What is normalised and why it is exact, is
 * said where it happens. The job is filled for these keys: its dead parts are zero. */
#ifndef DRAW_DERIVE_H
#define DRAW_DERIVE_H

#include "draw/job.h"
#include "draw/raster_sample.h"
#include "draw/state.h"

#include <stdbool.h>

/* Farthest from the window's origin that a projected vertex may lie, in pixels; beyond it the clipper cuts.
 */
#define GUARD_BAND_PIXELS 16383.0

/* The keys of draws of a primitive, indexed by enum unit. */
void derive_keys(const struct state *state, enum primitive primitive, union key key[UNIT_COUNT]);

/* What a draw of these is for setup, with the fill mode of triangles. */
enum primitive derive_primitive(const struct state *state, enum triptych_primitive primitive);

/* How the rasterizer covers them, and the bits of clip codes that count for nothing: all but those that keep
 * positions finite and in reach while clipping is off. */
enum raster_shape derive_shape(enum primitive primitive);
uint32_t derive_clip_ignored(const struct state *state);

/* Whether lines draw their last pixel, and whether triangles have one colour. */
bool derive_last_pixel(const struct state *state);

/* The slots of texture coordinates that take the shorter way around (struct draw). */
uint64_t derive_wrapped(const struct state *state, const struct pixel_key *pixel);
bool derive_flat(const struct state *state);

/* Whether a draw with this key can change the target at all. */
bool derive_effective(const struct pixel_key *key);

/* What input v# of the vertex shader reads, or null if nothing is declared with its usage. */
const struct state_element *derive_input(const struct state *state, const struct vertex_key *key,
                                         unsigned number);

/* What is derived together: the parts of the job, what of a draw is neither key nor job, and the keys. */
enum derived_part {
#define JOB_PART(name, keys, first, last, meaning) PART_##name,
#include "def/job_part.def"
#undef JOB_PART
    JOB_PARTS,
    PART_SETTING = JOB_PARTS, /* struct draw: how it is covered and clipped */
    PART_VERTICES,            /* how many vertices there are */
    PART_KEYS,
    DERIVED_PARTS
};

/* Sets of parts have bit 1 << part. */
#define PARTS(name) (1u << PART_##name)
enum { PARTS_OF_JOB = (1 << JOB_PARTS) - 1, PARTS_ALL = (1 << DERIVED_PARTS) - 1 };

/* What is derived from a unit's key besides the state. */
unsigned derive_parts_of_key(enum unit unit);

/* The values for these keys, but for the palette and the constants of shaders. Attributes' data and stride come from the streams as bound; those of a stream
 * that steps with the instance are instance 0's, with stride 0, those of a stream without buffer null. */
void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job);

/* Derives these parts of a job anew, for keys that are those of the others. */
void derive_job_parts(const struct state *state, const struct vertex_key *vertex,
                      const struct pixel_key *pixel, unsigned parts, struct job *job);

/* What routines for these keys read of a job, as runs of bytes from its start; nobody looks at the rest. */
struct live_job {
    unsigned count;
    struct {
        uint16_t begin, end;
    } run[JOB_PARTS + 1];
};
void derive_live(const struct vertex_key *vertex, const struct pixel_key *pixel, struct live_job *live);

/* The palette of indexed vertex blending, which the caller keeps for as long as the job is used. */
void derive_palette(const struct state *state, struct palette_entry palette[WORLD_MATRICES]);

/* How draws take samples. */
struct sampling derive_sampling(const struct state *state);

/* The pixels whose centres lie inside the viewport and, if its test is on, the scissor rectangle. */
struct rectangle derive_scissor(const struct state *state);

#endif
