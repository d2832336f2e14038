/* Shared by the files that derive keys and jobs: the states' values by name, and the words they are compared
 * with.
 *
 * Every file derives one group: derive_depth.c, derive_blend.c ... fill fields of the pixel key,
 * derive_vertex.c the vertex key, derive_setup.c the setup key, derive_job.c and derive_light.c the job.
 * derive.c is what runs them. */
#ifndef DRAW_DERIVE_PART_H
#define DRAW_DERIVE_PART_H

#include "draw/call.h"
#include "draw/depth.h"
#include "draw/derive.h"

#include <string.h>

/* Words of def/value.def that the code names. */
enum {
#define VALUE(kind, word, number, support) kind##_##word = number,
#include "def/value.def"
#undef VALUE
};

/* Values of `state`: a render state's, sampler i's, stage i's. */
#define GET(name)        (state->value[TRIPTYCH_STATE_##name])
#define SAMPLER(i, name) (state->sampler[i][TRIPTYCH_SAMPLER_##name])
#define STAGE(i, name)   (state->stage[i][TRIPTYCH_STAGE_##name])

/* A state whose value is a binary32. */
static inline float state_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#define GET_FLOAT(name)      state_float(GET(name))
#define STAGE_FLOAT(i, name) state_float(STAGE(i, name))

/* The bits of texturetransformflags that count. */
enum { TEXTURETRANSFORM_COUNT_MASK = 7 };

enum { MASK_COLOR = 7, MASK_ALPHA = 8 }; /* of a write mask */

/* Each fills its fields of a key that is zero; derive_blend takes the write mask from the state, and clears
 * the channels that keep the target. */
void derive_depth(const struct state *state, enum primitive primitive, struct pixel_key *key);
/* Write masks and storage as the targets have them, then, when it is known which of them are written, what of
 * their storage matters. */
void derive_targets(const struct state *state, struct pixel_key *key);
void derive_storage(const struct state *state, struct pixel_key *key);
void derive_blend(const struct state *state, struct pixel_key *key);
void derive_stage(const struct state *state, struct pixel_key *key);
void derive_texture(const struct state *state, struct pixel_key *key);
/* Fills the fields of one sampler of a shader or a stage; they stay 0 where no texture is bound. */
void derive_pixel_sampler(const struct state *state, int i, struct pixel_key *key);
void derive_vertex_sampler(const struct state *state, int i, struct vertex_key *key);
uint32_t derive_first_level(const struct state *state, int number); /* that the sampler may sample */
void derive_fog(const struct state *state, struct pixel_key *key);
void derive_pixel(const struct state *state, enum primitive primitive, struct pixel_key *key);
void derive_setup(const struct state *state, enum primitive primitive, const struct pixel_key *pixel,
                  struct setup_key *key);
void derive_vertex(const struct state *state, const struct pixel_key *pixel, const struct setup_key *setup,
                   struct vertex_key *key);
uint8_t derive_format(const struct state_element *element, int components);

/* The programs that a draw runs; null where it is the fixed function. */
const struct program *derive_vertex_program(const struct state *state);
const struct program *derive_pixel_program(const struct state *state);

/* What shaders take the place of (derive_shader.c): the vertex routine but for its varyings and clip planes, and in the
 * pixel routine stages, textures and varyings. */
void derive_vertex_shader(const struct state *state, const struct program *program,
                          const struct setup_key *setup, struct vertex_key *key);
void derive_pixel_shader(const struct state *state, const struct program *program, enum primitive primitive,
                         struct pixel_key *key);

/* Where each component that is read comes from; behind what is said of varyings, channels and shaders. */
void derive_links(const struct state *state, const struct pixel_key *pixel, struct vertex_key *key);
bool derive_shader_gives(const struct program *program, unsigned usage);

/* Which coordinate divides the others for a stage: a PROJECTED_ number. */
uint8_t derive_projection(const struct state *state, int stage);

/* The number of the TEXCOORD that comes in a channel; -1 for other usages, or none. */
int derive_channel_set(const struct state *state, const struct pixel_key *key, int channel);

/* Where pixel 0's centre is in the window of the viewport. */
static inline double pixel_centre(const struct state *state)
{
    return state->convention[TRIPTYCH_PIXEL_CENTER] == TRIPTYCH_PIXEL_CENTER_INTEGER ? 0 : 0.5;
}

/* Where the primitive's points have their size from. */
enum point_size derive_point_size(const struct state *state, enum primitive primitive);

/* Depth bias and point size; user clip planes, with `view_projection` as the vertex routine applies it. */
void derive_setup_job(const struct state *state, const struct vertex_key *vertex, struct job *job);
void derive_clip_planes(const struct state *state, const struct vertex_key *vertex,
                        const double view_projection[4][4], struct job *job);

/* The first stage whose coordinates come in a channel; -1 when none do. */
int derive_channel_stage(const struct pixel_key *key, int channel);

/* Whether a stage of a derived key leaves everything as it is. */
bool derive_stage_passes(const struct pixel_key *key, int i);

/* Scale and offset of a fog formula for its mode, a value of kind FOGMODE. */
void derive_fog_formula(const struct state *state, uint32_t mode, float *scale, float *offset);

/* The nearest finite float: an element that overflowed must not turn zeros into NaNs. */
float derive_narrow(double value);
struct matrix;
void derive_lights(const struct state *state, const struct vertex_key *key, const struct matrix *view,
                   struct job *job);

/* Behind derive_depth: whether any pixel passes; no stencil; the word's format, when the rest is known. */
bool derive_passes(const struct pixel_key *key);
void derive_no_stencil(struct pixel_key *key);
void derive_depth_format(const struct state *state, struct pixel_key *key);

/* No blending: what is not written is a copy. */
void derive_no_blend(struct pixel_key *key);

#endif
