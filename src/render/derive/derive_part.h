/* Shared by the files that derive keys and jobs: the states' values by name, and the words they are compared
 * with.
 *
 * Every file derives one group: derive_depth.c, derive_blend.c ... fill fields of the pixel key,
 * derive_vertex.c the vertex key, derive_setup.c the setup key, derive_job.c and derive_light.c the job.
 * derive.c is what runs them. */
#ifndef RENDER_DERIVE_DERIVE_PART_H
#define RENDER_DERIVE_DERIVE_PART_H

#include "base/bits.h"
#include "contract/arguments.h"
#include "render/target/depth.h"
#include "render/derive/derive.h"
#include "render/derive/translate.h"

#include <string.h>

/* Words of def/state/value.def that the code names. */
enum {
#define VALUE(kind, word, number, support) kind##_##word = number,
#include "def/state/value.def"
#undef VALUE
};

/* Values of `state`: a render state's, sampler i's, stage i's. */
#define GET(state, name)        ((state)->value[STATE_##name])
#define SAMPLER(state, i, name) ((state)->sampler[i][SAMPLER_##name])
#define STAGE(state, i, name)   ((state)->stage[i][STAGE_##name])

#define GET_FLOAT(state, name)      bits_to_float(GET(state, name))
#define STAGE_FLOAT(state, i, name) bits_to_float(STAGE(state, i, name))

/* The bits of texturetransformflags that count. */
enum { TEXTURETRANSFORM_COUNT_MASK = 7 };

enum { MASK_RED = 1, MASK_COLOR = 7, MASK_ALPHA = 8 }; /* of a write mask */

/* Each fills its fields of a key that is zero; derive_blend takes the write mask from the state, and clears
 * the channels that keep the target. */
void derive_depth(const struct state *state, enum primitive primitive, struct pixel_key *key);
/* Write masks and storage as the targets have them, then, when it is known which of them are written, what of
 * their storage matters. */
void derive_targets(const struct state *state, struct pixel_key *key);
void derive_storage(const struct state *state, struct pixel_key *key);
void derive_blend(const struct state *state, struct pixel_key *key);
void derive_logic(const struct state *state, struct pixel_key *key);
void derive_stage(const struct state *state, struct pixel_key *key);
void derive_texture(const struct state *state, struct pixel_key *key);
/* Fills the fields of one sampler of a shader or a stage; they stay 0 where no texture is bound. */
void derive_pixel_sampler(const struct state *state, int i, struct pixel_key *key);
void derive_vertex_sampler(const struct state *state, int i, struct vertex_key *key);
void derive_fog(const struct state *state, struct pixel_key *key);
bool derive_fog_by_w(const struct state *state); /* true if the distance of a table is w, not depth */
void derive_pixel(const struct state *state, enum primitive primitive, struct pixel_key *key);
void derive_setup(const struct state *state, enum primitive primitive, const struct pixel_key *pixel,
                  struct setup_key *key);
void derive_vertex(const struct state *state, const struct pixel_key *pixel, const struct setup_key *setup,
                   struct vertex_key *key);
uint8_t derive_format(const struct state_element *element, int components);

/* The programs that a draw runs; null where it is the fixed function. */
const struct program *derive_vertex_program(const struct state *state);
const struct program *derive_pixel_program(const struct state *state);

/* The parts of keys that a shader determines (render/derive/derive_shader.c): of the vertex routine
 * everything but its varyings and clip planes, of the pixel routine stages, textures and varyings. */
void derive_vertex_shader(const struct state *state, const struct program *program,
                          const struct setup_key *setup, struct vertex_key *key);
void derive_pixel_shader(const struct state *state, const struct program *program, enum primitive primitive,
                         struct pixel_key *key);

/* The source of each component that is read. Requires the fields of varyings, channels and shaders. */
void derive_links(const struct state *state, const struct pixel_key *pixel, struct vertex_key *key);
bool derive_shader_gives(const struct program *program, unsigned usage);

/* Returns true if primitives can have a blending of their own: the state is set, and vertices have its
 * number. derive_blending_inputs derives the elements of the fixed function. */
bool derive_blends_by_primitive(const struct state *state);
void derive_blending_inputs(const struct state *state, struct vertex_key *key);

/* Which coordinate divides the others for a stage: a PROJECTED_ number. */
uint8_t derive_projection(const struct state *state, int stage);

/* The number of the TEXCOORD that comes in a channel; -1 for other usages, or none. */
int derive_channel_set(const struct state *state, const struct pixel_key *key, int channel);

/* Where pixel 0's centre is in the window of the viewport. */
static inline double pixel_centre(const struct state *state)
{
    return state->convention[TRIPTYCH_PIXEL_CENTER] == TRIPTYCH_PIXEL_CENTER_INTEGER ? 0 : 0.5;
}

/* 0xAARRGGBB with red and blue exchanged. */
static inline uint32_t rgba_word(uint32_t color)
{
    return (color & 0xff00ff00) | (color >> 16 & 255) | (color & 255) << 16;
}

/* Where the primitive's points have their size from. */
enum point_size derive_point_size(const struct state *state, enum primitive primitive);

/* The textures of the samplers that the keys use, and of the clip mask. */
void derive_texture_job(const struct state *state, const struct vertex_key *vertex,
                        const struct pixel_key *pixel, struct job *job);

/* Depth bias and point size; user clip planes, with `view_projection` as the vertex routine applies it. */
void derive_setup_job(const struct state *state, const struct vertex_key *vertex, struct job *job);
void derive_clip_planes(const struct state *state, const struct vertex_key *vertex,
                        const double view_projection[4][4], struct job *job);

/* The first stage whose coordinates come in a channel; -1 when none do. */
int derive_channel_stage(const struct pixel_key *key, int channel);

/* Returns true if a stage of a derived key passes its input through unchanged. */
bool derive_stage_passes(const struct pixel_key *key, int i);

/* Scale and offset of a fog formula for its mode, a value of kind FOGMODE. */
void derive_fog_formula(const struct state *state, uint32_t mode, bool table, float *scale, float *offset);

/* The nearest finite float: an element that overflowed must not turn zeros into NaNs. */
float derive_narrow(double value);
struct matrix;
void derive_lights(const struct state *state, const struct vertex_key *key, const struct matrix *view,
                   struct job *job);

/* All three follow derive_depth. Returns true if any pixel passes. Removes stencil. Sets the format of the
 * word, once the other fields are final. */
bool derive_passes(const struct pixel_key *key);
void derive_no_stencil(struct pixel_key *key);
void derive_depth_format(const struct state *state, struct pixel_key *key);

/* No blending: what is not written is a copy. */
void derive_no_blend(struct pixel_key *key);

#endif
