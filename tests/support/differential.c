#include "differential.h"

#include "base/srgb.h"
#include "fence.h"

#include "draw/depth.h"
#include "tests/support/programs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xmmintrin.h>

enum {
    STRIDE_MAXIMUM = 44, /* bytes between two vertices of a stream */
    FETCH_MAXIMUM = 16,
    CONSTANT_BYTES = 16 * (256 + 1 + 16),
    STREAM_BYTES = VERTEX_CAPACITY * STRIDE_MAXIMUM + FETCH_MAXIMUM + 4,
    TEXTURE_SIDE = 64,
    SMALL_SIDE = 16,
    LEVELS = 7,
    TEXTURE_BYTES = TEXTURE_SIDE * TEXTURE_SIDE * 4 * 6 * 2, /* a cube with its levels */
    PALETTE_BYTES = WORLD_MATRICES * sizeof(struct palette_entry),
    RECORD_MAXIMUM = 256,
    TRIANGLES = 32,
    ENTRIES = 48,
    TARGET_PLANES = 4 * SAMPLES_MAXIMUM, /* of one target with samples, or of all without */
    UNTOUCHED = 0x5a
};

/* What a routine may write, and what it must not: all of it is compared. */
struct outputs {
    alignas(64) uint8_t before[64];
    alignas(64) float vertices[SLOT_COUNT * VERTEX_CAPACITY];
    alignas(64) uint8_t records[SETUP_CAPACITY * RECORD_MAXIMUM];
    alignas(64) uint32_t color[TARGET_PLANES * TILE_PIXELS];
    alignas(64) uint32_t depth[SAMPLES_MAXIMUM * TILE_PIXELS];
    alignas(64) uint8_t lanes[4 + sizeof(struct lane_table)];
    alignas(64) uint8_t behind[64];
};

struct differential {
    struct code_arena *arena;
    uint64_t seed;
    int wild;
    uint32_t count; /* of the call */
    struct triangle_layout layout;
    struct job job;
    uint8_t *stream[ATTRIBUTE_COUNT]; /* fenced */
    uint8_t *texels;                  /* fenced */
    struct texture_level levels[SAMPLERS][LEVELS];
    uint8_t *palette;   /* fenced */
    uint8_t *constants; /* fenced */
    alignas(64) uint32_t index_words[1 + SETUP_INDEX_ROWS * SETUP_CAPACITY];
    struct entry_list entries;
    alignas(64) uint8_t triangles[TRIANGLES * RECORD_MAXIMUM];
    struct outputs initial, result[2];
    char message[KEY_TEXT_CAPACITY + 256];
};

struct differential *differential_create(struct code_arena *arena)
{
    struct differential *d = aligned_alloc(64, (sizeof *d + 63) / 64 * 64);
    if (!d)
        return NULL;
    memset(d, 0, sizeof *d);
    d->arena = arena;
    d->texels = fence(TEXTURE_BYTES);
    d->palette = fence(PALETTE_BYTES);
    d->constants = fence(CONSTANT_BYTES);
    int complete = d->texels && d->palette && d->constants;
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        complete &= (d->stream[a] = fence(STREAM_BYTES)) != NULL;
    if (complete)
        return d;
    differential_destroy(d);
    return NULL;
}

void differential_destroy(struct differential *d)
{
    if (!d)
        return;
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        unfence(d->stream[a], STREAM_BYTES);
    unfence(d->texels, TEXTURE_BYTES);
    unfence(d->palette, PALETTE_BYTES);
    unfence(d->constants, CONSTANT_BYTES);
    free(d);
}

/* --- Random values --- */

static uint32_t word(struct differential *d)
{
    d->seed ^= d->seed >> 12;
    d->seed ^= d->seed << 25;
    d->seed ^= d->seed >> 27;
    return (uint32_t)(d->seed * 0x2545f4914f6cdd1dull >> 32);
}

static uint32_t below(struct differential *d, uint32_t limit)
{
    return word(d) % limit;
}

static float between(struct differential *d, float low, float high)
{
    return low + (high - low) * (float)(word(d) >> 8) * 0x1p-24f;
}

static float special(struct differential *d)
{
    static const uint32_t edges[] = {0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007fffff, 0x00800000,
                                     0x7f7fffff, 0xff7fffff, 0x7f800000, 0xff800000, 0x7fc00000, 0xffc12345,
                                     0x7f800001, 0x3f800000, 0xbf800000, 0x3f000000, 0x4b000000, 0x4f000000,
                                     0xcf000000, 0x5f000000, 0x34000000, 0x2b800000, 0x7149f2ca};
    uint32_t bits = below(d, 8) ? edges[below(d, sizeof edges / sizeof *edges)] : word(d);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Plausible, or in the wild mood one time in eight anything. */
static float number(struct differential *d, float low, float high)
{
    return d->wild && !below(d, 8) ? special(d) : between(d, low, high);
}

static void fill(struct differential *d, void *memory, size_t bytes, float low, float high)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        float value = number(d, low, high);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

static void fill_words(struct differential *d, void *memory, size_t bytes)
{
    for (size_t at = 0; at + 4 <= bytes; at += 4) {
        uint32_t value = word(d);
        memcpy((uint8_t *)memory + at, &value, sizeof value);
    }
}

/* A multiple of 16 lanes: mostly few, sometimes none or as many as there may be. */
static uint32_t lane_count(struct differential *d, uint32_t capacity)
{
    return below(d, 8) ? 16 * (1 + below(d, 4)) : 16 * below(d, capacity / 16 + 1);
}

/* --- The job --- */

static void make_lights(struct differential *d)
{
    fill(d, d->job.base_color, sizeof d->job.base_color, -0.2f, 1);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        fill(d, light->position, sizeof light->position, -3, 3);
        fill(d, light->diffuse, sizeof light->diffuse, -0.1f, 1);
        fill(d, light->ambient, sizeof light->ambient, 0, 0.3f);
        light->range = number(d, 0, 8);
        light->attenuation0 = number(d, 0, 1);
        light->attenuation1 = number(d, 0, 1);
        light->attenuation2 = number(d, 0, 1);
        fill(d, light->specular, sizeof light->specular, 0, 1);
        fill(d, light->axis, sizeof light->axis, -1, 1);
        light->outer_cosine = number(d, -0.5f, 0.5f);
        light->cone_scale = number(d, 0.5f, 4);
        light->falloff = below(d, 4) ? number(d, 0, 4) : 1;
    }
    fill(d, d->job.ambient_light, sizeof d->job.ambient_light, 0, 1);
    d->job.power = below(d, 4) ? number(d, 0, 30) : 0;
    d->job.specular_alpha = number(d, 0, 1);
}

/* What blends positions; the palette ends at a fence. */
static void make_skin(struct differential *d)
{
    fill(d, d->job.projection, sizeof d->job.projection, -2, 2);
    fill(d, d->job.blend, sizeof d->job.blend, -1, 1);
    fill(d, d->job.texture_matrix, sizeof d->job.texture_matrix, -1, 1);
    fill(d, d->palette, PALETTE_BYTES, -1, 1);
    d->job.palette = (const void *)d->palette;
    d->job.tween_factor = number(d, -0.5f, 1.5f);
}

/* Every vertex at the camera and every light at exactly its range, where "within" and "below" differ. */
static void put_lights_at_their_range(struct differential *d)
{
    memset(d->job.world_view, 0, sizeof d->job.world_view);
    for (int i = 0; i < LIGHT_COUNT; i++) {
        struct light_job *light = &d->job.light[i];
        memset(light->position, 0, sizeof light->position);
        light->position[below(d, 3)] = light->range = (float)(1u << below(d, 4));
    }
}

static void make_job(struct differential *d)
{
    struct job *job = &d->job;
    memset(job, 0, sizeof *job);
    job->srgb = &srgb_tables;
    fill(d, job->world_view_projection, sizeof job->world_view_projection, -2, 2);
    fill(d, job->world_view, sizeof job->world_view, -2, 2);
    fill(d, job->normal, sizeof job->normal, -2, 2);
    make_lights(d);
    make_skin(d);
    if (!below(d, 8))
        put_lights_at_their_range(d);
    job->guard_x = between(d, 1, 50);
    job->guard_y = between(d, 1, 50);
    job->scale_x = number(d, 1, 100000);
    job->scale_y = number(d, -100000, -1);
    job->offset_x = number(d, 0, 100000);
    job->offset_y = number(d, 0, 100000);
    job->depth_scale = number(d, 0.1f, 1);
    job->depth_offset = number(d, -0.1f, 0.5f);
    job->depth_bias = number(d, -0.1f, 0.1f);
    job->depth_bias_slope = number(d, -2, 2);
    job->point_size = number(d, 0, 64);
    job->point_least = number(d, 0, 4);
    job->point_most = number(d, 2, 40);
    fill(d, job->point_scale, sizeof job->point_scale, 0, 1);
    job->viewport_height = number(d, 1, 100);
    fill(d, job->clip_plane, sizeof job->clip_plane, -2, 2);
}

/* --- Shaders --- */

/* The last of them ends at the fence. Loops are short, and most relative addresses small. */
static void make_constants(struct differential *d, enum unit unit, const union key *key)
{
    float floats[256][4];
    int32_t integers[16][4];
    const struct program *program = key_shader(unit, key);
    if (!program)
        return;
    size_t bytes = program_constant_bytes(program);
    uint8_t *constants = d->constants + CONSTANT_BYTES - bytes;
    fill(d, floats, sizeof floats, -2, 2);
    for (int i = 0; i < 16; i++) {
        integers[i][0] = (int32_t)below(d, 4);
        integers[i][1] = (int32_t)below(d, 12);
        integers[i][2] = (int32_t)below(d, 7) - 3;
        integers[i][3] = 0;
    }
    program_write_constants(program, (const float(*)[4])floats, (const int32_t(*)[4])integers, constants);
    d->job.constants[program->model->stage] = (const float *)(const void *)constants;
}

/* --- Vertices --- */

/* Indices come from anywhere: of words, but not of vectors. */
static uint32_t *indices(struct differential *d)
{
    return d->index_words + 1;
}

/* The last vertex that is fetched ends at the fence, or up to three bytes before it. */
static void make_stream(struct differential *d, uint8_t *stream, struct attribute_job *job, int format,
                        uint32_t last)
{
    job->stride = 4 * (int32_t)below(d, STRIDE_MAXIMUM / 4 + 1);
    job->data = stream + STREAM_BYTES - last * (uint32_t)job->stride - vertex_types[format].bytes;
    if (!below(d, 4))
        job->data -= below(d, 4);
    if (vertex_types[format].encoding != ENCODING_FLOAT)
        fill_words(d, stream, STREAM_BYTES);
    else
        fill(d, stream, STREAM_BYTES, -2, 2);
    if (!below(d, 16)) /* zero vectors, whose length has no reciprocal */
        memset(stream, 0, STREAM_BYTES);
}

static void make_vertex_inputs(struct differential *d, const struct vertex_key *key)
{
    uint32_t last = 0;
    d->count = lane_count(d, VERTEX_CAPACITY);
    for (uint32_t i = 0; i < d->count; i++) {
        indices(d)[i] = below(d, VERTEX_CAPACITY);
        last = indices(d)[i] > last ? indices(d)[i] : last;
    }
    for (int a = 0; a < ATTRIBUTE_COUNT; a++)
        make_stream(d, d->stream[a], &d->job.attribute[a], key->attribute[a], last);
    for (int i = 0; i < INPUTS && key_program(key->shader); i++) /* attributes are not read then */
        make_stream(d, d->stream[i], &d->job.input[i], key->input[i], last);
}

/* --- Triangles --- */

static void make_setup_inputs(struct differential *d, const struct setup_key *key)
{
    d->layout = setup_layout(key);
    d->count = lane_count(d, SETUP_CAPACITY);
    for (int slot = 0; slot < SLOT_COUNT; slot++)
        fill(d, d->initial.vertices + slot * VERTEX_CAPACITY, VERTEX_SLOT_BYTES, slot == SLOT_W ? 0.5f : -2,
             slot == SLOT_W ? 4 : 2);
    for (int i = 0; i < 4 * SETUP_CAPACITY; i++)
        indices(d)[i] = 4 * below(d, VERTEX_CAPACITY);
    for (int i = 4 * SETUP_CAPACITY; i < SETUP_INDEX_ROWS * SETUP_CAPACITY; i++)
        indices(d)[i] = -below(d, 2);
    for (int i = 0; i < SETUP_CAPACITY; i++)
        if (!below(d, 16)) /* without area */
            indices(d)[i] = indices(d)[i + SETUP_CAPACITY * (1 + (int)below(d, 2))];
}

/* --- Pixels --- */

static void make_plane(struct differential *d, uint8_t *record, size_t offset, float low, float high)
{
    float slope = below(d, 4) ? 0.1f : 1.25f;
    struct plane plane = {number(d, low, high), number(d, -slope, slope), number(d, -slope, slope)};
    memcpy(record + offset, &plane, sizeof plane);
}

static void make_varying(struct differential *d, uint8_t *record, const struct pixel_key *key, int varying)
{
    float reach = !varying_is_texcoord(varying) ? 0.25f : below(d, 4) ? 3 : 300;
    for (size_t c = 0; c < varying_components[varying]; c++) {
        float flat = number(d, -reach, 1 + reach);
        size_t first = d->layout.varying[varying];
        if (key->varying[varying] == INTERPOLATION_FLAT)
            memcpy(record + first + sizeof flat * c, &flat, sizeof flat);
        else if (key->varying[varying] == INTERPOLATION_SMOOTH)
            make_plane(d, record, first + sizeof(struct plane) * c, -reach, 1 + reach);
    }
}

static void make_triangles(struct differential *d, const struct pixel_key *key)
{
    for (int i = 0; i < TRIANGLES; i++) {
        uint8_t *record = d->triangles + i * d->layout.stride;
        fill(d, record, d->layout.stride, -4, 4);
        struct triangle_head *head = (void *)record;
        head->visible = below(d, 2) ? 1 : -1;
        head->origin_x = between(d, -20, 84);
        head->origin_y = between(d, -20, 84);
        if (d->layout.depth)
            make_plane(d, record, d->layout.depth, -0.25f, 1.25f);
        if (d->layout.smooth)
            make_plane(d, record, d->layout.reciprocal_w, 0.2f, 2);
        for (int v = 0; v < VARYING_COUNT; v++)
            make_varying(d, record, key, v);
    }
}

static uint16_t random_coverage(struct differential *d)
{
    static const uint16_t some[] = {0xffff, 0x00ff, 0xff00, 0x8001, 0x0100, 0xf000};
    uint16_t sparse = (uint16_t)(word(d) & word(d));
    if (below(d, 2))
        return some[below(d, sizeof some / sizeof *some)];
    return sparse ? sparse : 1;
}

/* Samples of a covered pixel: often all, else some, never none. */
static void make_samples(struct differential *d, const struct pixel_key *key, int i)
{
    struct sample_coverage *coverage = &d->entries.coverage[i];
    uint16_t any = d->entries.entry[i].coverage, left = any;
    int samples = 1 << key->samples, whole = !below(d, 3);
    memset(coverage, 0, sizeof *coverage);
    for (int s = 0; s < samples; s++) {
        coverage->sample[s] = whole ? any : any & (uint16_t)word(d);
        left &= (uint16_t)~coverage->sample[s];
    }
    coverage->sample[below(d, (uint32_t)samples)] |= left;
}

/* Four in five entries begin a new block; the others shade the one before again. */
static void make_entries(struct differential *d, const struct pixel_key *key)
{
    float left = 64 * (float)below(d, 3), top = 64 * (float)below(d, 3);
    d->count = 1 + below(d, ENTRIES);
    for (int i = 0; i < ENTRIES; i++) {
        uint16_t block = i % 5 ? (uint16_t)below(d, TILE_BLOCKS) : d->entries.entry[i ? i - 1 : 0].block;
        d->entries.entry[i] = (struct entry){.x = left + (float)(block % 16 * 4),
                                             .y = top + (float)(block / 16 * 4),
                                             .coverage = random_coverage(d),
                                             .block = block,
                                             .triangle = below(d, TRIANGLES) * d->layout.stride};
        make_samples(d, key, i);
    }
}

static int32_t texture_side(struct differential *d, int small, int address)
{
    int power = address == ADDRESS_WRAP_POWER || address == ADDRESS_MIRROR_POWER;
    return power ? 1 << below(d, small ? 5 : 7) : 1 + (int32_t)below(d, small ? SMALL_SIDE : TEXTURE_SIDE);
}

static int32_t half(int32_t side, int level)
{
    return side >> level ? side >> level : 1;
}

/* Fills in the levels of one face; returns its texels. */
static int32_t make_levels(const int32_t side[3], struct texture_level levels[LEVELS])
{
    int32_t offset = 0;
    for (int l = 0; l < LEVELS; l++) {
        struct texture_level *level = &levels[l];
        *level =
            (struct texture_level){offset, half(side[0], l), half(side[1], l), half(side[2], l), 0, 0, 0, 0};
        level->width_256 = 256 * (float)level->width;
        level->height_256 = 256 * (float)level->height;
        level->depth_256 = 256 * (float)level->depth;
        level->slice_texels = level->width * level->height;
        offset += level->slice_texels * level->depth;
    }
    return offset;
}

/* Which levels may be sampled: any range of them. Without levels the first is all there is. */
static void make_detail(struct differential *d, int sampler)
{
    struct texture_job *texture = &d->job.texture[sampler];
    uint32_t last = below(d, LEVELS);
    texture->levels = d->levels[sampler];
    texture->first_level_256 = 256 * (int32_t)below(d, last + 1);
    texture->last_level_256 = 256 * (int32_t)last;
    texture->lod_bias_256 = number(d, -256 * 4, 256 * 4);
    texture->lod_offset = number(d, -256 * 14, 256);
}

/* The image's last texel is the last word before the fence. */
static void make_texture(struct differential *d, struct sampler_key key)
{
    struct texture_job *texture = &d->job.texture[key.number];
    int kind = key.kind, words = key.texel >= TEXEL_FLOATS ? 4 : 1;
    int small = kind == TEXTURE_VOLUME || words > 1;
    const int32_t side[3] = {texture_side(d, small, key.address[0]), texture_side(d, small, key.address[1]),
                             kind == TEXTURE_VOLUME ? texture_side(d, small, key.address[2]) : 1};
    int32_t chain = make_levels(side, d->levels[key.number]), image = side[0] * side[1] * side[2];
    texture->face_texels = key.mip ? chain : image;
    int32_t texels = kind == TEXTURE_CUBE ? 6 * texture->face_texels : texture->face_texels;
    texture->texels = (const uint32_t *)(void *)(d->texels + TEXTURE_BYTES) - words * texels;
    texture->width = side[0];
    texture->height = side[1];
    texture->depth = side[2];
    texture->width_256 = 256 * (float)side[0];
    texture->height_256 = 256 * (float)side[1];
    texture->depth_256 = 256 * (float)side[2];
    texture->last_u = side[0] - 1;
    texture->last_v = side[1] - 1;
    texture->last_w = side[2] - 1;
    texture->slice_texels = side[0] * side[1];
    texture->border = word(d);
    make_detail(d, key.number);
}

static void make_textures(struct differential *d, const struct pixel_key *key)
{
    fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < PIXEL_SAMPLERS; i++)
        make_texture(d, pixel_sampler(key, i));
    for (int i = 0; i < TEXTURE_STAGES; i++) {
        d->job.stage_constant[i] = word(d);
        fill(d, &d->job.bump[i], sizeof d->job.bump[i], -0.5f, 0.5f);
    }
    d->job.texture_factor = word(d);
}

static void make_vertex_textures(struct differential *d, const struct vertex_key *key)
{
    if (key_next(key->texture, 0, VERTEX_SAMPLERS) == VERTEX_SAMPLERS)
        return;
    fill_words(d, d->texels, TEXTURE_BYTES);
    for (int i = 0; i < VERTEX_SAMPLERS; i++)
        make_texture(d, vertex_sampler(key, i));
}

static void make_fog(struct differential *d, const struct pixel_key *key)
{
    int linear = key->fog == FOG_LINEAR_Z || key->fog == FOG_LINEAR_W;
    d->job.fog_color = word(d);
    d->job.fog_scale = number(d, -2, linear ? 2 : 0);
    d->job.fog_offset = number(d, -1, 2);
}

/* What a depth is stored as in the format that the key's storage class stands for. */
static uint32_t depth_word(struct differential *d, const struct pixel_key *key, float depth)
{
    static const enum triptych_depth_format format[DEPTH_STORAGE_COUNT] = {
        TRIPTYCH_DEPTH_d32f_lockable, TRIPTYCH_DEPTH_d24s8, TRIPTYCH_DEPTH_d24fs8, TRIPTYCH_DEPTH_d32};
    int limited = depth >= 0 && depth <= 1;
    uint32_t stencil =
        key->depth_format == DEPTH_UNORM || key->depth_format == DEPTH_FLOAT24 ? below(d, 256) : 0;
    if (key->depth_format != DEPTH_FLOAT)
        return depth_encode(format[key->depth_format], limited ? depth : 0) | stencil;
    uint32_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return bits;
}

/* Planes that pass exactly through stored depths, so that EQUAL has something to find. */
static void meet_stored_depths(struct differential *d, const struct pixel_key *key)
{
    struct plane plane = {0.5f, 0, 0};
    for (int i = 0; i < TRIANGLES; i++)
        memcpy(d->triangles + i * d->layout.stride + d->layout.depth, &plane, sizeof plane);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key, 0.25f * (float)(1 + below(d, 3)));
}

/* Few bits and many: often the reference is met. */
static void make_stencil_job(struct differential *d)
{
    struct job *job = &d->job;
    job->depth_maximum = 16777215;
    job->w_scale = number(d, -0.1f, 1.5f);
    job->w_offset = number(d, -0.5f, 0.5f);
    job->stencil_maximum = below(d, 4) ? 255 : 15;
    job->stencil_reference = (int32_t)below(d, 256) & job->stencil_maximum;
    job->stencil_mask = (int32_t)(below(d, 2) ? 255 : below(d, 8)) & job->stencil_maximum;
    job->stencil_write_mask = (int32_t)(below(d, 2) ? 255 : below(d, 256)) & job->stencil_maximum;
}

/* Often an alpha that saturated colours have, or its neighbour. */
static int32_t alpha_reference(struct differential *d)
{
    static const uint8_t some[] = {0, 1, 127, 128, 254, 255};
    return below(d, 2) ? some[below(d, sizeof some)] : (int32_t)below(d, 256);
}

/* Words, or planes of numbers. */
static void make_targets(struct differential *d, const struct pixel_key *key)
{
    uint32_t *plane = d->initial.color;
    for (int t = 0; t < (key->samples ? 1 : TARGETS); t++)
        for (int p = 0; p < target_planes[key->target[t]] << key->samples; p++, plane += TILE_PIXELS)
            if (target_planes[key->target[t]] > 1)
                fill(d, plane, TILE_PLANE_BYTES, -0.5f, 1.5f);
            else
                fill_words(d, plane, TILE_PLANE_BYTES);
}

static void make_pixel_inputs(struct differential *d, const struct pixel_key *key)
{
    d->job.alpha_reference = alpha_reference(d);
    d->job.blend_constant = word(d);
    make_stencil_job(d);
    d->layout = pixel_layout(key);
    make_triangles(d, key);
    make_entries(d, key);
    make_textures(d, key);
    make_fog(d, key);
    make_targets(d, key);
    for (int i = 0; i < TILE_PIXELS << key->samples; i++)
        d->initial.depth[i] = depth_word(d, key, below(d, 3) ? number(d, 0, 1) : (float)below(d, 2));
    struct lane_table lanes = lane_table;
    for (int lane = 0; lane < LANES_MAXIMUM; lane++)
        lanes.passed[lane] = (int32_t)below(d, 1000);
    memcpy(d->initial.lanes + 4, &lanes, sizeof lanes);
    if (d->layout.depth && !below(d, 3))
        meet_stored_depths(d, key);
}

/* --- Running and comparing --- */

static void make_inputs(struct differential *d, enum unit unit, const union key *key, uint64_t seed)
{
    d->seed = seed * 0x9e3779b97f4a7c15ull | 1;
    d->wild = (int)below(d, 2);
    memset(&d->initial, UNTOUCHED, sizeof d->initial);
    make_job(d);
    make_constants(d, unit, key);
    switch (unit) {
    case UNIT_VERTEX:
        make_vertex_inputs(d, &key->vertex);
        make_vertex_textures(d, &key->vertex);
        break;
    case UNIT_SETUP: make_setup_inputs(d, &key->setup); break;
    default: make_pixel_inputs(d, &key->pixel); break;
    }
}

/* Returns whether MXCSR came back as it was: rounding toward zero, nothing flushed or only results. */
static int run(struct differential *d, const struct routine *routine, struct outputs *o)
{
    struct lane_table *lanes = (void *)(o->lanes + 4);
    struct vertex_call vertex = {&d->job, indices(d), o->vertices, d->count};
    struct setup_call setup = {&d->job, indices(d), o->vertices, o->records, d->count};
    struct pixel_call pixel = {&d->job, d->entries.entry, d->triangles, lanes, o->color, o->depth, d->count};
    const void *calls[UNIT_COUNT] = {&vertex, &setup, &pixel};
    const unsigned flags = 0x3f, foreign = 0x7f80 ^ below(d, 2) << 15, own = _mm_getcsr();
    memcpy(o, &d->initial, sizeof *o);
    _mm_setcsr(foreign);
    routine->run(calls[routine->unit], routine);
    unsigned after = _mm_getcsr();
    _mm_setcsr(own);
    return !((after ^ foreign) & ~flags);
}

static size_t record_end(const struct setup_key *key, const struct triangle_layout *layout)
{
    size_t end = sizeof(struct triangle_head);
    if (key->depth)
        end = layout->depth + sizeof(struct plane);
    if (layout->smooth)
        end = layout->reciprocal_w + sizeof(struct plane);
    for (int v = 0; v < VARYING_COUNT; v++)
        if (key->varying[v] != INTERPOLATION_NONE) {
            size_t bytes = key->varying[v] == INTERPOLATION_SMOOTH ? sizeof(struct plane) : sizeof(float);
            end = layout->varying[v] + varying_components[v] * bytes;
        }
    return end;
}

enum meaning { EXACT, ANY_NAN, OPEN };

/* What the word at a byte of the outputs is to the unit. */
static enum meaning meaning(const struct differential *d, enum unit unit, const union key *key, size_t at)
{
    size_t vertices = at - offsetof(struct outputs, vertices);
    size_t records = at - offsetof(struct outputs, records);
    if (unit == UNIT_VERTEX)
        return vertices < sizeof d->initial.vertices && vertices / VERTEX_SLOT_BYTES != SLOT_CODE ? ANY_NAN
                                                                                                  : EXACT;
    if (unit != UNIT_SETUP || records >= (size_t)d->count * d->layout.stride)
        return EXACT;
    size_t within = records % d->layout.stride;
    if (within < sizeof(struct triangle_head) || within >= record_end(&key->setup, &d->layout))
        return EXACT;
    struct triangle_head head;
    memcpy(&head, d->result[0].records + records - within, sizeof head);
    return head.visible ? ANY_NAN : OPEN;
}

static int is_nan(uint32_t bits)
{
    return (bits & 0x7fffffff) > 0x7f800000;
}

/* Where a byte of the outputs is. */
static const char *place(size_t at, size_t *word)
{
    static const struct {
        size_t start;
        const char *name;
    } parts[] = {{offsetof(struct outputs, behind), "the memory behind"},
                 {offsetof(struct outputs, lanes), "the lane table"},
                 {offsetof(struct outputs, depth), "depth"},
                 {offsetof(struct outputs, color), "colour"},
                 {offsetof(struct outputs, records), "records"},
                 {offsetof(struct outputs, vertices), "vertices"},
                 {0, "the memory before"}};
    size_t part = 0;
    while (at < parts[part].start)
        part++;
    *word = (at - parts[part].start) / 4;
    return parts[part].name;
}

static const char *compare(struct differential *d, const struct engine *a, const struct engine *b,
                           enum unit unit, const union key *key)
{
    const uint8_t *x = (const uint8_t *)&d->result[0], *y = (const uint8_t *)&d->result[1];
    if (!memcmp(x, y, sizeof d->result[0]))
        return NULL;
    for (size_t at = 0; at < sizeof d->result[0]; at += 4) {
        uint32_t left, right;
        memcpy(&left, x + at, sizeof left);
        memcpy(&right, y + at, sizeof right);
        enum meaning open = left == right ? OPEN : meaning(d, unit, key, at);
        if (open == OPEN || (open == ANY_NAN && is_nan(left) && is_nan(right)))
            continue;
        char text[KEY_TEXT_CAPACITY];
        size_t number;
        const char *where = place(at, &number);
        snprintf(d->message, sizeof d->message, "%s and %s differ in %s, word %zu: %08x and %08x; %s key: %s",
                 a->name, b->name, where, number, (unsigned)left, (unsigned)right, unit_name[unit],
                 key_print(unit, key, text));
        return d->message;
    }
    return NULL;
}

const char *differential_compare(struct differential *d, const struct engine *a, const struct engine *b,
                                 enum unit unit, const union key *key, uint64_t seed)
{
    const struct engine *engines[2] = {a, b};
    struct error error = {{0}};
    make_inputs(d, unit, key, seed);
    for (int i = 0; i < 2; i++) {
        struct routine *routine = engines[i]->build(d->arena, unit, key, &error);
        if (!routine) {
            snprintf(d->message, sizeof d->message, "%s built nothing: %s", engines[i]->name, error.text);
            return d->message;
        }
        int restored = run(d, routine, &d->result[i]);
        engines[i]->free(d->arena, routine);
        if (!restored) {
            snprintf(d->message, sizeof d->message, "%s does not restore MXCSR", engines[i]->name);
            return d->message;
        }
    }
    return compare(d, a, b, unit, key);
}

/* Among all pairs of blendings, those that a renderer meets are rare: alpha blended like colour,
 * complementary factors, and what stitchers have special code for. */
static void blend_usually(uint64_t chance, struct pixel_key *key)
{
    static const uint8_t usual[][2] = {{FACTOR_SOURCE_ALPHA, FACTOR_INVERSE_SOURCE_ALPHA},
                                       {FACTOR_ONE, FACTOR_INVERSE_SOURCE_ALPHA},
                                       {FACTOR_SOURCE_ALPHA, FACTOR_ZERO}};
    unsigned choice = chance >> 33 & 7;
    if (choice < 4) {
        key->blend[BLEND_ALPHA] = key->blend[BLEND_COLOR];
        key->source_factor[BLEND_ALPHA] = key->source_factor[BLEND_COLOR];
        key->target_factor[BLEND_ALPHA] = key->target_factor[BLEND_COLOR];
    }
    for (int c = 0; c < BLEND_CHANNELS; c++)
        if (choice < 2) {
            key->blend[c] = BLEND_ADD;
            key->source_factor[c] = usual[(chance >> 36) % 3][0];
            key->target_factor[c] = usual[(chance >> 36) % 3][1];
        } else if ((choice == 2 || choice == 7) && key->source_factor[c] < FACTOR_SATURATED_ALPHA) {
            key->blend[c] = BLEND_ADD;
            key->target_factor[c] = key->source_factor[c] ^ 1;
        }
}

/* Among all keys few have positions that are transformed, of types that are usual, or one matrix. */
static void declare_usually(uint64_t chance, struct vertex_key *key)
{
    if (chance >> 33 & 3)
        key->attribute[ATTRIBUTE_POSITIONT] = ATTRIBUTE_FORMAT_NONE;
    if (chance >> 36 & 1)
        key->matrices = key->tween = 0;
    if (chance >> 35 & 1)
        for (int a = 0; a < ATTRIBUTE_COUNT; a++)
            key->attribute[a] %= ATTRIBUTE_FORMAT_COLOR + 1;
}

/* Few stages, in half of the cases with the sources that draws use; all of them now and then. */
static void stage_usually(uint64_t chance, struct pixel_key *key)
{
    static const uint8_t usual[] = {SOURCE_TEXTURE, SOURCE_CURRENT, SOURCE_FACTOR, SOURCE_CONSTANT};
    if (chance >> 20 & 15)
        key->stages = (uint8_t)((chance >> 24) % 4);
    for (int i = 0; i < TEXTURE_STAGES * STAGE_ARGUMENTS && chance >> 40 & 1; i++) {
        key->color_argument[i] = usual[key->color_argument[i] % 4];
        key->alpha_argument[i] = usual[key->alpha_argument[i] % 4];
    }
    for (int i = 0; i < PIXEL_SAMPLERS && chance >> 42 & 7; i++)
        key->texture[i] = key->texture[i] != TEXTURE_NONE, key->mip[i] = key->minify[i] = key->texel[i] = 0;
    for (int i = 0; i < PIXEL_SAMPLERS; i++) /* a stage of many taps takes longer than all else */
        key->anisotropy[i] %= 4;
    for (int i = 0; i < TEXTURE_STAGES && chance >> 41 & 1; i++)
        key->alpha_stage[i] = key->color_stage[i] == STAGE_DOT ? STAGE_SELECT : key->color_stage[i];
}

/* Most targets have one sample; several are of one target. */
static void sample_usually(uint64_t chance, struct pixel_key *key)
{
    if (chance >> 40 & 3)
        key->samples = key->sample_centers = 0;
    for (int t = 1; t < TARGETS && key->samples; t++)
        key->write_mask[t] = key->target[t] = 0;
}

/* A quarter of the routines have a shader. */
static void shade_usually(uint64_t chance, enum unit unit, union key *key)
{
    const struct program *program[16];
    uint8_t *shader = unit == UNIT_VERTEX ? key->vertex.shader : key->pixel.shader;
    enum shader_stage stage = unit == UNIT_VERTEX ? STAGE_VERTEX : STAGE_PIXEL;
    unsigned count = 0;
    for (unsigned i = 0; sample_program(i); i++)
        if (sample_program(i)->model->stage == stage)
            program[count++] = sample_program(i);
    key_set_program(shader, (chance >> 44) % 4 ? 0 : program[(chance >> 48) % count]->number);
    if (unit == UNIT_PIXEL && !key_program(shader))
        key->pixel.kills = key->pixel.depth_output = 0;
}

const char *differential_rounds(struct differential *d, const struct engine *a, const struct engine *b,
                                enum unit unit, differential_shape *shape, uint64_t seed, int rounds)
{
    const char *difference = NULL;
    for (int i = 0; i < rounds && !difference; i++) {
        union key key;
        key_random(unit, &seed, &key);
        if (unit == UNIT_PIXEL)
            blend_usually(seed, &key.pixel), stage_usually(seed, &key.pixel),
                sample_usually(seed, &key.pixel);
        if (unit == UNIT_VERTEX)
            declare_usually(seed, &key.vertex);
        if (unit != UNIT_SETUP)
            shade_usually(seed, unit, &key);
        if (shape)
            shape(unit, &key);
        difference = differential_compare(d, a, b, unit, &key, seed);
    }
    return difference;
}
