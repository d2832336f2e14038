/* Questions about keys: what a routine of this key reads, writes and discards. */
#ifndef CONTRACT_KEY_QUERY_H
#define CONTRACT_KEY_QUERY_H

#include "contract/key.h"

/* --- Texture stages and samplers ------------------------------------------------------------------------ */

/* A stage's arguments: 1, 2 and 0. */
static inline const uint8_t *color_arguments(const struct pixel_key *key, int stage)
{
    return key->color_argument + STAGE_ARGUMENTS * stage;
}
static inline const uint8_t *alpha_arguments(const struct pixel_key *key, int stage)
{
    return key->alpha_argument + STAGE_ARGUMENTS * stage;
}

/* Returns true if the stage treats alpha like a fourth channel of colour. */
bool stage_is_joint(const struct pixel_key *key, int stage);

/* Returns true if the stage reads the source. */
bool stage_reads(const struct pixel_key *key, int stage, enum source source);

/* Sampler i of pixels: texture stage i's, or s# of a pixel shader. */
static inline struct sampler_key pixel_sampler(const struct pixel_key *key, int i)
{
    return (struct sampler_key){
        .number = (uint8_t)i,
        .kind = key->texture[i],
        .texel = key->texel[i],
        .compact = key->compact[i],
        .tiled = key->tiled[i],
        .filter = key->filter[i],
        .minify = key->minify[i],
        .mip = key->mip[i],
        .anisotropy = key->anisotropy[i],
        .address = {key->address_u[i], key->address_v[i], key->address_w[i]},
    };
}

/* Sampler i of vertices: s# of a vertex shader. Vertices have no neighbours, so there is no anisotropic
 * filter. */
static inline struct sampler_key vertex_sampler(const struct vertex_key *key, int i)
{
    return (struct sampler_key){
        .number = (uint8_t)(PIXEL_SAMPLERS + i),
        .kind = key->texture[i],
        .texel = key->texel[i],
        .compact = key->compact[i],
        .tiled = key->tiled[i],
        .filter = key->filter[i],
        .minify = key->minify[i],
        .mip = key->mip[i],
        .address = {key->address_u[i], key->address_v[i], key->address_w[i]},
    };
}

/* --- Smooth primitives ---------------------------------------------------------------------------------- */

/* How records are covered; pixel keys have it as a field. */
static inline enum coverage_form setup_coverage(const struct setup_key *key)
{
    if (!key->smooth)
        return COVERAGE_NONE;
    if (key->primitive == PRIMITIVE_TRIANGLE)
        return COVERAGE_EDGES;
    return primitive_is_point(key->primitive) ? COVERAGE_POINT : COVERAGE_LINE;
}

/* --- What the pixel routine writes ---------------------------------------------------------------------- */

/* The channels that reach any target. */
static inline int pixel_write_mask(const struct pixel_key *key)
{
    int mask = 0;
    for (int t = 0; t < TARGETS; t++)
        mask |= key->write_mask[t];
    return mask;
}

/* Returns true if the pixel routine compares or writes depth. */
static inline bool pixel_tests_depth(const struct pixel_key *key)
{
    return key->depth_function != COMPARE_ALWAYS || key->depth_write;
}

/* The number of stencil tests: the key's, or none if the depth format has no stencil bits. */
static inline int pixel_stencil(const struct pixel_key *key)
{
    bool room = key->depth_format == DEPTH_UNORM || key->depth_format == DEPTH_FLOAT24;
    return room ? key->stencil : STENCIL_OFF;
}

/* Returns true if a side has an operation other than KEEP. */
static inline bool stencil_side_changes(const struct pixel_key *key, int side)
{
    return key->stencil_fail[side] || key->stencil_depth_fail[side] || key->stencil_pass[side];
}

static inline bool pixel_writes_stencil(const struct pixel_key *key)
{
    bool writes = false;
    for (int i = 0; i < pixel_stencil(key); i++)
        writes |= stencil_side_changes(key, i);
    return writes;
}

/* Returns true if the pixel routine leaves any result other than colour. */
static inline bool pixel_leaves_traces(const struct pixel_key *key)
{
    return key->depth_write || key->count || pixel_writes_stencil(key);
}

/* Returns true if the first colour's alpha decides what remains. */
static inline bool pixel_tests_alpha(const struct pixel_key *key)
{
    return key->alpha_discard || key->alpha_coverage;
}

/* Returns true if shading discards pixels or samples. */
static inline bool pixel_discards(const struct pixel_key *key)
{
    return pixel_tests_alpha(key) || key->kills;
}

/* Returns true if the depth and stencil tests must wait for shading. */
static inline bool pixel_waits(const struct pixel_key *key)
{
    return pixel_discards(key) || key->depth_output || key->late;
}

/* Returns true if the pixel routine computes colours: to write them, or because they decide which pixels
 * remain or how deep they are. */
static inline bool pixel_shades(const struct pixel_key *key)
{
    return pixel_write_mask(key) || (pixel_waits(key) && pixel_leaves_traces(key));
}

/* Returns true if alpha is blended differently from colour. */
static inline bool blend_is_separate(const struct pixel_key *key)
{
    return key->blend[BLEND_COLOR] != key->blend[BLEND_ALPHA] ||
           key->source_factor[BLEND_COLOR] != key->source_factor[BLEND_ALPHA] ||
           key->target_factor[BLEND_COLOR] != key->target_factor[BLEND_ALPHA];
}

/* Returns true if blending reads the second colour, which is then not the second target's. */
static inline bool blend_reads_second(const struct pixel_key *key)
{
    bool reads = false;
    for (int c = 0; c < BLEND_CHANNELS; c++)
        reads |= factor_is_second(key->source_factor[c]) || factor_is_second(key->target_factor[c]);
    return reads;
}

/* Returns true if primitives can have a blending of their own. */
static inline bool pixel_blends_by_primitive(const struct pixel_key *key)
{
    return key->varying[VARYING_blending] != INTERPOLATION_NONE;
}

/* Returns true if colour t of a pixel is written to target t, or is the second colour. */
static inline bool pixel_uses_color(const struct pixel_key *key, int t)
{
    return key->write_mask[t] || (t == 1 && blend_reads_second(key));
}

/* The same, or colour 0 decides which pixels remain. */
static inline bool pixel_has_color(const struct pixel_key *key, int t)
{
    return pixel_uses_color(key, t) || (t == 0 && pixel_tests_alpha(key));
}

/* Returns true if the target stores codes, on which the key's logic operation works. */
static inline bool logic_operates(const struct pixel_key *key, int target)
{
    return key->logic != LOGIC_COPY && storage_bits[target][0] && target != TARGET_SRGB;
}

/* Returns true if a result of the pixel routine depends on the new colour. */
static inline bool pixel_reads_color(const struct pixel_key *key)
{
    bool ignored = key->logic == LOGIC_CLEAR || key->logic == LOGIC_SET || key->logic == LOGIC_INVERT;
    bool reads = pixel_discards(key) || key->depth_output;
    for (int t = 0; t < TARGETS; t++)
        reads |= key->write_mask[t] && !(ignored && logic_operates(key, key->target[t]));
    return reads;
}

/* --- What it reads -------------------------------------------------------------------------------------- */

static inline bool fog_reads_depth(int fog)
{
    return fog >= FOG_LINEAR_Z && fog <= FOG_EXP2_Z;
}

/* Returns true if the pixel routine reads the triangle's depth. */
static inline bool pixel_reads_depth(const struct pixel_key *key)
{
    bool tested = pixel_tests_depth(key) && !key->depth_w && !key->depth_output;
    return tested || (pixel_shades(key) && (fog_reads_depth(key->fog) || key->place & PLACE_DEPTH));
}

/* Returns true if the pixel routine reads w for more than interpolation. */
static inline bool pixel_reads_w(const struct pixel_key *key)
{
    bool tested = pixel_tests_depth(key) && key->depth_w && !key->depth_output;
    return tested || (pixel_shades(key) && (key->fog >= FOG_LINEAR_W || key->place & PLACE_W));
}

#endif
