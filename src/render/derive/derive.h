/* From the state to the keys of the three units, for which routines are built, and to the job, with which
 * they are called.
 *
 * Keys are normalised: states that draw the same have the same keys, so one routine serves them all, and
 * no operation is generated whose result is not read. The comments of the files explain each normalisation
 * and why it is exact. The job is filled in for these keys: parts that they do not use are zero. */
#ifndef RENDER_DERIVE_DERIVE_H
#define RENDER_DERIVE_DERIVE_H

#include "contract/job.h"
#include "render/raster/raster_sample.h"
#include "render/state/state.h"

#include <stdbool.h>

/* Farthest from the window's origin that a projected vertex may lie, in pixels; beyond it the clipper cuts.
 */
#define GUARD_BAND_PIXELS 16383.0

enum { LINE_WIDTH_MAXIMUM = 255 };

/* The keys of draws of a primitive, indexed by enum unit. */
void derive_keys(const struct state *state, enum primitive primitive, union key key[UNIT_COUNT]);

/* The primitive that setup processes, given the one that is drawn and the fill mode. */
enum primitive derive_primitive(const struct state *state, enum triptych_primitive primitive);

/* How the rasterizer covers them, and the bits of clip codes that count for nothing: all but those that keep
 * positions finite and in reach while clipping is off. */
enum raster_shape derive_shape(const struct setup_key *key);
uint32_t derive_clip_ignored(const struct state *state);

/* Returns true if lines draw their last pixel. */
bool derive_last_pixel(const struct state *state);
/* Pixels across a line beyond the first. */
uint32_t derive_line_extra(const struct state *state);
/* The width of smooth lines in 1/256 pixel; edges of triangles have 1 pixel. */
uint32_t derive_line_width(const struct state *state, enum primitive primitive);

/* Returns true if primitives are smooth: a state enables it, and a pixel has one sample. */
bool derive_smooth(const struct state *state, enum primitive primitive);
/* The edges of triangles that are, and the element with masks of them, or null. */
uint32_t derive_edges(const struct state *state);
const struct state_element *derive_edge_masks(const struct state *state);

/* The slots of texture coordinates that take the shorter way around (struct draw). */
uint64_t derive_wrapped(const struct state *state, const struct pixel_key *pixel);
bool derive_flat(const struct state *state);
bool derive_last_provokes(const struct state *state);

/* Returns true if pixels read no interpolated varying but texture coordinates, which choose texels and do
 * nothing else. The bits of samplers[c] are the samplers that use the coordinates of channel c. Their texel
 * depends only on the coordinates' positions in 24.8 fixed point (spec/texture/address.h). */
bool derive_lookups(const struct pixel_key *key, uint16_t samplers[TEXTURE_STAGES]);

/* Returns true if a draw with this key can change the target. */
bool derive_effective(const struct pixel_key *key);

/* Where an element lies in memory, for instance 0; as in derive_job. */
struct attribute_job derive_element(const struct state *state, const struct state_element *element);

/* The element that input v# of the vertex shader reads, or null if none is declared with its usage. */
const struct state_element *derive_input(const struct state *state, const struct vertex_key *key,
                                         unsigned number);

/* The units of derivation: the parts of the job, the rest of a draw, the vertices, and the keys. */
enum derived_part {
#define JOB_PART(name, keys, first, last, meaning) PART_##name,
#include "def/job_part.def"
#undef JOB_PART
    JOB_PARTS,
    PART_AREA = JOB_PARTS, /* struct draw: the pixels that it may reach */
    PART_VERTICES,         /* how many vertices there are */
    PART_KEYS, /* and what of struct draw follows from their source (render/device/key_source.h) */
    DERIVED_PARTS
};

/* Sets of parts have bit 1 << part. */
#define PARTS(name) (1u << PART_##name)
enum { PARTS_OF_JOB = (1 << JOB_PARTS) - 1, PARTS_ALL = (1 << DERIVED_PARTS) - 1 };

/* The parts of the job, and others, that depend on a unit's key besides the state. */
unsigned derive_parts_of_key(enum unit unit);

/* The values for these keys, but for the palette and the constants of shaders. Attributes' data and stride
 * come from the streams as bound; those of a stream that steps with the instance are instance 0's, with
 * stride 0, those of a stream without buffer null. */
void derive_job(const struct state *state, const struct vertex_key *vertex, const struct pixel_key *pixel,
                struct job *job);

/* Derives these parts of a job anew, for keys that are those of the others. */
void derive_job_parts(const struct state *state, const struct vertex_key *vertex,
                      const struct pixel_key *pixel, unsigned parts, struct job *job);

/* The bytes of a job that the routines for these keys read, as runs from its start. */
struct live_job {
    unsigned count;
    struct {
        uint16_t begin, end;
    } run[JOB_PARTS + 1];
};
void derive_live(const struct vertex_key *vertex, const struct pixel_key *pixel, struct live_job *live);

/* The key of a vertex routine that computes all its outputs, whatever the pixel routine reads, and its job
 * but for the palette and the constants of the shader. */
void derive_process_key(const struct state *state, struct vertex_key *key);
void derive_process_job(const struct state *state, const struct vertex_key *key, struct job *job);

/* The palette of indexed vertex blending, which the caller keeps for as long as the job is used. */
void derive_palette(const struct state *state, struct palette_entry palette[WORLD_MATRICES]);

/* How draws take samples. */
struct sampling derive_sampling(const struct state *state);

/* 1 if the window's y grows with that of clip space, else -1. */
static inline double derive_window_up(const struct state *state)
{
    return state->convention[TRIPTYCH_WINDOW_ORIGIN] == TRIPTYCH_WINDOW_ORIGIN_LOWER ? 1 : -1;
}

/* The pixels that primitives can be drawn to, within the clip mask, and the bits of the clip code with which
 * a point is not drawn. */
struct rectangle derive_pixels(const struct state *state, enum primitive primitive);
uint32_t derive_point_clipped(const struct state *state, enum primitive primitive);
/* Returns true if draws have a clip mask. */
static inline bool derive_has_clip_mask(const struct state *state)
{
    return state->clip_mask.texture && state->clip_mask.box.width && state->clip_mask.box.height;
}

/* The pixels whose centres lie inside the viewport and, if its test is on, the scissor rectangle. With
 * `everywhere` the viewport does not limit them. */
struct rectangle derive_area(const struct state *state, bool everywhere);

#endif
