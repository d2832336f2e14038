/* Samplers: addressing and filters as the textures bound need them, the channels that coordinates come in,
 * and the textures of the job. */
#include "render/derive/derive_part.h"
#include "contract/key_query.h"

#include <math.h>

/* The first level that a sampler may sample: maxmiplevel is for mip filters. */
static uint32_t first_level(const struct state *state, int number)
{
    uint32_t last = state->texture[number]->levels - 1, first = SAMPLER(state, number, maxmiplevel);
    if (SAMPLER(state, number, mipfilter) == MIPFILTER_none)
        return 0;
    return first < last ? first : last;
}

/* The limit of OpenGL: linear magnification meets point filters of levels. */
static bool is_magnified_longer(const struct state *state, const struct sampler_key *key)
{
    return state->convention[TRIPTYCH_MAGNIFY_LIMIT] == TRIPTYCH_MAGNIFY_LIMIT_HALF &&
           key->filter == FILTER_LINEAR && SAMPLER(state, key->number, mipfilter) != MIPFILTER_none;
}

static void derive_minify(const struct state *state, struct sampler_key *key)
{
    uint32_t taps = SAMPLER(state, key->number, maxanisotropy);
    uint32_t filter = SAMPLER(state, key->number, minfilter);
    if (filter == FILTER_anisotropic && taps > 1 && key->number < PIXEL_SAMPLERS) {
        key->minify = MINIFY_ANISOTROPIC;
        key->anisotropy = (uint8_t)taps;
    } else if (derive_filter(filter) != key->filter)
        key->minify = is_magnified_longer(state, key) ? MINIFY_LATER : MINIFY_OTHER;
}

/* Without a second level that may be sampled there is nothing to choose from. */
static uint8_t derive_mip(const struct state *state, int number)
{
    if (first_level(state, number) + 1 == state->texture[number]->levels)
        return MIP_NONE;
    return derive_mip_filter(SAMPLER(state, number, mipfilter));
}

static bool is_clamped(const struct state *state, const struct triptych_texture *texture)
{
    return texture->type == TRIPTYCH_TEXTURE_CUBE &&
           state->convention[TRIPTYCH_CUBE_ADDRESS] == TRIPTYCH_CUBE_ADDRESS_CLAMP;
}

static void derive_addresses(const struct state *state, struct sampler_key *key)
{
    int number = key->number;
    const struct triptych_texture *texture = state->texture[number];
    const struct texture_level *level = &texture->level[0];
    if (is_clamped(state, texture)) {
        key->address[0] = key->address[1] = ADDRESS_CLAMP;
        return;
    }
    if (!key->mip)
        level = &texture->level[first_level(state, number)];
    key->address[0] = derive_address(SAMPLER(state, number, addressu), (uint32_t)level->width);
    key->address[1] = derive_address(SAMPLER(state, number, addressv), (uint32_t)level->height);
    if (texture->type == TRIPTYCH_TEXTURE_VOLUME)
        key->address[2] = derive_address(SAMPLER(state, number, addressw), (uint32_t)level->depth);
}

/* sRGB is for texels of bytes; others are linear. */
static uint8_t derive_texel(const struct state *state, int number)
{
    const struct format *format = state->texture[number]->format;
    if (format->storage == STORAGE_RGBA8)
        return SAMPLER(state, number, srgbtexture) ? TEXEL_SRGB : TEXEL_BYTES;
    return format->roles & ROLE_COMPARE ? TEXEL_COMPARE : TEXEL_FLOATS;
}

/* All zero but for the number where nothing is bound. */
static struct sampler_key derive_sampler(const struct state *state, int number)
{
    struct sampler_key key = {.number = (uint8_t)number};
    if (!state->texture[number])
        return key;
    key.kind = (uint8_t)(TEXTURE_2D + state->texture[number]->type);
    key.texel = derive_texel(state, number);
    key.compact = state->texture[number]->format->compact;
    key.tiled = state->texture[number]->tiled;
    key.filter = derive_filter(SAMPLER(state, number, magfilter));
    derive_minify(state, &key);
    key.mip = derive_mip(state, number);
    derive_addresses(state, &key);
    return key;
}

void derive_pixel_sampler(const struct state *state, int i, struct pixel_key *key)
{
    struct sampler_key sampler = derive_sampler(state, i);
    key->texture[i] = sampler.kind;
    key->texel[i] = sampler.texel;
    key->compact[i] = sampler.compact;
    key->tiled[i] = sampler.tiled;
    key->filter[i] = sampler.filter;
    key->minify[i] = sampler.minify;
    key->mip[i] = sampler.mip;
    key->anisotropy[i] = sampler.anisotropy;
    key->address_u[i] = sampler.address[0];
    key->address_v[i] = sampler.address[1];
    key->address_w[i] = sampler.address[2];
}

void derive_vertex_sampler(const struct state *state, int i, struct vertex_key *key)
{
    struct sampler_key sampler = derive_sampler(state, PIXEL_SAMPLERS + i);
    key->texture[i] = sampler.kind;
    key->texel[i] = sampler.texel;
    key->compact[i] = sampler.compact;
    key->tiled[i] = sampler.tiled;
    key->filter[i] = sampler.filter;
    key->minify[i] = sampler.minify;
    key->mip[i] = sampler.mip;
    key->address_u[i] = sampler.address[0];
    key->address_v[i] = sampler.address[1];
    key->address_w[i] = sampler.address[2];
}

/* With a matrix a stage has coordinates of its own, and vertex shaders give each stage its own. */
static bool same_coordinates(const struct state *state, int a, int b)
{
    if (derive_vertex_program(state))
        return false;
    uint32_t flags = STAGE(state, a, texturetransformflags);
    return STAGE(state, a, texcoordindex) == STAGE(state, b, texcoordindex) &&
           flags == STAGE(state, b, texturetransformflags) && !(flags & TEXTURETRANSFORM_COUNT_MASK);
}

/* Returns true if the coordinates of a stage are the three numbers of an attribute. Vertices in the window
 * have no generators. */
static bool has_three(const struct state *state, int stage)
{
    uint32_t index = STAGE(state, stage, texcoordindex);
    const struct state_element *element = &state->element[ATTRIBUTE_TEXCOORD + (index & (TEXCOORD_SETS - 1))];
    bool window = state->element[ATTRIBUTE_POSITIONT].format != TRIPTYCH_FORMAT_NONE;
    return (window || !(index >> 16)) && key_vertex_types[element->format].components == 3;
}

/* The last of three or four coordinates divides the others (Direct3D 9, D3DTTFF_PROJECTED); without a count
 * it is the last that vertices have, after a vertex shader always the fourth. With one or two coordinates
 * nothing is left to be divided. */
uint8_t derive_projection(const struct state *state, int stage)
{
    uint32_t flags = STAGE(state, stage, texturetransformflags), count = flags & TEXTURETRANSFORM_COUNT_MASK;
    if (!(flags & TEXTURETRANSFORM_disable_projected))
        return PROJECTED_NONE;
    if (derive_vertex_program(state))
        return PROJECTED_FOURTH;
    if (count && count < 3)
        return PROJECTED_NONE;
    return count == 3 || (!count && has_three(state, stage)) ? PROJECTED_THIRD : PROJECTED_FOURTH;
}

/* Stages with the same coordinates share a channel; channels are numbered in the order of their first stages.
 */
static void derive_channel(const struct state *state, int stage, struct pixel_key *key)
{
    uint8_t next = 0;
    for (int i = 0; i < stage; i++) {
        if (!key->texture[i])
            continue;
        if (same_coordinates(state, i, stage)) {
            key->coordinates[stage] = key->coordinates[i];
            return;
        }
        if (key->coordinates[i] >= next)
            next = key->coordinates[i] + 1;
    }
    key->coordinates[stage] = next;
    key->varying[varying_texcoord(next)] = INTERPOLATION_SMOOTH;
    if (derive_projection(state, stage) != PROJECTED_NONE)
        key->varying[varying_divisor(next)] = INTERPOLATION_SMOOTH;
}

/* For the stage itself, or for the one after it. */
static bool needs_texture(const struct pixel_key *key, int i)
{
    return stage_reads(key, i, SOURCE_TEXTURE) || key->premodulate[i] ||
           (i + 1 < key->stages && key->bump[i + 1]);
}

void derive_texture(const struct state *state, struct pixel_key *key)
{
    for (int i = key->stages - 1; i >= 0; i--)
        if (!needs_texture(key, i))
            key->bump[i] = BUMP_NONE;
    for (int i = 0; i < key->stages; i++) {
        key->float_color |= key->bump[i] != BUMP_NONE;
        if (!needs_texture(key, i))
            continue;
        derive_pixel_sampler(state, i, key);
        key->float_color |= key->texel[i] != TEXEL_BYTES;
        derive_channel(state, i, key);
        if (key->texture[i] != TEXTURE_2D || key->texel[i] == TEXEL_COMPARE)
            key->varying[varying_third(key->coordinates[i])] = INTERPOLATION_SMOOTH;
    }
}

int derive_channel_stage(const struct pixel_key *key, int channel)
{
    for (int i = 0; i < key->stages; i++)
        if (key->texture[i] && key->coordinates[i] == channel)
            return i;
    return -1;
}

/* Direct3D 9's WRAP states by set of coordinates; only shaders have sets from 8 on. */
static uint32_t wrapped_coordinates(const struct state *state, uint32_t set)
{
    static const uint8_t row[TRIPTYCH_USAGE_INDICES] = {
        TRIPTYCH_STATE_WRAP0,  TRIPTYCH_STATE_WRAP1,  TRIPTYCH_STATE_WRAP2,  TRIPTYCH_STATE_WRAP3,
        TRIPTYCH_STATE_WRAP4,  TRIPTYCH_STATE_WRAP5,  TRIPTYCH_STATE_WRAP6,  TRIPTYCH_STATE_WRAP7,
        TRIPTYCH_STATE_WRAP8,  TRIPTYCH_STATE_WRAP9,  TRIPTYCH_STATE_WRAP10, TRIPTYCH_STATE_WRAP11,
        TRIPTYCH_STATE_WRAP12, TRIPTYCH_STATE_WRAP13, TRIPTYCH_STATE_WRAP14, TRIPTYCH_STATE_WRAP15};
    return state->value[row[set % TRIPTYCH_USAGE_INDICES]];
}

/* The set that a channel's coordinates wrap by: the texcoord of a shader, or that of the vertex. */
static int wrapped_set(const struct state *state, const struct pixel_key *pixel, int channel)
{
    int set = derive_channel_set(state, pixel, channel);
    if (set < 0 || set >= TEXTURE_STAGES || derive_vertex_program(state))
        return set;
    return (int)(STAGE(state, set, texcoordindex) & (TEXCOORD_SETS - 1));
}

/* A stage's fourth coordinate is a divisor, and what is divided does not turn around; shaders have four
 * like any. */
uint64_t derive_wrapped(const struct state *state, const struct pixel_key *pixel)
{
    uint64_t slots = 0;
    bool shader = key_program(pixel->shader) != 0;
    for (int channel = 0; channel < TEXTURE_STAGES; channel++) {
        int set = wrapped_set(state, pixel, channel);
        if (set < 0 || (!shader && pixel->varying[varying_divisor(channel)]))
            continue;
        uint64_t bits = wrapped_coordinates(state, (uint32_t)set);
        slots |= (bits & 3) << varying_slot[varying_texcoord(channel)];
        slots |= (bits >> 2 & 1) << varying_slot[varying_third(channel)];
        slots |= (bits >> 3 & shader) << varying_slot[varying_divisor(channel)];
    }
    return slots;
}

/* --- The job --- */

/* Positions are measured in 1/256 texels of the level whose size is in the job: 8 levels more than texels of
 * it, and that level's number more than those of the first. */
static void fill_detail(const struct state *state, const struct sampler_key *key, struct texture_job *job)
{
    const struct triptych_texture *texture = state->texture[key->number];
    uint32_t first = first_level(state, key->number);
    float bias = bits_to_float(SAMPLER(state, key->number, mipmaplodbias));
    bias = fminf(fmaxf(bias, -LOD_BIAS_MAXIMUM), LOD_BIAS_MAXIMUM);
    job->lod_bias_256 = 256 * bias;
    job->lod_offset = 256 * bias - 256 * 8 + (key->mip ? 0 : 256 * (float)first);
    if (!key->mip)
        return;
    job->levels = texture->level;
    job->first_level_256 = 256 * (int32_t)first;
    job->last_level_256 = 256 * (int32_t)(texture->levels - 1);
}

static void fill_texture(const struct state *state, struct sampler_key key, struct texture_job *job)
{
    const struct triptych_texture *texture = state->texture[key.number];
    uint32_t first = first_level(state, key.number);
    const struct texture_level *level = &texture->level[key.mip ? 0 : first];
    job->texels = key.mip ? texture->texels : texture_level_texels(texture, 0, first);
    job->width = level->width;
    job->height = level->height;
    job->width_256 = (float)(level->width * 256);
    job->height_256 = (float)(level->height * 256);
    job->last_u = job->width - 1;
    job->last_v = job->height - 1;
    job->pitch = level->pitch;
    job->last_u_256 = job->last_u * 256;
    job->last_v_256 = job->last_v * 256;
    if (memchr(key.address, ADDRESS_BORDER, sizeof key.address))
        job->border = rgba_word(SAMPLER(state, key.number, bordercolor));
    if (key.kind == TEXTURE_CUBE)
        job->face_texels = (int32_t)texture->face_texels;
    if (key.kind == TEXTURE_VOLUME) {
        job->depth = level->depth;
        job->depth_256 = (float)(level->depth * 256);
        job->last_w = job->depth - 1;
        job->last_w_256 = job->last_w * 256;
        job->slice_texels = level->slice_texels;
    }
    if (key.mip || key.minify)
        fill_detail(state, &key, job);
}

static void fill_clip_mask(const struct state *state, struct clip_mask_job *job)
{
    const struct triptych_clip_mask *mask = &state->clip_mask;
    const struct texture_level *level = mask->texture->level;
    job->texels = texture_level_texels(mask->texture, 0, 0);
    job->x = mask->x;
    job->y = mask->y;
    job->last_u = level->width - 1;
    job->last_v = level->height - 1;
    job->pitch = level->pitch;
}

/* Samplers that the key does not use are not read. */
void derive_texture_job(const struct state *state, const struct vertex_key *vertex,
                        const struct pixel_key *pixel, struct job *job)
{
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        if (pixel->texture[i])
            fill_texture(state, pixel_sampler(pixel, i), &job->texture[i]);
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        if (vertex->texture[i])
            fill_texture(state, vertex_sampler(vertex, i), &job->texture[PIXEL_SAMPLERS + i]);
    if (pixel->clip_mask)
        fill_clip_mask(state, &job->clip_mask);
}
